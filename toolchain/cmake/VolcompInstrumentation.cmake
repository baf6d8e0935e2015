# VOLCOMP_SANITIZE, VOLCOMP_COVERAGE and VOLCOMP_FUZZ: flags for every target below the project folder.
# Lines are all that their reports need to know of the debug information (-g1). Optimized as usual:
# what is inlined is checked all the same, and whole campaigns run under the sanitizers.

# No vptr check: it needs the type information that the libraries of the target are built without.
# Without -fno-sanitize-recover a report of undefined behaviour would not end a fuzz run.
set(volcomp_sanitizers -fsanitize=address,undefined,float-cast-overflow -fno-sanitize=vptr
  -fno-sanitize-recover=all)
set(volcomp_sanitized ${volcomp_sanitizers} -O2 -g1 -fno-omit-frame-pointer
  -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/toolchain/sanitizer-ignore.txt)

if(VOLCOMP_SANITIZE)
  add_compile_options(${volcomp_sanitized})
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  # Programs of a hundred megabytes, thirty of them: lld links one in a quarter of the time.
  add_link_options(${volcomp_sanitizers} -fuse-ld=lld)
endif()

# volcomp_need_clang(OPTION PRESET)
function(volcomp_need_clang option preset)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "${option} needs clang: configure with the preset \"${preset}\".")
  endif()
endfunction()

# Counted in the source, before any optimization and before the sanitizers add their own branches.
if(VOLCOMP_COVERAGE)
  volcomp_need_clang(VOLCOMP_COVERAGE host-asan)
  add_compile_options(-fprofile-instr-generate -fcoverage-mapping
    -fprofile-list=${PROJECT_SOURCE_DIR}/toolchain/coverage-files.txt)
  add_link_options(-fprofile-instr-generate)
endif()

if(VOLCOMP_FUZZ)
  volcomp_need_clang(VOLCOMP_FUZZ fuzz)
  add_compile_options(-fsanitize=fuzzer-no-link ${volcomp_sanitized})
  add_link_options(${volcomp_sanitizers})
  add_custom_target(volcomp_fuzzers)
endif()

# volcomp_add_fuzzer(fuzz_NAME SOURCE...): a libFuzzer program. Seeds: tests/data/corpus/NAME.
function(volcomp_add_fuzzer name)
  add_executable(${name} ${ARGN})
  target_link_libraries(${name} PRIVATE volcomp_flags)
  target_link_options(${name} PRIVATE -fsanitize=fuzzer)
  add_dependencies(volcomp_fuzzers ${name})
  if(VOLCOMP_BUILD_TESTS)
    add_test(NAME ${name} COMMAND bash "${PROJECT_SOURCE_DIR}/toolchain/fuzz.sh" $<TARGET_FILE:${name}>)
  endif()
endfunction()
