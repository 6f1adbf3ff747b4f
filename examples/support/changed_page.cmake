# Writes the page PAGE with a changed number of its table "Coarsest settings" to TO, for a test of the check.
file(READ ${PAGE} text)
string(REGEX REPLACE "\n(## Coarsest settings.*\n[|]---[^\n]*\n[|][^|]*[|][^|]*[|]) [^|]* [|]" "\n\\1 99 |" changed "${text}")
if(changed STREQUAL text)
  message(FATAL_ERROR "${PAGE}: the table \"Coarsest settings\" has no row.")
endif()
file(WRITE ${TO} "${changed}")
