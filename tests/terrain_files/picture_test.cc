#include "terrain/files/picture.h"

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
  options.legend = false;
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
    listed |= PixelAt(image, 700 + 20, y) == kBaselineColor;
  }
  EXPECT_TRUE(listed);
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
