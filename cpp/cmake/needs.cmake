# The libraries that the engine is compiled with. Where some are missing it is said in one line what to install.
find_package(Eigen3 3.4 QUIET NO_MODULE)
if(NOT Eigen3_FOUND)
  list(APPEND HEXDBB_MISSING "Eigen 3.4 (libeigen3-dev on Debian and Ubuntu, eigen3-devel on Fedora)")
endif()
if(HEXDBB_DIAGNOSIS)
  find_package(Ceres 2.1 QUIET)
  if(NOT Ceres_FOUND)
    list(APPEND HEXDBB_MISSING "Ceres 2.1 (libceres-dev on Debian and Ubuntu, ceres-solver-devel on Fedora)")
  endif()
endif()
if(HEXDBB_MISSING)
  list(JOIN HEXDBB_MISSING " and " HEXDBB_MISSING)
  # CMake wraps lines that do not begin with a space.
  message(FATAL_ERROR " hexdbb is compiled with ${HEXDBB_MISSING}: not found; install what is missing, or name its folder in CMAKE_PREFIX_PATH")
endif()
# Eigen's files under other licences than MPL2 would be an error.
add_compile_definitions(EIGEN_MPL2_ONLY)
