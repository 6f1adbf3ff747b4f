# polybody_warnings: linked by our own tests, examples and benchmarks; never by a user.
add_library(polybody_warnings INTERFACE)
# The full -Wshadow of GCC warns of a template parameter if a global of the user has the same name, so GCC checks
# locals only; clang checks the rest (.ci/run, or the clang preset).
target_compile_options(
  polybody_warnings
  INTERFACE -Wall -Wextra -Wpedantic $<IF:$<CXX_COMPILER_ID:GNU>,-Wshadow=local,-Wshadow>)

if(POLYBODY_WERROR)
  target_compile_options(polybody_warnings INTERFACE -Werror)
  # GCC's flow analysis misfires inside inlined Eigen code; these stay warnings.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(
      polybody_warnings
      INTERFACE -Wno-error=maybe-uninitialized -Wno-error=array-bounds -Wno-error=stringop-overflow)
  endif()
endif()
