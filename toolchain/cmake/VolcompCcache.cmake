# Compiles through ccache where it is installed; without it the build is only slower.
if(NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(VOLCOMP_CCACHE ccache)
  if(VOLCOMP_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${VOLCOMP_CCACHE}")
  endif()
endif()
