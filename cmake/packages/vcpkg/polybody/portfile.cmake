# Overlay port of the tree that contains this file: vcpkg install polybody
# --overlay-ports=<polybody>/cmake/packages/vcpkg
set(VCPKG_BUILD_TYPE release) # headers only

get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DPOLYBODY_BUILD_TESTS=OFF -DPOLYBODY_BUILD_EXAMPLES=OFF -DPOLYBODY_BUILD_BENCH=OFF -DPOLYBODY_INSTALL=ON)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME polybody CONFIG_PATH share/cmake/polybody)
vcpkg_fixup_pkgconfig()
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
