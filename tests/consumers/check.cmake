# cmake -DWAY=<way> -DBUILD=... (see CMakeLists.txt) -P check.cmake
# Installs polybody, or builds and runs consumer.cpp against it in one of several ways. `extensions` builds
# user-defined types, and runs them and their law suites.

set(here ${CMAKE_CURRENT_LIST_DIR})
set(dir ${WORK}/${WAY})
set(prefix ${WORK}/installed)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# build_and_run(<project folder> <cmake option>...)
function(build_and_run project)
  run(${CMAKE_COMMAND} -S ${here}/${project} -B ${dir} --fresh -G ${GENERATOR}
      -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}" ${ARGN})
  run(${CMAKE_COMMAND} --build ${dir})
  run(${dir}/consumer)
endfunction()

if(WAY STREQUAL "install")
  # Installed in one folder, then moved: the installation must not depend on its original path.
  file(REMOVE_RECURSE ${WORK}/staged ${prefix})
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/staged)
  file(RENAME ${WORK}/staged ${prefix})

elseif(WAY STREQUAL "install_tree")
  build_and_run(find_package -DCMAKE_PREFIX_PATH=${prefix} -DEXPECT=${prefix} -DVERSION=${VERSION})

elseif(WAY STREQUAL "build_tree")
  build_and_run(find_package -Dpolybody_DIR=${BUILD} -DEXPECT=${BUILD} -DVERSION=${VERSION})

elseif(WAY STREQUAL "components")
  # A program needs the headers only. If a component is missing, the error message names it and its source.
  set(root ${dir}_root)
  file(REMOVE_RECURSE ${root})
  run(${CMAKE_COMMAND} --install ${BUILD} --component headers --prefix ${root})
  build_and_run(find_package -DCMAKE_PREFIX_PATH=${root} -DEXPECT=${root} -DVERSION=${VERSION})
  foreach(component IN ITEMS compiled testing)
    set(command ${CMAKE_COMMAND} -S ${here}/find_package -B ${dir}_refused --fresh -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
                -DCMAKE_PREFIX_PATH=${root} -DEXPECT=${root} -DVERSION=${VERSION} -DCOMPONENT=${component})
    execute_process(COMMAND ${command} RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE said)
    string(REGEX REPLACE "[ \n]+" " " said "${said}")
    if(NOT failed OR NOT said MATCHES "component ${component} is not installed")
      message(FATAL_ERROR "A component that is not installed, ${component}, is not refused in a sentence:\n${said}")
    endif()
    run(${CMAKE_COMMAND} --install ${BUILD} --component ${component} --prefix ${root})
    run(${command})
  endforeach()

elseif(WAY STREQUAL "add_subdirectory")
  build_and_run(add_subdirectory -DPOLYBODY=${SOURCE})

elseif(WAY STREQUAL "fetch_content")
  build_and_run(fetch_content -DFETCHCONTENT_SOURCE_DIR_POLYBODY=${SOURCE})

elseif(WAY STREQUAL "precompiled")
  set(common -DCMAKE_PREFIX_PATH=${prefix} -DVERSION=${VERSION})
  # a name that is not a target of the build is refused with a message
  foreach(wrong IN ITEMS nothing polybody::polybody)
    execute_process(
      COMMAND ${CMAKE_COMMAND} -S ${here}/precompiled -B ${dir}_refused --fresh -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
              ${common} -DWRONG=${wrong}
      RESULT_VARIABLE failed
      OUTPUT_QUIET
      ERROR_VARIABLE said)
    if(NOT failed OR NOT said MATCHES "polybody_precompile: \"${wrong}\" is")
      message(FATAL_ERROR "polybody_precompile(${wrong}) is not refused in a sentence:\n${said}")
    endif()
  endforeach()
  build_and_run(precompiled ${common})

elseif(WAY STREQUAL "compiled")
  # Flags for another processor than that of FLAGS: longer SIMD vectors, or shorter ones.
  set(other "")
  cmake_host_system_information(RESULT processor QUERY OS_PLATFORM)
  if(processor STREQUAL "x86_64")
    execute_process(COMMAND sh -c "echo __AVX__ | ${COMPILER} ${FLAGS} -E -x c++ - | tail -1" OUTPUT_VARIABLE avx)
    set(other -mavx2)
    if(avx MATCHES "^1")
      set(other -mno-avx)
    endif()
  endif()
  build_and_run(compiled -DCMAKE_PREFIX_PATH=${prefix} -DVERSION=${VERSION} "-DOTHER_MACHINE=${other}")
  if(other)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${dir} --target other RESULT_VARIABLE failed OUTPUT_VARIABLE said
                    ERROR_VARIABLE said)
    if(NOT failed OR NOT said MATCHES "undefined reference[^\n]*Build")
      message(FATAL_ERROR "A program for another machine (${other}) links with the library, or fails otherwise:\n${said}")
    endif()
  endif()

