# Eigen3::Eigen, 3.4: the parent project's, else the installed one, else downloaded.
if(TARGET Eigen3::Eigen)
  return()
endif()

# Read only if Eigen is downloaded: take the library, leave its tests and documents.
set(EIGEN_BUILD_DOC OFF)
set(EIGEN_BUILD_PKGCONFIG OFF)
set(EIGEN_BUILD_TESTING OFF)

include(FetchContent)
FetchContent_Declare(
  Eigen3
  GIT_REPOSITORY https://gitlab.com/libeigen/eigen.git
  GIT_TAG 3.4.0
  GIT_SHALLOW TRUE
  FIND_PACKAGE_ARGS 3.4 GLOBAL) # GLOBAL: a project that adds polybody as a sub-folder links it too
FetchContent_MakeAvailable(Eigen3)

# An installed Eigen is a system include already; a downloaded one is made so (no warnings from it).
get_target_property(eigen_is_installed Eigen3::Eigen IMPORTED)
if(NOT eigen_is_installed)
  get_target_property(eigen_include eigen INTERFACE_INCLUDE_DIRECTORIES)
  set_target_properties(eigen PROPERTIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${eigen_include}")
endif()
