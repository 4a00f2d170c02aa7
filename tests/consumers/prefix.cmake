# Installs the components dev and, if it was built, compiled of the build BUILD into the empty folder PREFIX.
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component dev --prefix ${PREFIX} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
if(LIBRARY AND EXISTS ${LIBRARY})
  execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --component compiled --prefix ${PREFIX} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endif()
