#include "tests/support/random_map.h"

#include <algorithm>
#include <utility>

#include "terrain/builtin_legends.h"

namespace terra::testing {
namespace {

constexpr std::uint8_t kObstacleId = 11;

std::uint8_t RandomId(Random& random) {
  return static_cast<std::uint8_t>(random.Int(0, 11));
}

void FillRectangles(Random& random, ByteRaster& ids) {
  ids.setZero();
  const int width = static_cast<int>(ids.cols());
  const int height = static_cast<int>(ids.rows());
  const int count = random.Int(1, 12);
  for (int i = 0; i < count; ++i) {
    const int x = random.Int(0, width - 1);
    const int y = random.Int(0, height - 1);
    const int w = std::min(random.Int(1, width / 2 + 1), width - x);
    const int h = std::min(random.Int(1, height / 2 + 1), height - y);
    ids.block(y, x, h, w).setConstant(RandomId(random));
  }
}

}  // namespace

TerrainMap RandomMap(Random& random, int width, int height, RandomMapKind kind,
                     CostModel model) {
  ByteRaster ids(height, width);
  if (kind == RandomMapKind::kRectangles) {
    FillRectangles(random, ids);
  } else {
    for (Eigen::Index i = 0; i < ids.size(); ++i) {
      ids.data()[i] = kind == RandomMapKind::kNoise ? RandomId(random)
                      : random.Int(1, 10) <= 3      ? kObstacleId
                                                    : std::uint8_t{0};
    }
  }
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend(), model)
      .value();
}

Cell RandomPassableCell(Random& random, const TerrainMap& map) {
  for (;;) {
    const Cell cell{random.Int(0, map.width() - 1),
                    random.Int(0, map.height() - 1)};
    if (map.Passable(cell)) {
      return cell;
    }
  }
}

}  // namespace terra::testing
