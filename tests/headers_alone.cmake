# Each header alone: target headers_alone compiles every header of the library as a program of its own.
#
# What most of a header's time goes into is the same for all: Eigen, then what waist 3 includes. So a header is compiled
# after the highest of these precompiled ones that it reaches by its own includes. That hides nothing: what it adds is
# there in any case, and a header on the way that does not reach so high is compiled without it.
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

add_custom_target(headers_alone)
# Compiles `alone`, after `before` where it is not empty.
function(compile_alone target before alone)
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
