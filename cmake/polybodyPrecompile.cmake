# polybody_precompile(<target>...)
# Gives each target a precompiled <polybody/polybody.hpp>; if it links polybody::compiled, it and that library get a
# precompiled <polybody/compiled.hpp>. Targets that are compiled alike share one, built in this build tree by the object
# library polybody_pch (the header of an imported target cannot be shared, hence the function); each further set of compile
# settings makes one more, polybody_pch_<hash>.
#
#   find_package(polybody REQUIRED)
#   add_executable(app app.cpp)
#   target_link_libraries(app PRIVATE polybody::polybody)
#   polybody_precompile(app)
#
# The call takes effect at the end of the CMakeLists.txt of its folder and includes later settings. Targets share a
# header if they have equal options, definitions, features and language standard, including those of linked libraries;
# a generator expression is compared as text. Settings of single source files and libraries within generator
# expressions are not compared: if they differ, GCC warns (-Winvalid-pch) and reads the header again, and clang stops.
function(polybody_precompile)
  if(NOT ARGN)
    message(FATAL_ERROR "polybody_precompile: name the targets that include <polybody/polybody.hpp>.")
  endif()
  foreach(target IN LISTS ARGN)
    if(NOT TARGET "${target}")
      message(FATAL_ERROR "polybody_precompile: \"${target}\" is not a target. Call polybody_precompile after add_executable or add_library.")
    endif()
    get_target_property(aliased "${target}" ALIASED_TARGET)
    get_target_property(imported "${target}" IMPORTED)
    get_target_property(type "${target}" TYPE)
    if(aliased OR imported OR NOT type MATCHES "^(EXECUTABLE|(STATIC|SHARED|MODULE|OBJECT)_LIBRARY)$")
      message(FATAL_ERROR "polybody_precompile: \"${target}\" is an alias, an imported target or an interface library, which "
                          "this build does not compile. Name a target of add_executable or add_library.")
    endif()
    cmake_language(EVAL CODE "cmake_language(DEFER CALL _polybody_precompile [[${target}]])")
  endforeach()
endfunction()

# The functions below are called by the function above only.

# Properties of a target that its precompiled header must share; those of the second list gather along the linked libraries.
set_property(
  GLOBAL
  PROPERTY _polybody_own_settings
           CXX_STANDARD
           CXX_STANDARD_REQUIRED
           CXX_EXTENSIONS
           COMPILE_FLAGS
           CXX_VISIBILITY_PRESET
           VISIBILITY_INLINES_HIDDEN
           INTERPROCEDURAL_OPTIMIZATION
           MSVC_RUNTIME_LIBRARY)
set_property(GLOBAL PROPERTY _polybody_gathered_settings COMPILE_OPTIONS COMPILE_DEFINITIONS COMPILE_FEATURES)

# The targets that `target` links, directly or not, in the order of their first appearance.
function(_polybody_linked target out)
  set(found "")
  get_target_property(todo "${target}" LINK_LIBRARIES)
  while(todo)
    list(POP_FRONT todo library)
    if(NOT TARGET "${library}")
      continue()
    endif()
    get_target_property(aliased "${library}" ALIASED_TARGET)
    if(aliased)
      set(library "${aliased}")
    endif()
    if(library IN_LIST found)
      continue()
    endif()
    list(APPEND found "${library}")
    get_target_property(next "${library}" INTERFACE_LINK_LIBRARIES)
    if(next)
      list(APPEND todo ${next})
    endif()
  endwhile()
  set(${out} "${found}" PARENT_SCOPE)
endfunction()

