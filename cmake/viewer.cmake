# The page that plays films (include/polybody/io/film.hpp). Target `viewer` fetches the packages of its lock file by npm
# and bundles them with cmake/viewer/src into one file, polybody_viewer.html in the build folder.
#   POLYBODY_VIEWER  AUTO: the viewer is part of `all` if npm is found; a failure does not stop the build
#                    ON: a failure stops the build;  OFF: no viewer
set(viewer_default OFF)
if(PROJECT_IS_TOP_LEVEL)
  set(viewer_default AUTO)
endif()
set(POLYBODY_VIEWER ${viewer_default} CACHE STRING "Build the page that plays films, which needs npm: AUTO, ON or OFF")
set_property(CACHE POLYBODY_VIEWER PROPERTY STRINGS AUTO ON OFF)
set(polybody_viewer ${PROJECT_BINARY_DIR}/polybody_viewer.html)
if(NOT POLYBODY_VIEWER)
  return()
endif()

find_program(NPM npm)
find_program(NODE NAMES node nodejs)
mark_as_advanced(NPM NODE)
if(NOT NPM OR NOT NODE)
  set(missing "The viewer of films is not built: npm is missing (Debian: npm). Everything else is built")
  if(POLYBODY_VIEWER STREQUAL "AUTO")
    message(STATUS "${missing}")
    return()
  endif()
  message(FATAL_ERROR "${missing} with POLYBODY_VIEWER=OFF.")
endif()

file(GLOB viewer_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/viewer/*.* ${PROJECT_SOURCE_DIR}/cmake/viewer/src/*.*)
add_custom_command(
  OUTPUT ${PROJECT_BINARY_DIR}/viewer/tried
  COMMAND
    ${CMAKE_COMMAND} -DNPM=${NPM} -DNODE=${NODE} -DMODE=${POLYBODY_VIEWER} -DSOURCE=${PROJECT_SOURCE_DIR}/cmake/viewer
    -DFOLDER=${PROJECT_BINARY_DIR}/viewer -DOUT=${polybody_viewer} -P ${PROJECT_SOURCE_DIR}/cmake/viewer/bundle.cmake
  DEPENDS ${viewer_sources}
  COMMENT "Bundling the viewer of films"
  VERBATIM)
add_custom_target(viewer ALL DEPENDS ${PROJECT_BINARY_DIR}/viewer/tried)
if(POLYBODY_INSTALL)
  include(GNUInstallDirs)
  install(FILES ${polybody_viewer} DESTINATION ${CMAKE_INSTALL_DATADIR}/polybody/viewer COMPONENT headers OPTIONAL)
endif()
