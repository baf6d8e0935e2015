# volcomp_compile_quickly(TARGET...): without optimization, in a half to a third of the time. For what is not a product:
# tests, and below the sanitizers the programs around the numerics. What a test calls keeps the optimization of its own
# library, but for inline functions and templates, of which the linker takes the copy of the test.
function(volcomp_compile_quickly)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE "$<$<COMPILE_LANGUAGE:CXX>:-O0>")
  endforeach()
endfunction()

# volcomp_optimized_first(TARGET...): in the programs that link these libraries, the linker takes their copies of inline
# functions and templates, not those of what was compiled quickly: it keeps the first it meets. Below the sanitizers most
# are not inlined, and the numerics would run several times as long.
function(volcomp_optimized_first)
  foreach(target IN LISTS ARGN)
    target_link_options(${target} INTERFACE
      "SHELL:-Wl,--whole-archive $<TARGET_FILE:${target}> -Wl,--no-whole-archive")
  endforeach()
endfunction()
