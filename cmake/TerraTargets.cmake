# The three functions that every folder's CMakeLists.txt uses, and the flags
# that all own code is built with.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Libraries that were found outside the system's folders are found there after
# the installation too.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Costs must come out the same on every machine and in every build, so no fused
# multiply-add.
add_library(terra_flags INTERFACE)
target_compile_options(terra_flags INTERFACE -ffp-contract=off
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wold-style-cast
  -Wnon-virtual-dtor $<$<BOOL:${TERRA_WERROR}>:-Werror>)
target_include_directories(terra_flags INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
if(TERRA_SANITIZE)
  # Instrumented code makes gcc see uninitialised memory where there is none (its
  # manual says so of -Wmaybe-uninitialized). The release build takes the same
  # warning for an error.
  target_compile_options(terra_flags INTERFACE -fsanitize=${TERRA_SANITIZE}
    -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized>)
  target_link_options(terra_flags INTERFACE -fsanitize=${TERRA_SANITIZE})
endif()

if(TERRA_COVERAGE)
  target_compile_options(terra_flags INTERFACE --coverage -fno-inline)
  target_link_options(terra_flags INTERFACE --coverage)
endif()

# terra_library(NAME SRCS a.cc b.cc [DEPS other_library ...])
# One static library per folder; DEPS are public.
function(terra_library name)
  cmake_parse_arguments(ARG "" "" "SRCS;DEPS" ${ARGN})
  add_library(${name} STATIC ${ARG_SRCS})
  target_link_libraries(${name} PUBLIC ${ARG_DEPS}
                                PRIVATE $<BUILD_INTERFACE:terra_flags>)
  target_compile_features(${name} INTERFACE cxx_std_20)
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/terra_advisor>)
endfunction()

# terra_executable(NAME SRCS main.cc [DEPS library ...])
function(terra_executable name)
  cmake_parse_arguments(ARG "" "" "SRCS;DEPS" ${ARGN})
  add_executable(${name} ${ARG_SRCS})
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} terra_flags)
endfunction()

# terra_test(FOLDER SRCS a_test.cc ... [DEPS library ...] [LABELS label ...]
#            [NAME executable] [TIMEOUT seconds])
# One GoogleTest program per tested folder; ctest names are folder.Suite.Test.
# LABELS: long = not in the sanitizer part of CI; threads = run under TSan too,
# by the target thread_tests.
function(terra_test folder)
  cmake_parse_arguments(ARG "" "NAME;TIMEOUT" "SRCS;DEPS;LABELS" ${ARGN})
  if(NOT ARG_NAME)
    string(REPLACE "/" "_" ARG_NAME "${folder}_test")
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 180)
  endif()
  string(REPLACE "/" "." prefix "${folder}.")
  add_executable(${ARG_NAME} ${ARG_SRCS})
  # Test files keep their helpers in unnamed namespaces under the same names, so
  # each is compiled alone even where the libraries are unity builds.
  set_target_properties(${ARG_NAME} PROPERTIES UNITY_BUILD OFF
    RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
  target_link_libraries(${ARG_NAME} PRIVATE ${ARG_DEPS} terra_flags
                        GTest::gmock GTest::gtest GTest::gtest_main)
  if(TARGET terra_test_headers)
    target_precompile_headers(${ARG_NAME} REUSE_FROM terra_test_headers)
    # Precompiled, gcc 12's false alarms in std::string no longer count as those
    # of a system header (gcc bug 105651).
    target_compile_options(${ARG_NAME} PRIVATE
      -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow)
  endif()
  if("threads" IN_LIST ARG_LABELS)
    add_dependencies(thread_tests ${ARG_NAME})
  endif()
  gtest_discover_tests(${ARG_NAME} TEST_PREFIX "${prefix}"
    DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES
    PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
endfunction()
