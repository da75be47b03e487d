#include "advisor/map_noise.h"

#include <xxhash.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/split_mix.h"

namespace terra::advisor {
namespace {

constexpr int kMaxDraws = 100'000;

/// Uniform in [0, count), up to a bias that no figure can see.
int Below(SplitMix64& random, int count) {
  return static_cast<int>(random.Next() % static_cast<std::uint64_t>(count));
}

struct Patch {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  bool Near(Cell cell) const {
    return cell.x >= x - kNoiseFreeCells &&
           cell.x < x + width + kNoiseFreeCells &&
           cell.y >= y - kNoiseFreeCells &&
           cell.y < y + height + kNoiseFreeCells;
  }
};

std::vector<std::uint8_t> IdsOf(const ByteRaster& ids) {
  std::vector<bool> seen(256);
  for (Eigen::Index i = 0; i < ids.size(); ++i) seen[ids.data()[i]] = true;
  std::vector<std::uint8_t> found;
  for (std::size_t id = 0; id < seen.size(); ++id) {
    if (seen[id]) found.push_back(static_cast<std::uint8_t>(id));
  }
  return found;
}

Patch DrawPatch(SplitMix64& random, int width, int height) {
  const int side =
      kMinPatchSide + Below(random, kMaxPatchSide - kMinPatchSide + 1);
  Patch patch{0, 0, std::min(side, width), std::min(side, height)};
  patch.x = Below(random, width - patch.width + 1);
  patch.y = Below(random, height - patch.height + 1);
  return patch;
}

}  // namespace

TerrainMap WithNoise(const TerrainMap& map, const NoiseOptions& options) {
  const ByteRaster& original = map.ids();
  ByteRaster ids = original;
  const std::vector<std::uint8_t> choices = IdsOf(original);
  const auto wanted =
      options.percent / 100 * static_cast<double>(original.size());
  const std::string key =
      std::to_string(options.seed) + ":" + std::string(options.case_id);
  SplitMix64 random(XXH64(key.data(), key.size(), 0));
  std::int64_t differing = 0;
  for (int draw = 0; draw < kMaxDraws && choices.size() > 1 &&
                     static_cast<double>(differing) < wanted;
       ++draw) {
    const Patch patch = DrawPatch(random, map.width(), map.height());
    // Another id than the patch's centre has: one choice less.
    auto pick = static_cast<std::size_t>(
        Below(random, static_cast<int>(choices.size()) - 1));
    if (choices[pick] >=
        ids(patch.y + patch.height / 2, patch.x + patch.width / 2)) {
      ++pick;
    }
    if (patch.Near(options.start) || patch.Near(options.goal)) {
      continue;
    }
    auto block = ids.block(patch.y, patch.x, patch.height, patch.width);
    const auto before =
        original.block(patch.y, patch.x, patch.height, patch.width);
    differing -= (block != before).count();
    block.setConstant(choices[pick]);
    differing += (block != before).count();
  }
  return TerrainMap::Create(std::move(ids), map.legend(), map.cost_model())
      .value();
}

}  // namespace terra::advisor
