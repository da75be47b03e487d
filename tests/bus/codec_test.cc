#include "bus/codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/segment.h"
#include "tests/support/random_map.h"

namespace terra::bus {
namespace {

using ::testing::ElementsAre;

TEST(ChainTest, DirectionsGoClockwiseFromPlusXTwoToAByte) {
  const CellPath around = {{5, 5}, {6, 5}, {7, 6}, {7, 7}, {6, 8},
                           {5, 8}, {4, 7}, {4, 6}, {5, 5}};
  const Chain chain = EncodeChain(around);
  EXPECT_EQ(chain.num_steps, 8);
  EXPECT_THAT(chain.bytes, ElementsAre(0x10, 0x32, 0x54, 0x76));
}

TEST(ChainTest, GivesBackTheCellsOfRandomRoutes) {
  testing::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Route route = {{random.Int(0, 90), random.Int(0, 90)},
                         {random.Int(0, 90), random.Int(0, 90)},
                         {random.Int(0, 90), random.Int(0, 90)}};
    const CellPath cells = RasterizeRoute(route);
    const Result<CellPath> decoded =
        DecodeChain(cells.front(), EncodeChain(cells));
    ASSERT_TRUE(decoded.ok());
    EXPECT_EQ(*decoded, cells);
  }
}

TEST(ChainTest, OneCellHasNoSteps) {
  const Chain chain = EncodeChain({{3, 4}});
  EXPECT_EQ(chain.num_steps, 0);
  EXPECT_THAT(*DecodeChain({3, 4}, chain), ElementsAre(Cell{3, 4}));
}

TEST(ChainTest, RefusesWhatNoEncoderMakes) {
  EXPECT_FALSE(DecodeChain({0, 0}, Chain{-1, {}}).ok());
  EXPECT_FALSE(DecodeChain({0, 0}, Chain{3, {0x11}}).ok());
  EXPECT_FALSE(DecodeChain({0, 0}, Chain{1, {0x08}}).ok());
  EXPECT_FALSE(DecodeChain({0, 0}, Chain{1, {0x10}}).ok());
  EXPECT_FALSE(DecodeChain({2147483647, 0}, Chain{1, {0x00}}).ok());
  EXPECT_FALSE(DecodeChain({0, 0}, Chain{80'001, {}}).ok());
}

}  // namespace
}  // namespace terra::bus
