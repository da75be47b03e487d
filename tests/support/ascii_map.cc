#include "tests/support/ascii_map.h"

#include <string>
#include <utility>
#include <vector>

#include "terrain/require.h"

namespace terra::testing {

const Legend& AsciiLegend() {
  static const Legend legend = [] {
    std::vector<Terrain> terrains = {{0, "obstacle", kImpassable, {0, 0, 0}}};
    for (int cost = 1; cost <= 9; ++cost) {
      const auto shade = static_cast<std::uint8_t>(255 - 20 * cost);
      terrains.push_back({cost,
                          "cost " + std::to_string(cost),
                          static_cast<double>(cost),
                          {shade, shade, shade}});
    }
    return Legend::Create(std::move(terrains)).value();
  }();
  return legend;
}

TerrainMap MapFromAscii(std::initializer_list<std::string_view> rows,
                        CostModel model) {
  TERRA_REQUIRE(rows.size() > 0);
  const auto width = static_cast<Eigen::Index>(rows.begin()->size());
  ByteRaster ids(static_cast<Eigen::Index>(rows.size()), width);
  Eigen::Index y = 0;
  for (const std::string_view row : rows) {
    TERRA_REQUIRE(static_cast<Eigen::Index>(row.size()) == width);
    for (Eigen::Index x = 0; x < width; ++x) {
      const char c = row[static_cast<std::size_t>(x)];
      TERRA_REQUIRE(c == '#' || (c >= '1' && c <= '9'));
      ids(y, x) = static_cast<std::uint8_t>(c == '#' ? 0 : c - '0');
    }
    ++y;
  }
  return TerrainMap::Create(std::move(ids), AsciiLegend(), model).value();
}

}  // namespace terra::testing
