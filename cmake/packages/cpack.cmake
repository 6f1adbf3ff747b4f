# Packages of the installed tree: cpack -G DEB (libpolybody-dev) or -G TGZ in a build folder.
set(CPACK_PACKAGE_NAME polybody)
set(CPACK_PACKAGE_VENDOR "The polybody developers")
set(CPACK_PACKAGE_CONTACT "The polybody developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR "DEB;TGZ")
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};polybody;ALL;/")

set(CPACK_DEBIAN_PACKAGE_NAME libpolybody-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all) # headers only
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "g++ (>= 4:12) | clang")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, pkgconf, libgtest-dev, libsuitesparse-dev, libspectra-dev, gnuplot")
include(CPack)
