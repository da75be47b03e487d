# Everything comes from the distribution's packages; scripts/packages names them.
# Each is looked for here, in the top folder, so that all folders see its targets
# (find_package's GLOBAL would do that too, but CMake knows it from 3.24 on).
include(TerraFindLibrary)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(LCM REQUIRED)  # cmake/FindLCM.cmake
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(spdlog REQUIRED)
find_package(yaml-cpp REQUIRED)
if(TERRA_BUILD_TESTS)
  find_package(GTest CONFIG REQUIRED)  # FindGTest knows gmock from CMake 3.23 on
  include(GoogleTest)
endif()
terra_find_library(terra::opencv HEADER opencv2/core.hpp SUFFIX opencv4
                   LIBRARIES opencv_imgproc opencv_core)
terra_find_library(terra::zstd HEADER zstd.h LIBRARIES zstd)
# Headers alone, for bus/toml_config.cc.
find_path(TERRA_TOMLPLUSPLUS toml++/toml.h REQUIRED)
mark_as_advanced(TERRA_TOMLPLUSPLUS)
terra_find_library(terra::xxhash HEADER xxhash.h LIBRARIES xxhash)
