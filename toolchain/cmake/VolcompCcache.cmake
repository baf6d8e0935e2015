# Compiles through ccache where it is installed; without it the build is only slower. Checkouts share what they compile: paths
# below the checkout are made relative, the folder of the build is left out. The sloppiness is what ccache requires for
# precompiled headers ("Precompiled headers" in its manual).
if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(VOLCOMP_CCACHE ccache)
  if(VOLCOMP_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env
      "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1 "CCACHE_SLOPPINESS=pch_defines,time_macros" "${VOLCOMP_CCACHE}")
  endif()
endif()
