#include "benchmark/rugd.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "planner/coarse_lattice.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/dataset.h"
#include "terrain/files/image.h"
#include "terrain/files/map_file.h"
#include "terrain/files/whole_file.h"
#include "tests/support/error_message.h"
#include "tests/support/mat_png.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;

// A mask of 300 x 200: sky above row 100, grass below; `wall` splits the grass
// into two components.
cv::Mat Mask(bool wall) {
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(255, 0, 0));  // Sky, in BGR.
  image.rowRange(100, 200).setTo(cv::Scalar(0, 102, 0));    // Grass.
  if (wall) image.colRange(140, 160).setTo(cv::Scalar(0, 0, 255));  // Building.
  return image;
}

class RugdTest : public ::testing::Test {
 protected:
  void Write(const std::string& name, const cv::Mat& image) {
    const std::string path = folder_.Path("masks/" + name);
    fs::create_directories(fs::path(path).parent_path());
    ASSERT_TRUE(WritePng(terra::testing::ViewOf(image), path).ok());
  }
  RugdOptions Options() {
    RugdOptions options;
    options.annotations = folder_.Path("masks");
    options.out = folder_.Path("out");
    return options;
  }
  TempFolder folder_;
};

TEST_F(RugdTest, NamesGiveGroupAndSequenceInBothLayouts) {
  Write("trail-10/trail-10_00001.png", Mask(false));
  Write("creek_00006.png", Mask(false));
  folder_.Write("masks/colormap.txt", "");
  const auto frames = FindRugdFrames(folder_.Path("masks"));
  ASSERT_TRUE(frames.ok()) << ErrorMessage(frames);
  const std::vector<RugdFrame>& found = frames->frames;
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].group, "creek");
  EXPECT_EQ(found[0].sequence, "creek");
  EXPECT_EQ(found[1].name, "trail-10_00001");
  EXPECT_EQ(found[1].group, "trail");
  EXPECT_EQ(found[1].sequence, "trail-10");
}

