#pragma once

#include <cstdint>

#include "terrain/cell.h"

namespace terra {

/// Where a proposal starts: an index into the dense cells of the route that
/// this route_seq of the gate's session named. Index 0 is the start and needs
/// neither.
struct Anchor {
  std::int64_t session = 0;
  std::int64_t route_seq = 0;
  std::int32_t index = 0;
  Cell cell;

  friend bool operator==(const Anchor&, const Anchor&) = default;
};

}  // namespace terra
