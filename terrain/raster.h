#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace terra {

/// One byte per cell, row by row: raster(y, x). Row 0 is the top.
using ByteRaster =
    Eigen::Array<std::uint8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace terra