TEST_F(RugdTest, WhatIsNoFrameIsListedAndAllElseConverted) {
  Write("creek/creek_00001.png", Mask(false));
  Write("creek/creek_00011.PNG", Mask(false));
  Write("copy/creek_00001.png", Mask(false));
  Write(".Trash-1000/creek_00021.png", Mask(false));
  folder_.Write("masks/creek/._creek_00001.png", "Mac OS X        \2\0\0");
  folder_.Write("masks/.DS_Store", "Bud1");
  folder_.Write("masks/creek/Thumbs.db", "x");
  folder_.Write("masks/creek/creek_00031.png", "");
  folder_.Write("masks/creek/contact_sheet.png", "no mask");
  fs::create_directories(folder_.Path("masks/creek_00041.png"));
  cv::Mat foreign = Mask(false);
  foreign.at<cv::Vec3b>(7, 3) = {1, 2, 3};
  Write("creek/creek_00051.png", foreign);
  const auto counts = ConvertRugd(Options());
  ASSERT_TRUE(counts.ok()) << ErrorMessage(counts);
  ASSERT_EQ(counts->size(), 1U);
  EXPECT_EQ(counts->front().used, 2);
  EXPECT_EQ(counts->front().frames, 4);
  const std::string skipped =
      ReadWholeFile(folder_.Path("out/skipped.csv"), 10'000).value();
  for (const char* name :
       {"\n.Trash-1000,hidden", "\ncreek/._creek_00001.png,hidden",
        "\n.DS_Store,hidden", "\ncreek/Thumbs.db,not called",
        "\ncreek/contact_sheet.png,not called", "\ncreek_00031,",
        "\ncreek/creek_00001.png,the same as ", "\ncreek_00051,", "(3, 7)"}) {
    EXPECT_THAT(skipped, HasSubstr(name));
  }
  EXPECT_EQ(ReadDataset(Options().out).value().cases.size(), 2U);
}

TEST_F(RugdTest, TwoDifferentMasksOfOneNameAreRefused) {
  Write("a/creek_00001.png", Mask(false));
  Write("b/creek_00001.png", Mask(true));
  EXPECT_THAT(ErrorMessage(ConvertRugd(Options())),
              HasSubstr("stands there twice, and not the same"));
}

TEST_F(RugdTest, EndsLieInOneComponentFarEnoughApartAndAreJoined) {
  Write("park-1_00001.png", Mask(true));
  Write("village_00003.png", Mask(false));
  const auto counts = ConvertRugd(Options());
  ASSERT_TRUE(counts.ok()) << ErrorMessage(counts);
  const Dataset dataset = ReadDataset(Options().out).value();
  ASSERT_EQ(dataset.cases.size(), 2U);
  for (const DatasetCase& c : dataset.cases) {
    const TerrainMap map = ReadCaseMap(dataset, c).value();
    EXPECT_TRUE(map.Passable(c.start) && map.Passable(c.goal));
    const double dx = c.start.x - c.goal.x;
    const double dy = c.start.y - c.goal.y;
    EXPECT_GE(dx * dx + dy * dy, 100 * 100);
    EXPECT_TRUE(planner::PlanOnLattice(map, c.start, c.goal).found());
  }
  const DatasetCase& split = dataset.cases[0];
  EXPECT_EQ(split.start.x < 140, split.goal.x < 140);
  EXPECT_EQ(split.extra.at("sequence"), "park-1");
}

TEST_F(RugdTest, PairsDependOnSeedAndNameAlone) {
  Write("village_00003.png", Mask(false));
  const TerrainMap map =
      ReadMap(folder_.Path("masks/village_00003.png"), {"rugd", {}, {}})
          .value()
          .map;
  const RugdDraw a = DrawRugdEnds(map, 5, "village_00003");
  const RugdDraw b = DrawRugdEnds(map, 5, "village_00003");
  const RugdDraw other = DrawRugdEnds(map, 6, "village_00003");
  ASSERT_TRUE(a.ends && b.ends && other.ends);
  EXPECT_EQ(a.ends->start, b.ends->start);
  EXPECT_EQ(a.ends->goal, b.ends->goal);
  EXPECT_NE(a.ends->start, other.ends->start);
}

TEST_F(RugdTest, SkippedFramesAreListedWithTheReason) {
  cv::Mat sky(200, 300, CV_8UC3, cv::Scalar(255, 0, 0));
  Write("creek_00001.png", sky);
  cv::Mat strip = sky.clone();
  strip(cv::Rect(0, 150, 60, 20)).setTo(cv::Scalar(0, 102, 0));
  Write("creek_00006.png", strip);
  const auto counts = ConvertRugd(Options());
  ASSERT_TRUE(counts.ok()) << ErrorMessage(counts);
  EXPECT_EQ(counts->at(0).frames, 2);
  EXPECT_EQ(counts->at(0).used, 0);
  const std::string skipped =
      ReadWholeFile(folder_.Path("out/skipped.csv"), 10'000).value();
  EXPECT_THAT(skipped, HasSubstr("creek_00001,no passable cell"));
  EXPECT_THAT(skipped, HasSubstr("200 too close"));
}

TEST_F(RugdTest, AColourThatRugdDoesNotHaveIsNamedWithItsPixel) {
  cv::Mat mask = Mask(false);
  mask.at<cv::Vec3b>(7, 3) = {1, 2, 3};
  Write("creek_00001.png", mask);
  EXPECT_THAT(ErrorMessage(ConvertRugd(Options())), HasSubstr("(3, 7)"));
}

TEST_F(RugdTest, TheSampleMasksOfTheArchiveAreAllUsed) {
  RugdOptions options = Options();
  options.annotations = TERRA_SHARED_DATA "/rugd";
  if (!fs::exists(options.annotations)) {
    GTEST_SKIP() << "needs the RUGD sample masks in " << options.annotations;
  }
  const auto counts = ConvertRugd(options);
  ASSERT_TRUE(counts.ok()) << ErrorMessage(counts);
  ASSERT_EQ(counts->size(), 4U);
  for (const RugdCount& count : *counts) EXPECT_EQ(count.used, count.frames);
}

}  // namespace
}  // namespace terra::benchmark
