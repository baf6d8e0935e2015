# volcomp_compile_quickly(TARGET...): without optimization, in a half to a third of the time. For what is not a product:
# tests, and below the sanitizers the programs around the numerics. What a test calls keeps the optimization of its own
# library, but for inline functions and templates, of which the linker takes the copy of the test.
function(volcomp_compile_quickly)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:-O0>")
  endforeach()
endfunction()
