# What photongrid_add_kernels refuses, and what it takes: `cmake -DCMAKE_MODULES=folder -P refused_kernels.cmake`. Each
# case is a cmake of its own, since a refusal ends it.
if(DEFINED FILES)
  include(${CMAKE_MODULES}/add_kernels.cmake)
  photongrid_refuse_ambiguous_kernels("here" "${FILES}" "${KERNELS}" "photongrid/map/grid.glsl;photongrid/core/none.glsl")
  return()
endif()

# expect(MESSAGE FILES KERNELS): these end with MESSAGE; an empty one: they are taken.
function(expect message files kernels)
  execute_process(COMMAND ${CMAKE_COMMAND} -DCMAKE_MODULES=${CMAKE_MODULES} "-DFILES=${files}" "-DKERNELS=${kernels}"
    -P ${CMAKE_CURRENT_LIST_FILE} RESULT_VARIABLE status ERROR_VARIABLE said)
  string(REGEX REPLACE "[ \n]+" " " said "${said}") # cmake breaks lines
  string(FIND "${said}" "${message}" at)
  if(message STREQUAL "")
    set(wanted 0)
  else()
    set(wanted 1)
  endif()
  if(at EQUAL -1 OR NOT status EQUAL wanted)
    message(FATAL_ERROR "${files}: expected \"${message}\"; got ${status}: ${said}")
  endif()
endfunction()

expect("" "/p/a.glsl;/p/b/a.glsl;/p/k.glsl" "/p/k.glsl")
expect("" "/p/grid.glsl;/p/map/grid.glsl;/p/photongrid_map/grid.glsl" "/p/grid.glsl")
expect("here: /p/a.glsl is given twice" "/p/a.glsl;/p/k.glsl;/p/a.glsl" "/p/k.glsl")
expect("here: /p/k.glsl and /p/b/k.glsl would both be the struct k;" "/p/k.glsl;/p/b/k.glsl" "/p/k.glsl;/p/b/k.glsl")
expect("on GPUs /p/photongrid/map/grid.glsl cannot be told from photongrid's own <photongrid/map/grid.glsl>;"
  "/p/k.glsl;/p/photongrid/map/grid.glsl" "/p/k.glsl")
