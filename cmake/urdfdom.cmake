# liburdfdom, optional: target polybody_urdfdom where it is found (Debian: liburdfdom-dev).
find_path(POLYBODY_URDFDOM_INCLUDE urdf_parser/urdf_parser.h PATH_SUFFIXES urdfdom)
find_path(POLYBODY_URDFDOM_HEADERS_INCLUDE urdf_model/model.h PATH_SUFFIXES urdfdom_headers)
find_library(POLYBODY_URDFDOM_LIBRARY urdfdom_model)
find_library(POLYBODY_CONSOLE_BRIDGE_LIBRARY console_bridge)
mark_as_advanced(POLYBODY_URDFDOM_INCLUDE POLYBODY_URDFDOM_HEADERS_INCLUDE POLYBODY_URDFDOM_LIBRARY
                 POLYBODY_CONSOLE_BRIDGE_LIBRARY)
if(POLYBODY_URDFDOM_INCLUDE AND POLYBODY_URDFDOM_HEADERS_INCLUDE AND POLYBODY_URDFDOM_LIBRARY
   AND POLYBODY_CONSOLE_BRIDGE_LIBRARY)
  add_library(polybody_urdfdom INTERFACE)
  target_include_directories(polybody_urdfdom SYSTEM INTERFACE ${POLYBODY_URDFDOM_INCLUDE}
                                                               ${POLYBODY_URDFDOM_HEADERS_INCLUDE})
  target_link_libraries(polybody_urdfdom INTERFACE ${POLYBODY_URDFDOM_LIBRARY} ${POLYBODY_CONSOLE_BRIDGE_LIBRARY})
else()
  message(STATUS "liburdfdom is not found (Debian: liburdfdom-dev): the tests of polybody/urdf.hpp are not built")
endif()
