#pragma once

#include "tests/support/ascii_map.h"
#include "tests/verifier/gate_harness.h"

namespace terra::verifier {

// A field that is dear in the middle, for a request from (0, 1) to (5, 1). The
// straight baseline costs 37, the detour along the top or the bottom
// 3 + 2 sqrt 2, the one over the corners 7.
inline TerrainMap Field() {
  return testing::MapFromAscii({"111111", "199991", "111111"});
}
inline const Route kStraight = {{0, 1}, {5, 1}};
inline const Route kTop = {{0, 1}, {1, 0}, {4, 0}, {5, 1}};
inline const Route kBottom = {{0, 1}, {1, 2}, {4, 2}, {5, 1}};
inline const Route kCorners = {{0, 1}, {0, 0}, {5, 0}, {5, 1}};

// A gate that has deployed the straight baseline of request 1.
inline GateHarness Ready() {
  GateHarness h;
  h.Map(Field());
  h.Request(1);
  h.Baseline(kStraight);
  return h;
}

}  // namespace terra::verifier
