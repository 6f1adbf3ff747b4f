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

# refused(<regex> <project folder> <cmake option>...): CMake must refuse the project with a sentence, `said`
macro(refused sentence)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${ARGN} -B ${dir} --fresh -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
    RESULT_VARIABLE failed
    OUTPUT_VARIABLE said
    ERROR_VARIABLE said)
  string(REGEX REPLACE "[ \n]+" " " said "${said}")
  if(NOT failed OR NOT said MATCHES "${sentence}")
    message(FATAL_ERROR "${ARGN} is not refused with \"${sentence}\":\n${said}")
  endif()
endmacro()

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

elseif(WAY STREQUAL "package_refusals")
  # Projects that find_package refuses, with the sentence of each refusal. No project is built.
  set(find ${here}/find_package -Dpolybody_DIR=${BUILD} -DEXPECT=${BUILD} -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
  refused("no component fluid; its components are headers, compiled and testing" ${find} -DVERSION=${VERSION} -DCOMPONENT=fluid)
  refused("needs Eigen 3.4 or newer [(]Debian: libeigen3-dev[)]" ${find} -DVERSION=${VERSION} -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
  refused("refuses the option -ffast-math" ${find} -DVERSION=${VERSION} -DCMAKE_CXX_FLAGS=-O3\ -ffast-math)
  refused("needs C[+][+]20, but CMAKE_CXX_FLAGS contains -std=c[+][+]17" ${find} -DVERSION=${VERSION} -DCMAKE_CXX_FLAGS=-std=c++17)
  refused("exactly matches requested version .${VERSION}.1" ${find} -DVERSION=${VERSION}.1 -DEXACT=EXACT)
  set(configure ${CMAKE_COMMAND} -S ${find} -B ${dir} --fresh -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER})
  string(REGEX REPLACE "^([0-9]+[.][0-9]+)[.]0$" "\\1" short ${VERSION}) # 0.2.0 is 0.2
  foreach(version IN ITEMS ${VERSION} ${short})
    run(${configure} -DVERSION=${version} -DEXACT=EXACT -DCOMPONENT=headers)
  endforeach()
  run(${configure} -DVERSION=${VERSION} -DCMAKE_CXX_STANDARD=17) # polybody::polybody raises it
  file(READ ${dir}/compile_commands.json commands)
  if(commands MATCHES "[+][+]17")
    message(FATAL_ERROR "A project of C++17 that links polybody::polybody is not compiled as C++20:\n${commands}")
  endif()

elseif(WAY STREQUAL "build_refusals")
  # Configurations that CMakeLists.txt refuses, with the sentence of each refusal. No project is built.
  # The configuration of git redirects the clone of Eigen to a missing folder.
  set(own ${SOURCE} -DPOLYBODY_BUILD_TESTS=OFF -DPOLYBODY_BUILD_EXAMPLES=OFF -DPOLYBODY_BUILD_BENCH=OFF -DPOLYBODY_VIEWER=OFF)
  set(ENV{GIT_CONFIG_COUNT} 1)
  set(ENV{GIT_CONFIG_KEY_0} url.file:///nowhere/.insteadOf)
  set(ENV{GIT_CONFIG_VALUE_0} https://gitlab.com/)
  refused("Debian: libeigen3-dev" ${own} -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
  if(said MATCHES "Cloning|clone")
    message(FATAL_ERROR "Eigen is cloned although its repository is not reached:\n${said}")
  endif()
  refused("refuses the option -Ofast" ${own} -DCMAKE_CXX_FLAGS=-Ofast)
  refused("needs C[+][+]20, but CMAKE_CXX_FLAGS contains -std=gnu[+][+]17" ${own} -DCMAKE_CXX_FLAGS=-std=gnu++17)
  # compilers of every age
  foreach(compiler IN ITEMS "GNU 11.4 old" "GNU 12.1 new" "Clang 15.0 old" "Clang 16.0 new" "AppleClang 14.0 old" "Intel 1 new")
    separate_arguments(compiler)
    list(GET compiler 0 CMAKE_CXX_COMPILER_ID)
    list(GET compiler 1 CMAKE_CXX_COMPILER_VERSION)
    list(GET compiler 2 age)
    include(${SOURCE}/cmake/polybodyCompiler.cmake)
    set(name "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
    if(age STREQUAL "old" AND NOT polybody_unsuitable MATCHES "needs g[+][+] 12.* is ${name}")
      message(FATAL_ERROR "${name} is not refused in a sentence: ${polybody_unsuitable}")
    elseif(age STREQUAL "new" AND polybody_unsuitable)
      message(FATAL_ERROR "${name} is refused: ${polybody_unsuitable}")
    endif()
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

elseif(WAY STREQUAL "first_program")
  # The commands of the pages compile the program of the first guide page, beside the folder polybody.
  file(REMOVE_RECURSE ${dir})
  file(MAKE_DIRECTORY ${dir})
  file(CREATE_LINK ${SOURCE} ${dir}/polybody SYMBOLIC)
  set(page ${SOURCE}/docs/guide/first_model.md)
  run(${PYTHON} -B ${SOURCE}/tests/guide/programs.py write ${page} double_pendulum ${dir}/double_pendulum.cpp)
  set(commands "")
  foreach(file IN ITEMS README.md docs/using.md docs/guide/first_model.md)
    file(READ ${SOURCE}/${file} text)
    if(NOT text MATCHES "g[+][+] -std=[^`\n]*")
      message(FATAL_ERROR "${file} has no command that compiles a program.")
    endif()
    string(REGEX REPLACE "([ \n])(double_pendulum|program)" "\\1double_pendulum" command "${CMAKE_MATCH_0}")
    list(APPEND commands "${command}")
  endforeach()
  list(REMOVE_DUPLICATES commands)
  list(LENGTH commands count)
  if(NOT count EQUAL 1)
    message(FATAL_ERROR "The commands of the pages differ: ${commands}")
  endif()
  if(EXISTS /usr/include/eigen3)
    string(REPLACE "g++ " "${COMPILER} -fsyntax-only " command "${commands}")
    separate_arguments(command UNIX_COMMAND "${command}")
    run(${command} WORKING_DIRECTORY ${dir})
  endif()

elseif(WAY STREQUAL "recipes")
  # The recipes are checked without their package managers: recipes.py simulates these.
  run(${PYTHON} -B ${here}/recipes.py ${SOURCE} ${VERSION})

else()
  message(FATAL_ERROR "no way named '${WAY}'")
endif()
