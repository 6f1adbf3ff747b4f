# Eigen3::Eigen, 3.4: the parent project's, else the installed one, else downloaded.
if(TARGET Eigen3::Eigen)
  return()
endif()

if(NOT FETCHCONTENT_SOURCE_DIR_EIGEN3)
  find_package(Eigen3 3.4 QUIET GLOBAL) # GLOBAL: a project that adds polybody as a sub-folder links it too
  if(TARGET Eigen3::Eigen)
    return()
  endif()
endif()

include(FetchContent)
set(eigen_repository https://gitlab.com/libeigen/eigen.git)
# FetchContent clones up to three times, and its message names no remedy. So ask for the tag before, unless the sources
# are here or the parent project declares another place.
get_property(declared GLOBAL PROPERTY _FetchContent_eigen3_savedDetails DEFINED)
if(NOT (FETCHCONTENT_SOURCE_DIR_EIGEN3 OR FETCHCONTENT_FULLY_DISCONNECTED OR declared
        OR EXISTS ${FETCHCONTENT_BASE_DIR}/eigen3-src/Eigen/Core))
  find_package(Git QUIET)
  set(failed TRUE)
  if(Git_FOUND)
    execute_process(
      COMMAND ${CMAKE_COMMAND} -E env GIT_TERMINAL_PROMPT=0 ${GIT_EXECUTABLE} ls-remote --exit-code ${eigen_repository} 3.4.0
      TIMEOUT 30
      RESULT_VARIABLE failed
      OUTPUT_QUIET ERROR_QUIET)
  endif()
  if(failed)
    message(
      FATAL_ERROR
        "polybody needs Eigen 3.4 or newer. It is not installed (Debian: libeigen3-dev), and git cannot reach "
        "${eigen_repository}. Install Eigen, or name its folder: -DFETCHCONTENT_SOURCE_DIR_EIGEN3=<folder with Eigen/Core>.")
  endif()
endif()
FetchContent_Declare(
  Eigen3
  GIT_REPOSITORY ${eigen_repository}
  GIT_TAG 3.4.0
  GIT_SHALLOW TRUE
  SOURCE_SUBDIR none) # there is no such folder: take the headers, leave Eigen's own build and tests
FetchContent_MakeAvailable(Eigen3)

if(NOT TARGET Eigen3::Eigen) # downloaded
  add_library(Eigen3::Eigen INTERFACE IMPORTED GLOBAL) # imported: no warnings from its headers
  target_include_directories(Eigen3::Eigen INTERFACE ${eigen3_SOURCE_DIR})
endif()