function(_polybody_precompile target)
  get_target_property(shared "${target}" PRECOMPILE_HEADERS_REUSE_FROM)
  if(shared MATCHES "^polybody_pch(_[0-9a-f]+)?$")
    return() # called twice
  endif()
  get_target_property(own "${target}" PRECOMPILE_HEADERS)
  if(own OR shared)
    message(FATAL_ERROR "polybody_precompile: target \"${target}\" has precompiled headers already, and a target can "
                        "have only one set. Add <polybody/polybody.hpp> to that set instead.")
  endif()
  _polybody_linked("${target}" libraries)
  get_target_property(polybody polybody::polybody ALIASED_TARGET)
  if(NOT polybody)
    set(polybody polybody::polybody)
  endif()
  if(NOT polybody IN_LIST libraries)
    message(FATAL_ERROR "polybody_precompile: target \"${target}\" does not link polybody::polybody.")
  endif()

  set(header <polybody/polybody.hpp>)
  if(polybody_compiled IN_LIST libraries)
    set(header <polybody/compiled.hpp>)
    _polybody_precompile(polybody_compiled)
  elseif("${target}" STREQUAL "polybody_compiled")
    set(header <polybody/compiled.hpp>)
  endif()

  # the settings
  get_property(own_settings GLOBAL PROPERTY _polybody_own_settings)
  get_property(gathered_settings GLOBAL PROPERTY _polybody_gathered_settings)
  set(key "${header}\n")
  foreach(setting IN LISTS own_settings)
    get_target_property(${setting} "${target}" ${setting})
    string(APPEND key "${setting}=${${setting}}\n")
  endforeach()
  foreach(setting IN LISTS gathered_settings)
    get_target_property(values "${target}" ${setting})
    if(NOT values)
      set(values "")
    endif()
    foreach(library IN LISTS libraries)
      get_target_property(more "${library}" INTERFACE_${setting})
      if(more AND NOT library STREQUAL polybody) # polybody_pch links that itself
        list(APPEND values ${more})
      endif()
    endforeach()
    if(setting STREQUAL "COMPILE_FEATURES") # polybody asks for C++20: an older standard changes nothing
      list(FILTER values EXCLUDE REGEX "^cxx_std_(98|11|14|17|20)$")
    endif()
    set(${setting} "${values}")
    string(APPEND key "${setting}=${values}\n")
  endforeach()
  get_target_property(type "${target}" TYPE)
  get_target_property(independent "${target}" POSITION_INDEPENDENT_CODE)
  set(pie OFF)
  if(NOT independent)
    set(independent OFF)
  elseif(type STREQUAL "EXECUTABLE") # an object library would take the option of a library
    set(independent OFF)
    set(pie ON)
  else()
    set(independent ON)
  endif()
  string(APPEND key "independent=${independent} pie=${pie}\n")
  foreach(variable IN ITEMS CMAKE_BUILD_TYPE CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_DEBUG CMAKE_CXX_FLAGS_RELEASE
                            CMAKE_CXX_FLAGS_RELWITHDEBINFO CMAKE_CXX_FLAGS_MINSIZEREL) # a folder may change them
    string(APPEND key "${variable}=${${variable}}\n")
  endforeach()
  string(SHA1 hash "${key}")

  get_property(pch GLOBAL PROPERTY _polybody_pch_${hash})
  if(NOT pch)
    set(pch polybody_pch)
    if(TARGET ${pch})
      string(SUBSTRING ${hash} 0 8 short)
      set(pch polybody_pch_${short})
    endif()
    set_property(GLOBAL PROPERTY _polybody_pch_${hash} ${pch})
    set(source ${CMAKE_BINARY_DIR}/polybody_pch/polybody_pch.cpp) # CMake makes no precompiled header without a source
    file(CONFIGURE OUTPUT ${source} CONTENT "// Compiled with a precompiled header of polybody and nothing else.\n")
    add_library(${pch} OBJECT EXCLUDE_FROM_ALL ${source})
    foreach(setting IN LISTS own_settings gathered_settings)
      if("${${setting}}" MATCHES "-NOTFOUND$" OR "${${setting}}" STREQUAL "")
        set_property(TARGET ${pch} PROPERTY ${setting})
      else()
        set_property(TARGET ${pch} PROPERTY ${setting} "${${setting}}")
      endif()
    endforeach()
    set_target_properties(${pch} PROPERTIES POSITION_INDEPENDENT_CODE ${independent})
    if(pie)
      target_compile_options(${pch} PRIVATE ${CMAKE_CXX_COMPILE_OPTIONS_PIE})
    endif()
    target_link_libraries(${pch} PRIVATE polybody::polybody)
    target_precompile_headers(${pch} PRIVATE ${header})
  endif()
  target_precompile_headers("${target}" REUSE_FROM ${pch})
endfunction()
