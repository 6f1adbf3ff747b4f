# polybody::testing: the law suites for types of a user's own, headers that need GoogleTest. A program that links it has
# GoogleTest's main. GoogleTest is looked for by whoever links it (the package does: COMPONENTS testing).
file(GLOB polybody_testing_headers CONFIGURE_DEPENDS include/polybody/testing/*.hpp)
list(REMOVE_ITEM polybody_headers ${polybody_testing_headers})

add_library(polybody_testing INTERFACE)
add_library(polybody::testing ALIAS polybody_testing)
target_sources(polybody_testing INTERFACE FILE_SET HEADERS BASE_DIRS include FILES ${polybody_testing_headers})
target_link_libraries(polybody_testing INTERFACE polybody GTest::gtest_main)
set_target_properties(polybody_testing PROPERTIES EXPORT_NAME testing)

if(PROJECT_IS_TOP_LEVEL)
  find_package(GTest QUIET) # seen by all folders
endif()
