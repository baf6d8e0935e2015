# volcomp_call_graphs(TARGET...): GCC leaves the call graph beside each object, for toolchain/check-recursion.py. ccache
# does not know of that file, so these are compiled without.
function(volcomp_call_graphs)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CROSSCOMPILING)
    foreach(target IN LISTS ARGN)
      target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:-fcallgraph-info=su,da>")
      set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER "")
    endforeach()
  endif()
endfunction()
