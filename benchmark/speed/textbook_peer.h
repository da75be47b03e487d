#pragma once

#include <memory>

#include "benchmark/speed/peers.h"
#include "terrain/map.h"

namespace terra::benchmark {

/// A* as a textbook has it, on the map itself: std::priority_queue of doubles,
/// fresh vectors for every query, bounds checked at every step.
std::unique_ptr<Peer> MakeTextbookPeer(const TerrainMap& map);

}  // namespace terra::benchmark
