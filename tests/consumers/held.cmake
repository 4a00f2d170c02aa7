# The object file FILE uses members of photon_map and point_index, and defines none of those that the library holds.
execute_process(COMMAND ${NM} -C ${FILE} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
if(NOT symbols MATCHES " U [^\n]*point_index<[^\n]*::nearest" OR symbols MATCHES " [TtWw] [^\n]*(knn_neighbours|fitted_map)")
  message(FATAL_ERROR "${FILE} has code that photongrid::cpu_compiled holds:\n${symbols}")
endif()
