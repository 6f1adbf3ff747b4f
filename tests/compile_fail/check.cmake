# cmake -DCOMPILER=<c++> -DSOURCE=<file.cpp> -DINCLUDES=<dir|dir|...> -DPRECOMPILED=<header or nothing> -DLINES=<n> -P
# check.cmake
# Succeeds if the compiler accepts SOURCE, or refuses it with the sentence of its first line among the first n lines
# of the message. The compiler takes the options of the second line, `// options: …`, or -std=c++20.

file(STRINGS ${SOURCE} first_line LIMIT_COUNT 1)
if(first_line MATCHES "^// refused: (.+)$")
  set(expected "${CMAKE_MATCH_1}")
  # A single word could be the compiler's own. Required<...> is the exception: no compiler prints a sentence for a member
  # without an initialiser, and the name of the type is the reason.
  string(REGEX MATCHALL "[A-Za-z<>]+" words "${expected}")
  list(LENGTH words count)
  if(count LESS 4 AND NOT expected STREQUAL "Required")
    message(FATAL_ERROR "${SOURCE}: '${expected}' is no sentence; write at least four words of it")
  endif()
elseif(NOT first_line STREQUAL "// accepted")
  message(FATAL_ERROR "${SOURCE}: the first line must be '// refused: <regex>' or '// accepted'")
endif()

file(STRINGS ${SOURCE} options REGEX "^// options: ")
set(language -std=c++20)
if(options)
  string(REGEX REPLACE "^// options: " "" options "${options}")
  separate_arguments(language UNIX_COMMAND "${options}")
endif()

string(REGEX REPLACE "([^|]+)\\|?" "-isystem;\\1;" include_flags "${INCLUDES}")

if(PRECOMPILED) # as <header>.gch, for g++ and for clang++
  list(APPEND include_flags -include ${PRECOMPILED})
endif()

# Only the options that a program needs, so the message is that of a user's build. LC_ALL gives plain ASCII quotes.
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C ${COMPILER} ${language} -fsyntax-only ${include_flags} ${SOURCE}
  RESULT_VARIABLE result
  OUTPUT_VARIABLE message
  ERROR_VARIABLE message)

if(NOT DEFINED expected)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${SOURCE} must compile, but:\n${message}")
  endif()
  return()
elseif(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, but must be refused with: ${expected}")
endif()

# Only errors and notes count, not the source lines that the compiler prints with them.
set(rest "${message}\n")
foreach(line RANGE 1 ${LINES})
  string(FIND "${rest}" "\n" end)
  if(end LESS 0)
    break()
  endif()
  string(SUBSTRING "${rest}" 0 ${end} text)
  if(text MATCHES ": (error|note): " AND text MATCHES "${expected}")
    return()
  endif()
  math(EXPR end "${end} + 1")
  string(SUBSTRING "${rest}" ${end} -1 rest)
endforeach()
message(FATAL_ERROR "${SOURCE} is refused, but the first ${LINES} lines do not say: ${expected}\n"
                    "The compiler said:\n${message}")
