#include "advisor/map_noise.h"

#include <gtest/gtest.h>

#include "terrain/digest.h"
#include "tests/support/random_map.h"

namespace terra::advisor {
namespace {

using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;

int Differing(const TerrainMap& a, const TerrainMap& b) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      count += a.ids()(y, x) != b.ids()(y, x);
    }
  }
  return count;
}

TEST(Noise, ChangesTheShareAskedForAwayFromTheEnds) {
  Random random(12);
  const TerrainMap map =
      RandomMap(random, 300, 300, RandomMapKind::kRectangles);
  const NoiseOptions options{10, 7, "case", {20, 20}, {280, 280}};
  const TerrainMap noisy = WithNoise(map, options);
  const int changed = Differing(map, noisy);
  EXPECT_GE(changed, 9'000);
  EXPECT_LE(changed, 9'000 + kMaxPatchSide * kMaxPatchSide);
  for (const Cell end : {options.start, options.goal}) {
    for (int dy = -kNoiseFreeCells; dy <= kNoiseFreeCells; ++dy) {
      for (int dx = -kNoiseFreeCells; dx <= kNoiseFreeCells; ++dx) {
        EXPECT_EQ(map.ids()(end.y + dy, end.x + dx),
                  noisy.ids()(end.y + dy, end.x + dx));
      }
    }
  }
  EXPECT_EQ(MapId(noisy), MapId(WithNoise(map, options)));
  NoiseOptions other = options;
  other.case_id = "other";
  EXPECT_NE(MapId(noisy), MapId(WithNoise(map, other)));
}

TEST(Noise, LessNoiseIsTheBeginningOfMore) {
  Random random(13);
  const TerrainMap map =
      RandomMap(random, 300, 300, RandomMapKind::kRectangles);
  const TerrainMap five = WithNoise(map, {5, 7, "case", {20, 20}, {280, 280}});
  const TerrainMap ten = WithNoise(map, {10, 7, "case", {20, 20}, {280, 280}});
  EXPECT_LE(Differing(five, ten),
            9'000 - 4'500 + 2 * kMaxPatchSide * kMaxPatchSide);
}

}  // namespace
}  // namespace terra::advisor