elseif(WAY STREQUAL "extensions")
  # the page shows each header, and no other
  file(READ ${SOURCE}/docs/extending.md page)
  file(GLOB headers RELATIVE ${here}/extensions ${here}/extensions/*.hpp)
  string(REGEX MATCHALL "\n## [^\n]*: `[^`]*\\.hpp`" shown "${page}")
  list(TRANSFORM shown REPLACE ".*`(.*)`" "\\1")
  list(SORT shown)
  if(NOT shown STREQUAL headers)
    message(FATAL_ERROR "docs/extending.md shows ${shown}, but there are ${headers}")
  endif()
  string(APPEND FLAGS " -Wall -Wextra -Wpedantic")
  if(WERROR)
    string(APPEND FLAGS " -Werror")
  endif()
  build_and_run(extensions -DCMAKE_PREFIX_PATH=${prefix} -DVERSION=${VERSION})
  run(${CMAKE_CTEST_COMMAND} --test-dir ${dir} --output-on-failure)

elseif(WAY STREQUAL "pkg_config")
  # Without CMake: c++ -std=c++20 consumer.cpp $(pkg-config --cflags polybody)
  find_program(PKG_CONFIG NAMES pkg-config pkgconf REQUIRED)
  set(ENV{PKG_CONFIG_PATH} ${prefix}/share/pkgconfig:$ENV{PKG_CONFIG_PATH})
  execute_process(
    COMMAND ${PKG_CONFIG} --cflags "polybody >= ${VERSION}"
    OUTPUT_VARIABLE cflags
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(cflags UNIX_COMMAND "${cflags}")
  separate_arguments(FLAGS UNIX_COMMAND "${FLAGS}")
  file(MAKE_DIRECTORY ${dir})
  run(${COMPILER} -std=c++20 ${FLAGS} ${cflags} ${here}/consumer.cpp -o ${dir}/consumer)
  run(${dir}/consumer)
  # the law suites, if pkg-config finds GoogleTest
  execute_process(COMMAND ${PKG_CONFIG} --exists gtest_main RESULT_VARIABLE without_gtest)
  if(NOT without_gtest)
    run(${PKG_CONFIG} --exists --print-errors "polybody-testing = ${VERSION}")
  endif()

elseif(WAY STREQUAL "deb")
  # The unpacked package: its metadata, and a program against it.
  file(REMOVE_RECURSE ${dir}_made ${dir}_root)
  run(${CMAKE_COMMAND} -S ${SOURCE} -B ${dir}_made -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER} -DPOLYBODY_BUILD_TESTS=OFF
      -DPOLYBODY_BUILD_EXAMPLES=OFF -DPOLYBODY_BUILD_BENCH=OFF)
  run(${CPACK} -G DEB --config ${dir}_made/CPackConfig.cmake -B ${dir}_made/package)
  set(package ${dir}_made/package/libpolybody-dev_${VERSION}_all.deb)
  execute_process(COMMAND ${DPKG_DEB} -f ${package} Depends OUTPUT_VARIABLE depends COMMAND_ERROR_IS_FATAL ANY)
  if(NOT depends MATCHES "libeigen3-dev \\(>= 3.4\\)")
    message(FATAL_ERROR "${package} depends on ${depends}")
  endif()
  run(${DPKG_DEB} -x ${package} ${dir}_root)
  build_and_run(find_package -DCMAKE_PREFIX_PATH=${dir}_root/usr -DEXPECT=${dir}_root/usr -DVERSION=${VERSION})

elseif(WAY STREQUAL "single_header")
  # One file, together with two others that include it, and nothing else.
  file(REMOVE_RECURSE ${dir})
  file(MAKE_DIRECTORY ${dir}/polybody)
  run(${PYTHON} ${SOURCE}/cmake/packages/single_header.py -o ${dir}/polybody/polybody.hpp)
  file(WRITE ${dir}/other.cpp "#include <polybody/polybody.hpp>\nchar const* version() { return polybody::library_version; }\n")
  set(includes -I${dir})
  foreach(folder IN LISTS EIGEN)
    list(APPEND includes -isystem ${folder})
  endforeach()
  separate_arguments(FLAGS UNIX_COMMAND "${FLAGS}")
  run(${COMPILER} -std=c++20 ${FLAGS} -Wall -Wextra ${includes} ${SOURCE}/examples/ex01_pendulum.cpp ${dir}/other.cpp -pthread -o
      ${dir}/pendulum)
  run(${dir}/pendulum)
  execute_process(
    COMMAND ${PYTHON} ${SOURCE}/cmake/packages/single_header.py --also no/such.hpp -o ${dir}/none.hpp
    RESULT_VARIABLE failed
    ERROR_VARIABLE said)
  if(NOT failed OR NOT said MATCHES "there is no header polybody/no/such.hpp" OR EXISTS ${dir}/none.hpp)
    message(FATAL_ERROR "A header that is not there is not refused in a sentence: ${said}")
  endif()

elseif(WAY STREQUAL "recipes")
  # The recipes are checked without their package managers: recipes.py simulates these.
  run(${PYTHON} -B ${here}/recipes.py ${SOURCE} ${VERSION})

else()
  message(FATAL_ERROR "no way named '${WAY}'")
endif()
