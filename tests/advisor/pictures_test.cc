// The pictures that a model is shown, pixel by pixel.
#include "advisor/pictures.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "tests/support/random_map.h"

namespace terra::advisor {
namespace {

using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;

TEST(Pictures, ShowEachCellInItsTerrainsColour) {
  Random random(3);
  const TerrainMap map = RandomMap(random, 60, 50, RandomMapKind::kNoise);
  const Picture picture =
      DrawMap(map, ChooseFrame(60, 50, false), {0, 0}, {59, 49});
  for (int y = 15; y < 35; ++y) {  // Away from the markers.
    for (int x = 0; x < 60; ++x) {
      const std::uint8_t* rgb =
          &picture.rgb[static_cast<std::size_t>(3 * (y * 60 + x))];
      const Terrain* terrain = map.legend().Find(map.ids()(y, x));
      ASSERT_NE(terrain, nullptr);
      EXPECT_EQ((Color{rgb[0], rgb[1], rgb[2]}), terrain->color);
    }
  }
}

TEST(Pictures, SurviveTheirEncoding) {
  Random random(5);
  const TerrainMap map = RandomMap(random, 70, 40, RandomMapKind::kRectangles);
  const Route route = {{2, 2}, {60, 30}};
  const Picture picture = DrawMap(map, ChooseFrame(70, 40, true), route.front(),
                                  route.back(), &route);
  const EncodedPicture encoded = EncodePicture(picture);
  EXPECT_EQ(DecodePicture(encoded.png).value(), picture);
  EXPECT_EQ(encoded.pixel_hash, PixelHash(picture));
  EXPECT_FALSE(DecodePicture("no picture"));
  EXPECT_FALSE(DecodePicture(encoded.png.substr(0, 40)));
}

TEST(Pictures, AReducedMapShowsTheDearestOfEachBlock) {
  ByteRaster ids = ByteRaster::Zero(1'600, 1'600);
  ids(801, 801) = 11;  // One obstacle in a block of four.
  const TerrainMap map =
      TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
  const Picture picture =
      DrawMap(map, ChooseFrame(1'600, 1'600, false), {0, 0}, {1, 1});
  ASSERT_EQ(picture.width, 800);
  const std::uint8_t* rgb =
      &picture.rgb[static_cast<std::size_t>(3 * (400 * 800 + 400))];
  EXPECT_EQ((Color{rgb[0], rgb[1], rgb[2]}), map.legend().Find(11)->color);
}

// A map of a few cells is enlarged until numbers, markers and route leave its
// terrain to be seen.
TEST(Pictures, WithAxesATinyMapIsLargeEnoughToBeRead) {
  Random random(7);
  const TerrainMap map = RandomMap(random, 20, 12, RandomMapKind::kNoise);
  const PictureFrame frame = ChooseFrame(20, 12, true);
  EXPECT_EQ(frame.pixels_per_cell, 20);
  EXPECT_EQ(frame.grid_cells, 2);
  const Route route = {{2, 2}, {10, 10}, {17, 10}};
  const Picture picture =
      DrawMap(map, frame, route.front(), route.back(), &route);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 20; ++x) {
      const auto far = [x, y](Cell end) {
        return std::max(std::abs(x - end.x), std::abs(y - end.y)) > 2;
      };
      if (!far(route.front()) || !far(route.back())) continue;
      const Color color = map.legend().Find(map.ids()(y, x))->color;
      int seen = 0;
      for (int v = 0; v < 20; ++v) {
        for (int u = 0; u < 20; ++u) {
          const int px = frame.left_px + 20 * x + u;
          const int py = frame.top_px + 20 * y + v;
          const std::uint8_t* rgb = &picture.rgb[static_cast<std::size_t>(
              3 * (py * picture.width + px))];
          seen += Color{rgb[0], rgb[1], rgb[2]} == color;
        }
      }
      EXPECT_GT(seen, 150) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace terra::advisor
