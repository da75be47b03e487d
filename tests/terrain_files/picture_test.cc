#include "terrain/files/picture.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/segment.h"
#include "tests/support/error_message.h"
#include "tests/support/mat_png.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

TerrainMap WhiteMap(int width, int height) {
  const Legend legend =
      Legend::Create({Terrain{0, "ground", 1, FromRgb(0xFFFFFF)}}).value();
  return TerrainMap::Create(ByteRaster::Zero(height, width), legend).value();
}

cv::Mat Drawn(const TerrainMap& map, const PictureOptions& options) {
  const TempFolder folder;
  const std::string path = folder.Path("p.png");
  const Status written = WritePicture(map, options, path);
  EXPECT_TRUE(written.ok()) << ErrorMessage(written);
  return testing::DecodeMat(testing::ReadBytes(path));
}

Color PixelAt(const cv::Mat& image, int x, int y) {
  const auto& pixel = image.at<cv::Vec3b>(y, x);
  return {pixel[2], pixel[1], pixel[0]};
}

PictureOptions Plain(int scale) {
  PictureOptions options;
  options.page = false;
  options.scale = scale;
  return options;
}

TEST(Picture, WithoutRoutesEachCellIsASquareOfItsLegendColour) {
  testing::Random random(11);
  const TerrainMap map =
      testing::RandomMap(random, 9, 7, testing::RandomMapKind::kNoise);
  const cv::Mat image = Drawn(map, Plain(3));
  ASSERT_EQ(image.cols, 27);
  ASSERT_EQ(image.rows, 21);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Terrain* terrain = map.legend().Find(map.ids()(y / 3, x / 3));
      ASSERT_EQ(PixelAt(image, x, y), terrain->color) << x << "," << y;
    }
  }
}

TEST(Picture, ARouteRunsThroughTheCentresOfItsCells) {
  PictureOptions options = Plain(9);
  options.routes = {{{{1, 1}, {8, 4}}, kCandidateColor, ""}};
  const cv::Mat image = Drawn(WhiteMap(10, 6), options);
  for (const Cell cell : RasterizeSegment({1, 1}, {8, 4})) {
    EXPECT_EQ(PixelAt(image, cell.x * 9 + 4, cell.y * 9 + 4), kCandidateColor);
  }
  EXPECT_EQ(PixelAt(image, 9 * 8 + 4, 4), FromRgb(0xFFFFFF));
}

TEST(Picture, RoutesOutsideTheMapAreLeftOutAndTakeNoTime) {
  PictureOptions options = Plain(9);
  options.routes = {{{{1, 1}, {20, 1}, {20, 4}, {1, 4}}, kBaselineColor, ""},
                    {{{0, 0}, {999'999'999, 7}}, kCandidateColor, ""}};
  const cv::Mat image = Drawn(WhiteMap(10, 6), options);
  EXPECT_EQ(PixelAt(image, 84, 13), kBaselineColor);
  EXPECT_EQ(PixelAt(image, 84, 27), FromRgb(0xFFFFFF))
      << "both parts inside must not be joined";
}

TEST(Picture, LaterRoutesLieOverEarlierOnes) {
  PictureOptions options = Plain(9);
  options.routes = {{{{1, 1}, {8, 1}}, kBaselineColor, ""},
                    {{{1, 1}, {8, 1}}, kCandidateColor, ""}};
  EXPECT_EQ(PixelAt(Drawn(WhiteMap(10, 6), options), 40, 13), kCandidateColor);
}

TEST(Picture, StartAndGoalAreMarkedAndMayLieOutside) {
  PictureOptions options = Plain(9);
  const cv::Mat without = Drawn(WhiteMap(10, 10), options);
  options.starts = {{2, 2}};
  options.goals = {{-5, 700}};
  const cv::Mat with = Drawn(WhiteMap(10, 10), options);
  EXPECT_GT(cv::norm(without, with), 0);
}

TEST(Picture, TheLegendBoxStandsRightOfTheMap) {
  PictureOptions options;
  options.routes = {{{{0, 0}, {3, 3}}, kBaselineColor, "baseline"}};
  const cv::Mat image = Drawn(WhiteMap(700, 30), options);
  EXPECT_GT(image.cols, 750);
  EXPECT_GE(image.rows, 30);
  bool listed = false;
  for (int y = 0; y < image.rows; ++y) {
    listed |= PixelAt(image, 700 + 40, y) == kBaselineColor;
  }
  EXPECT_TRUE(listed);
}

// Where the map's cell (0, 0) is on a page, in a picture of up to 700 pixels.
constexpr int kMargin = 14;

