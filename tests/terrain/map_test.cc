#include "terrain/map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/digest.h"
#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra {
namespace {

using ::testing::HasSubstr;
using testing::MapFromAscii;
using testing::Random;

TEST(MapTest, UnknownIdIsRefusedWithItsCell) {
  ByteRaster ids = ByteRaster::Zero(3, 4);
  ids(2, 1) = 42;
  const auto map = TerrainMap::Create(ids, MultiTerraPathLegend());
  ASSERT_FALSE(map.ok());
  EXPECT_THAT(map.error().message, HasSubstr("(1, 2) has terrain id 42"));
}

TEST(MapTest, SideLimitIsNamed) {
  EXPECT_TRUE(
      TerrainMap::Create(ByteRaster::Zero(1, 8192), MultiTerraPathLegend())
          .ok());
  const auto map =
      TerrainMap::Create(ByteRaster::Zero(1, 8193), MultiTerraPathLegend());
  ASSERT_FALSE(map.ok());
  EXPECT_THAT(map.error().message, HasSubstr("8192"));
}

TEST(MapTest, ClearanceBlocksTheDiscAroundEachObstacle) {
  Random random(3);
  for (const int clearance : {0, 1, 2, 3, 7}) {
    const TerrainMap bare =
        RandomMap(random, 31, 23, testing::RandomMapKind::kRectangles);
    const TerrainMap map = TerrainMap::Create(bare.ids(), bare.legend(),
                                              {.clearance_cells = clearance})
                               .value();
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        bool near = false;
        for (int v = 0; v < map.height(); ++v) {
          for (int u = 0; u < map.width(); ++u) {
            near = near || (!bare.Passable({u, v}) &&
                            (u - x) * (u - x) + (v - y) * (v - y) <=
                                clearance * clearance);
          }
        }
        ASSERT_EQ(map.Passable({x, y}), !near) << x << "," << y;
      }
    }
  }
}

TEST(MapTest, CostsOfHalvesAreExactUnits) {
  const TerrainMap map = MapFromAscii({"19"});
  EXPECT_EQ(map.costs().scale, 1);
  const CostTable table = MakeCostTable(MultiTerraPathLegend());
  EXPECT_EQ(table.scale, 2);
  EXPECT_EQ(table.num_classes, 10);
  EXPECT_EQ(table.class_of_id[5], table.class_of_id[6]);
  EXPECT_EQ(MakeCostTable(RugdLegend()).scale, 10);
}

TEST(MapTest, IrrationalCostsHaveNoExactUnits) {
  const Legend legend =
      Legend::Create({{0, "a", 1.0, {}}, {1, "b", 3.14159265, {1, 2, 3}}})
          .value();
  EXPECT_EQ(MakeCostTable(legend).scale, 0);
}

TEST(DigestTest, MapIdDependsOnCellsCostsAndModelOnly) {
  ByteRaster ids = ByteRaster::Zero(200, 300);
  const auto id_of = [&ids](CostModel model) {
    return MapId(
        TerrainMap::Create(ids, MultiTerraPathLegend(), model).value());
  };
  const std::int64_t plain = id_of({});
  EXPECT_EQ(id_of({}), plain);
  EXPECT_NE(id_of({.corner_cutting = false}), plain);
  EXPECT_NE(id_of({.clearance_cells = 2}), plain);
  ids(199, 299) = 1;
  EXPECT_NE(id_of({}), plain);
}

TEST(TilesTest, TilesPutTogetherGiveTheMap) {
  Random random(5);
  const TerrainMap map =
      RandomMap(random, 300, 130, testing::RandomMapKind::kNoise);
  const TileGrid grid{300, 130, 128};
  ASSERT_EQ(grid.count(), 6);
  ByteRaster copy = ByteRaster::Constant(130, 300, 99);
  for (int i = 0; i < grid.count(); ++i) {
    InsertTile(copy, grid, i, ExtractTile(map.ids(), grid, i));
  }
  EXPECT_TRUE((copy == map.ids()).all());
}

}  // namespace
}  // namespace terra
