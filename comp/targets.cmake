# The INTERFACE targets that carry include folders, definitions and flags. In comp, because this folder has to serve
# alone, too.
include_guard(GLOBAL)
include("${CMAKE_CURRENT_LIST_DIR}/eigen.cmake")

# volcomp_eigen: what every user of a comp header has to see in the same way. EIGEN_DONT_VECTORIZE
# changes the alignment of Eigen's types, so it belongs to the binary interface of comp; with a fused
# multiply-add that the source does not contain, what is compiled elsewhere would compute other bits.
add_library(volcomp_eigen INTERFACE)
get_filename_component(volcomp_root "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
target_include_directories(volcomp_eigen INTERFACE "$<BUILD_INTERFACE:${volcomp_root}>")
target_include_directories(volcomp_eigen SYSTEM INTERFACE "$<BUILD_INTERFACE:${VOLCOMP_EIGEN_INCLUDE_DIR}>")
target_compile_definitions(volcomp_eigen INTERFACE
  EIGEN_DONT_VECTORIZE EIGEN_NO_IO EIGEN_NO_MALLOC EIGEN_MPL2_ONLY)
target_compile_options(volcomp_eigen INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>")
target_compile_features(volcomp_eigen INTERFACE cxx_std_17)

# volcomp_flags: the warnings, and the same arithmetic. Every target of the project links it PRIVATE. In the project
# itself warnings are errors; the compiler of a user may know more of them.
add_library(volcomp_flags INTERFACE)
set(volcomp_cxx_flags
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wfloat-equal -Wcast-align
  -Wshadow -Wold-style-cast -Wnon-virtual-dtor -Woverloaded-virtual -Wformat=2
  -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
  list(APPEND volcomp_cxx_flags -Wreserved-identifier)
endif()
if(CMAKE_PROJECT_NAME STREQUAL "volcomp")
  list(APPEND volcomp_cxx_flags -Werror)
endif()
target_compile_options(volcomp_flags INTERFACE "$<$<COMPILE_LANGUAGE:CXX>:${volcomp_cxx_flags}>")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 warns wrongly about "text" + std::string (GCC bug 105651).
    target_compile_options(volcomp_flags INTERFACE -Wno-restrict)
  endif()
  if(VOLCOMP_SANITIZE)
    target_compile_options(volcomp_flags INTERFACE -Wno-maybe-uninitialized)
  endif()
else()
  # Clang's also means double to long double, which the oracles of the tests do on purpose; GCC looks after float.
  target_compile_options(volcomp_flags INTERFACE -Wno-double-promotion)
endif()

# volcomp_target_rules: the language that comp, hal and firmware are restricted to.
add_library(volcomp_target_rules INTERFACE)
# Nobody reads errno: without -fno-math-errno every square root could call the C library.
set(volcomp_target_cxx_flags -fno-exceptions -fno-rtti -fno-threadsafe-statics -fno-math-errno)
target_compile_options(volcomp_target_rules INTERFACE
  "$<$<COMPILE_LANGUAGE:CXX>:${volcomp_target_cxx_flags}>")
target_link_libraries(volcomp_target_rules INTERFACE volcomp_eigen)
if(CMAKE_CROSSCOMPILING)
  # Compiled for size, GCC calls the functions that copy one number of a matrix: the calls are longer than they.
  target_compile_definitions(volcomp_target_rules INTERFACE "EIGEN_STRONG_INLINE=inline __attribute__((always_inline))")
endif()
if(NOT VOLCOMP_SANITIZE AND NOT VOLCOMP_COVERAGE)
  # Not for host programs: GCC sees null pointers inside the JSON library, wherever a sanitizer adds a check, and with -O1
  # in Eigen (the preset "dev", which for the same reason goes without -Wmaybe-uninitialized).
  target_compile_options(volcomp_target_rules INTERFACE
    "$<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-Wnull-dereference>")
endif()

# volcomp_tick_sources(SOURCE...): sources of this folder that instantiate a Compensator. The tick has a budget of
# instructions: on boards, where all else is optimised for size, it is for speed.
function(volcomp_tick_sources)
  set(options "")
  if(CMAKE_CROSSCOMPILING)
    list(APPEND options -O2)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Pairs of scalars packed into half-filled vectors cost the tick a tenth of its instructions.
    list(APPEND options -fno-tree-slp-vectorize)
    if(CMAKE_CROSSCOMPILING)
      # Instructions stay in the order of the source until registers are allocated and are then scheduled with the
      # registers renamed: fewer spills, more loads in pairs, and llvm-mca estimates no more cycles for the kernel.
      list(APPEND options -fno-tree-ter -fno-schedule-insns -frename-registers)
      # What the boards' presets switch off, because it costs flash.
      list(APPEND options -fmove-loop-invariants -ftree-pre)
    endif()
  endif()
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "${options}")
  if(CMAKE_CROSSCOMPILING)
    # Headers precompiled for size are not taken for speed.
    set_source_files_properties(${ARGN} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# volcomp_precompile(TARGET HEADER...): for builds of everything. The board m7, which compiles every library of the target, and
# clang-tidy go without and show that every file includes what it uses.
function(volcomp_precompile target)
  if(VOLCOMP_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# volcomp_precompiled_by(TARGET OTHER): the headers of another target, which is compiled with the same flags.
function(volcomp_precompiled_by target other)
  if(VOLCOMP_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${other})
  endif()
endfunction()
