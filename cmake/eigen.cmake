# Eigen3::Eigen, 3.4: the parent project's, else the installed one, else downloaded.
if(TARGET Eigen3::Eigen)
  return()
endif()

include(FetchContent)
FetchContent_Declare(
  Eigen3
  GIT_REPOSITORY https://gitlab.com/libeigen/eigen.git
  GIT_TAG 3.4.0
  GIT_SHALLOW TRUE
  SOURCE_SUBDIR none # there is no such folder: take the headers, leave Eigen's own build and tests
  FIND_PACKAGE_ARGS 3.4 GLOBAL) # GLOBAL: a project that adds polybody as a sub-folder links it too
FetchContent_MakeAvailable(Eigen3)

if(NOT TARGET Eigen3::Eigen) # downloaded
  add_library(Eigen3::Eigen INTERFACE IMPORTED GLOBAL) # imported: no warnings from its headers
  target_include_directories(Eigen3::Eigen INTERFACE ${eigen3_SOURCE_DIR})
endif()
