# Everything comes from the distribution's packages; scripts/packages names them.
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(LCM REQUIRED)  # cmake/FindLCM.cmake
if(TERRA_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

# terra_find_library(TARGET HEADER header LIBRARY name): an imported target for
# a library that ships no CMake package (or a heavy one).
function(terra_find_library target)
  cmake_parse_arguments(ARG "" "HEADER;SUFFIX" "LIBRARIES" ${ARGN})
  string(MAKE_C_IDENTIFIER "${target}" id)
  find_path(${id}_INCLUDE_DIR ${ARG_HEADER} PATH_SUFFIXES ${ARG_SUFFIX} REQUIRED)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE "${${id}_INCLUDE_DIR}")
  foreach(library IN LISTS ARG_LIBRARIES)
    find_library(${id}_${library} ${library} REQUIRED)
    target_link_libraries(${target} INTERFACE "${${id}_${library}}")
  endforeach()
endfunction()

terra_find_library(terra::opencv HEADER opencv2/core.hpp SUFFIX opencv4
                   LIBRARIES opencv_imgcodecs opencv_imgproc opencv_core)
terra_find_library(terra::zstd HEADER zstd.h LIBRARIES zstd)
terra_find_library(terra::xxhash HEADER xxhash.h LIBRARIES xxhash)
