# Install rules and the two exports (install tree, build tree). Nothing in polybody depends on the
# machine's architecture, so everything but the headers goes to share/. Components, for cmake --install --component:
# headers (all that a program needs), compiled (the sources of polybody::compiled), testing (polybody::testing).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/polybody)

install(TARGETS polybody EXPORT polybodyTargets FILE_SET HEADERS COMPONENT headers FILE_SET optional COMPONENT headers)
install(EXPORT polybodyTargets NAMESPACE polybody:: DESTINATION ${package_dir} COMPONENT headers)
install(TARGETS polybody_testing EXPORT polybodyTestingTargets FILE_SET HEADERS COMPONENT testing)
install(EXPORT polybodyTestingTargets NAMESPACE polybody:: DESTINATION ${package_dir} COMPONENT testing)

# polybodyConfig.cmake, good for both trees: it loads polybodyCompiler.cmake, polybodyTargets.cmake,
# polybodyPrecompile.cmake and polybodyCompiled.cmake beside it.
configure_package_config_file(
  cmake/polybodyConfig.cmake.in polybodyConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  polybodyConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
# EXACT compares versions as numbers, 0.2 with 0.2.0. The file returns early, so it begins with these lines.
file(READ ${PROJECT_BINARY_DIR}/polybodyConfigVersion.cmake version_file)
file(WRITE ${PROJECT_BINARY_DIR}/polybodyConfigVersion.cmake
     "if(PACKAGE_FIND_VERSION VERSION_EQUAL ${PROJECT_VERSION})\n  set(PACKAGE_VERSION_EXACT TRUE)\nendif()\n${version_file}")
configure_file(cmake/polybodyPrecompile.cmake polybodyPrecompile.cmake COPYONLY)
configure_file(cmake/polybodyCompiler.cmake polybodyCompiler.cmake COPYONLY)
configure_file(cmake/polybodyCompiled.cmake polybodyCompiled.cmake COPYONLY)
file(GLOB compiled_sources RELATIVE ${PROJECT_SOURCE_DIR}/cmake CONFIGURE_DEPENDS cmake/compiled/*.cpp)
foreach(source IN LISTS compiled_sources)
  configure_file(cmake/${source} ${source} COPYONLY)
endforeach()
install(DIRECTORY cmake/compiled DESTINATION ${package_dir} COMPONENT compiled)
install(FILES cmake/polybodyCompiled.cmake DESTINATION ${package_dir} COMPONENT compiled)
install(FILES ${PROJECT_BINARY_DIR}/polybodyConfig.cmake ${PROJECT_BINARY_DIR}/polybodyConfigVersion.cmake
              cmake/polybodyCompiler.cmake cmake/polybodyPrecompile.cmake DESTINATION ${package_dir} COMPONENT headers)

# The build tree: -Dpolybody_DIR=<build directory>.
export(EXPORT polybodyTargets NAMESPACE polybody:: FILE polybodyTargets.cmake)
export(EXPORT polybodyTestingTargets NAMESPACE polybody:: FILE polybodyTestingTargets.cmake)

# polybody.pc and polybody-testing.pc: paths are relative to the file itself, so the installed tree may be moved.
set(pkgconfig_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH pc_to_prefix ${CMAKE_INSTALL_FULL_DATADIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/polybody.pc.in polybody.pc @ONLY)
configure_file(cmake/polybody-testing.pc.in polybody-testing.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/polybody.pc DESTINATION ${pkgconfig_dir} COMPONENT headers)
install(FILES ${PROJECT_BINARY_DIR}/polybody-testing.pc DESTINATION ${pkgconfig_dir} COMPONENT testing)

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT headers)

include(cmake/packages/cpack.cmake)
