# Each header alone: target headers_alone compiles every header of the library as a program of its own.
#
# Most of the compile time of a header is common to all: Eigen, then the includes of the system. So a header is
# compiled after the highest of these precompiled headers among its own includes. Missing includes are still found: a
# header gets only a precompiled header that it includes itself.
#
# POLYBODY_HEADERS_ALONE=K/N takes every N-th header, the K-th first, and those in which the last 30 commits changed a
# line that is not a comment.
set(POLYBODY_HEADERS_ALONE all CACHE STRING "Headers that are compiled alone: all, or K/N for every N-th")
set(headers_alone_before polybody/math/types.hpp polybody/system/system.hpp) # the higher, the later

# Which of `headers` (as they are included) reach `goal` by their includes.
function(headers_that_reach goal headers out)
  set(found ${goal})
  set(left ${headers})
  set(more TRUE)
  while(more)
    set(more FALSE)
    foreach(header IN LISTS left)
      set(included ${includes_of_${header}})
      foreach(one IN LISTS included)
        if(one IN_LIST found)
          list(APPEND found ${header})
          list(REMOVE_ITEM left ${header})
          set(more TRUE)
          break()
        endif()
      endforeach()
    endforeach()
  endwhile()
  list(REMOVE_ITEM found ${goal}) # the goal itself is compiled without
  set(${out} "${found}" PARENT_SCOPE)
endfunction()

set(headers "")
foreach(file IN LISTS polybody_headers polybody_testing_headers)
  file(RELATIVE_PATH header ${PROJECT_SOURCE_DIR}/include ${file})
  file(STRINGS ${file} lines REGEX "^#include <polybody/")
  list(TRANSFORM lines REPLACE "^#include <([^>]+)>.*" "\\1")
  set(includes_of_${header} ${lines})
  list(APPEND headers ${header})
endforeach()

# The part of `headers` that POLYBODY_HEADERS_ALONE selects.
function(headers_in_turn headers out)
  if(NOT POLYBODY_HEADERS_ALONE MATCHES "^([0-9]+)/([1-9][0-9]*)$")
    set(${out} "${headers}" PARENT_SCOPE)
    return()
  endif()
  set(first ${CMAKE_MATCH_1})
  set(every ${CMAKE_MATCH_2})
  execute_process(
    COMMAND git diff --name-only -G "^ *[^/ ]" --relative=include HEAD~30 -- include
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    OUTPUT_VARIABLE changed
    ERROR_QUIET)
  string(REPLACE "\n" ";" changed "${changed}")
  set(place 0)
  set(chosen "")
  foreach(header IN LISTS headers)
    math(EXPR turn "(${place} + ${every} - ${first} % ${every}) % ${every}")
    math(EXPR place "${place} + 1")
    if(turn EQUAL 0 OR header IN_LIST changed)
      list(APPEND chosen ${header})
    endif()
  endforeach()
  set(${out} "${chosen}" PARENT_SCOPE)
endfunction()

add_custom_target(headers_alone)
# Compiles `alone`, after `before` where it is not empty.
function(compile_alone target before alone)
  headers_in_turn("${alone}" alone)
  if(NOT alone)
    return()
  endif()
  set(sources "")
  foreach(header IN LISTS alone)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/headers_alone/${header}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include <${header}>\n")
    list(APPEND sources ${source})
  endforeach()
  add_library(${target} OBJECT EXCLUDE_FROM_ALL ${sources})
  target_link_libraries(${target} PRIVATE test_base)
  target_compile_options(${target} PRIVATE $<TARGET_PROPERTY:${test_pch_of_short_runs},COMPILE_OPTIONS>)
  if(before)
    target_precompile_headers(${target} PRIVATE <${before}>)
  endif()
  add_dependencies(headers_alone ${target})
endfunction()

list(REVERSE headers_alone_before)
foreach(before IN LISTS headers_alone_before)
  headers_that_reach(${before} "${headers}" after)
  list(REMOVE_ITEM headers ${after})
  string(REGEX REPLACE ".*/|[.]hpp" "" name ${before})
  compile_alone(headers_after_${name} ${before} "${after}")
endforeach()
compile_alone(headers_after_nothing "" "${headers}")