TEST(Picture, AFrameEndsWhiteGround) {
  const cv::Mat image = Drawn(WhiteMap(700, 30), {});
  const Color white = FromRgb(0xFFFFFF);
  EXPECT_EQ(PixelAt(image, kMargin, kMargin), white);
  EXPECT_EQ(PixelAt(image, kMargin + 699, kMargin + 29), white);
  for (const auto& [x, y] : {std::pair{kMargin - 1, kMargin + 15},
                             {kMargin + 700, kMargin + 15},
                             {kMargin + 300, kMargin - 1},
                             {kMargin + 300, kMargin + 30}}) {
    EXPECT_EQ(PixelAt(image, x, y), FromRgb(0x787878)) << x << "," << y;
  }
}

// Pixels of a colour on the page of a map of one pixel per cell, legend left
// out.
int PixelsOf(Color color, PictureOptions options, int side) {
  const cv::Mat image = Drawn(WhiteMap(side, side), options);
  int count = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < side + kMargin; ++x) {
      if (PixelAt(image, x, y) == color) ++count;
    }
  }
  return count;
}

int RoutePixels(int side, Route route) {
  PictureOptions options;
  options.routes = {{std::move(route), kBaselineColor, ""}};
  return PixelsOf(kBaselineColor, options, side);
}

TEST(Picture, WhatLiesOnTheBorderIsDrawnWhole) {
  const int within = RoutePixels(700, {{100, 350}, {600, 350}});
  EXPECT_GT(within, 500);
  EXPECT_EQ(RoutePixels(700, {{100, 0}, {600, 0}}), within);
  EXPECT_EQ(RoutePixels(700, {{100, 699}, {600, 699}}), within);
  PictureOptions in_the_middle;
  in_the_middle.starts = {{350, 350}};
  PictureOptions in_a_corner;
  in_a_corner.starts = {{0, 699}};
  EXPECT_EQ(PixelsOf({}, in_a_corner, 700), PixelsOf({}, in_the_middle, 700));
}

TEST(Picture, LinesAndLettersGrowWithThePicture) {
  // Four times the length, so that sixteen times the area is four times the
  // width.
  const int small = RoutePixels(700, {{100, 350}, {600, 350}});
  const int large = RoutePixels(2800, {{400, 1400}, {2400, 1400}});
  EXPECT_GT(large, 10 * small);
  const int box = Drawn(WhiteMap(700, 200), {}).cols - 700;
  EXPECT_GT(Drawn(WhiteMap(2800, 200), {}).cols - 2800, 3 * box);
}

TEST(Picture, ALongLegendBesideALowMapMakesNoHighPicture) {
  std::vector<Terrain> terrains;
  for (int id = 0; id < 200; ++id) {
    terrains.push_back({id, "t" + std::to_string(id), 1.0,
                        FromRgb(0x808000U + static_cast<std::uint32_t>(id))});
  }
  ByteRaster ids = ByteRaster::Zero(200, 2800);
  for (int id = 0; id < 200; ++id) ids(id, 0) = static_cast<std::uint8_t>(id);
  const TerrainMap map =
      TerrainMap::Create(std::move(ids), Legend::Create(terrains).value())
          .value();
  EXPECT_LT(Drawn(map, {}).rows, 5000);
}

TEST(Picture, TheCaptionStandsBelowTheMap) {
  PictureOptions options;
  const int without = Drawn(WhiteMap(700, 60), options).rows;
  options.caption = "baseline 693.3, deployed 498.1: 28.2 % less";
  const cv::Mat image = Drawn(WhiteMap(700, 60), options);
  EXPECT_GT(image.rows, without);
  int ink = 0;
  for (int y = kMargin + 60 + 4; y < image.rows; ++y) {
    for (int x = 0; x < 400; ++x) {
      if (PixelAt(image, x, y).r < 128) ++ink;
    }
  }
  EXPECT_GT(ink, 50);
}

TEST(Picture, SmallMapsAreEnlargedAndTooLargePicturesRefused) {
  PictureOptions options = Plain(0);
  EXPECT_EQ(Drawn(WhiteMap(100, 50), options).cols, 700);
  EXPECT_EQ(Drawn(WhiteMap(701, 1), options).cols, 701);
  options.scale = 200;
  EXPECT_THAT(ErrorMessage(WritePicture(WhiteMap(100, 1), options, "p.png")),
              HasSubstr("smaller scale"));
}

TEST(Picture, AnUnwritablePlaceIsNamed) {
  EXPECT_THAT(
      ErrorMessage(WritePicture(WhiteMap(2, 2), {}, "/no/such/folder/p.png")),
      HasSubstr("/no/such/folder/p.png: cannot be written"));
}

}  // namespace
}  // namespace terra
