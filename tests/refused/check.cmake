# cmake -DCOMPILER=<c++> -DCOMPILER_ID=<GNU or Clang> -DSOURCE=<file.cpp> -DINCLUDES=<dir|dir|...>
#       -P check.cmake
# Succeeds when the compiler accepts or refuses SOURCE as its first line says.

file(STRINGS ${SOURCE} first_line LIMIT_COUNT 1)
if(first_line MATCHES "^// refused: (.+)$")
  set(expected "${CMAKE_MATCH_1}")
elseif(NOT first_line STREQUAL "// accepted")
  message(FATAL_ERROR "${SOURCE}: the first line must be '// refused: <regex>' or '// accepted'")
endif()

string(REGEX REPLACE "([^|]+)\\|?" "-isystem;\\1;" include_flags "${INCLUDES}")

# Plain ASCII quotes (LC_ALL) and no source lines in the message: the regex sees the words only.
if(COMPILER_ID STREQUAL "GNU")
  set(words_only -fno-diagnostics-show-caret -fmessage-length=0)
else()
  set(words_only -fno-caret-diagnostics -fmessage-length=0)
endif()
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C ${COMPILER} -std=c++20 -fsyntax-only
          ${words_only} ${include_flags} ${SOURCE}
  RESULT_VARIABLE result
  OUTPUT_VARIABLE message
  ERROR_VARIABLE message)

if(NOT DEFINED expected)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${SOURCE} must compile, but:\n${message}")
  endif()
elseif(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, but must be refused with: ${expected}")
elseif(NOT message MATCHES "${expected}")
  message(FATAL_ERROR "${SOURCE} is refused, but not with: ${expected}\nThe compiler said:\n${message}")
endif()
