# polybody::compiled: static library with the code that is independent of the model of the user. It is compiled in the
# build tree of the user, with the flags of the user, if a target links it:
#
#   find_package(polybody REQUIRED)
#   add_executable(app app.cpp)                 # #include <polybody/compiled.hpp>
#   target_link_libraries(app PRIVATE polybody::compiled)
#   polybody_precompile(app)                    # app.cpp may also include <polybody/polybody.hpp>
#
# Alignment and the length of packs depend on the machine flags (-march, -mavx…). They are a part of the names that are
# linked, so a target with other machine flags than the library does not link. Set such flags for the whole tree
# (CMAKE_CXX_FLAGS), or name them for the library: target_compile_options(polybody_compiled PUBLIC -march=native).
if(NOT TARGET polybody_compiled)
  file(GLOB _polybody_sources "${CMAKE_CURRENT_LIST_DIR}/compiled/*.cpp")
  add_library(polybody_compiled STATIC EXCLUDE_FROM_ALL ${_polybody_sources})
  add_library(polybody::compiled ALIAS polybody_compiled)
  target_link_libraries(polybody_compiled PUBLIC polybody::polybody)
  unset(_polybody_sources)
endif()
