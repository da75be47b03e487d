#pragma once

#include <cstdint>
#include <vector>

#include "terrain/map.h"

namespace terra::benchmark {

/// The least a search by relaxation could do: clears a map's keys and relaxes
/// each cell once from the row above. Finds no route; a floor to compare with.
class RelaxOnce {
 public:
  explicit RelaxOnce(const TerrainMap& map);
  void Run();
  std::uint32_t last_key() const { return keys_.back(); }

 private:
  int stride_;
  int rows_;
  std::vector<std::uint32_t> weights_;
  std::vector<std::uint32_t> keys_;
};

}  // namespace terra::benchmark
