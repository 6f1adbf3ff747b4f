# Sets polybody_unsuitable to a sentence if the compiler or the flags of all targets (CMAKE_CXX_FLAGS) do not suit
# polybody, else to nothing. The headers check the same (polybody/math/compiler.hpp); this check comes before the build.
# C++17 as CMAKE_CXX_STANDARD needs no check: targets that link polybody::polybody are compiled as C++20.
set(polybody_unsuitable "")
foreach(_polybody_oldest IN ITEMS "GNU 12" "Clang 16" "AppleClang 15")
  separate_arguments(_polybody_oldest)
  list(POP_FRONT _polybody_oldest _polybody_name)
  if(CMAKE_CXX_COMPILER_ID STREQUAL _polybody_name AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS _polybody_oldest)
    set(polybody_unsuitable
        "polybody needs g++ 12, clang 16 or Apple clang 15, or newer, but CMAKE_CXX_COMPILER is ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} (${CMAKE_CXX_COMPILER})."
    )
  endif()
endforeach()
string(TOUPPER "${CMAKE_BUILD_TYPE}" _polybody_name)
set(_polybody_flags " ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${_polybody_name}} ")
if(_polybody_flags MATCHES " (-std=(c|gnu)\\+\\+(98|03|0x|11|1y|14|1z|17)) ")
  set(polybody_unsuitable "polybody needs C++20, but CMAKE_CXX_FLAGS contains ${CMAKE_MATCH_1}. Remove it.")
elseif(_polybody_flags MATCHES " (-ffast-math|-Ofast|-ffinite-math-only) ")
  set(polybody_unsuitable
      "polybody refuses the option ${CMAKE_MATCH_1} of CMAKE_CXX_FLAGS: it removes the checks for NaN. Use -O2 or -O3.")
endif()
unset(_polybody_oldest)
unset(_polybody_name)
unset(_polybody_flags)
