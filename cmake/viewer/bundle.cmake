# cmake -P bundle.cmake, called by the target `viewer`: packages in FOLDER, the page as OUT. In MODE AUTO a failure is told
# and passes; the next build after a change of the sources, or of the target by hand, tries again.
function(give_up what text)
  if(MODE STREQUAL "AUTO")
    message("The viewer of films is not built: ${what}. Everything else is built.\n${text}")
    file(REMOVE ${OUT})
    file(TOUCH ${FOLDER}/tried)
  else()
    message(FATAL_ERROR "The viewer of films cannot be built: ${what}.\n${text}")
  endif()
endfunction()

file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${FOLDER})
file(SHA256 ${SOURCE}/package-lock.json lock)
if(NOT EXISTS ${FOLDER}/packages_of_${lock})
  execute_process(
    COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1 --fetch-timeout=60000
    WORKING_DIRECTORY ${FOLDER}
    RESULT_VARIABLE result
    OUTPUT_VARIABLE text
    ERROR_VARIABLE text)
  if(NOT result EQUAL 0)
    give_up("npm cannot fetch its packages" "${text}")
    return()
  endif()
  file(TOUCH ${FOLDER}/packages_of_${lock})
endif()
execute_process(COMMAND ${NODE} ${SOURCE}/build.mjs ${FOLDER} ${OUT} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
if(NOT result EQUAL 0)
  give_up("its sources cannot be bundled" "${text}")
  return()
endif()
file(TOUCH ${FOLDER}/tried)
