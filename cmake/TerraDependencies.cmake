# Everything comes from the distribution's packages; scripts/packages names them.
include(TerraFindLibrary)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(LCM REQUIRED)  # cmake/FindLCM.cmake
find_package(CLI11 REQUIRED)
if(TERRA_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
terra_find_library(terra::opencv HEADER opencv2/core.hpp SUFFIX opencv4
                   LIBRARIES opencv_imgproc opencv_core)
terra_find_library(terra::zstd HEADER zstd.h LIBRARIES zstd)
terra_find_library(terra::xxhash HEADER xxhash.h LIBRARIES xxhash)
