# Sets VOLCOMP_EIGEN_INCLUDE_DIR, for the build and for the installed package.
find_path(VOLCOMP_EIGEN_INCLUDE_DIR Eigen/Core
  PATHS /usr/include /usr/local/include
  PATH_SUFFIXES eigen3
  NO_CMAKE_FIND_ROOT_PATH
  DOC "folder that contains Eigen/Core")
if(NOT VOLCOMP_EIGEN_INCLUDE_DIR)
  message(FATAL_ERROR
    "Eigen 3.4 is missing: install libeigen3-dev or set VOLCOMP_EIGEN_INCLUDE_DIR to the folder that contains Eigen/Core.")
endif()
