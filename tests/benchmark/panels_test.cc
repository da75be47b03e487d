#include "benchmark/panels.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "benchmark/rugd.h"
#include "benchmark/run.h"
#include "terrain/files/image.h"
#include "tests/support/error_message.h"
#include "tests/support/mat_png.h"
#include "tests/support/temp_folder.h"

namespace terra::benchmark {
namespace {

namespace fs = std::filesystem;
using terra::testing::ErrorMessage;
using terra::testing::TempFolder;
using ::testing::HasSubstr;

const cv::Scalar kSky(255, 0, 0);  // RUGD's colours, in BGR.
const cv::Scalar kGrass(0, 102, 0);
const cv::Scalar kFrame(10, 20, 30);

// One RUGD frame, converted, and a run of the native optimum over it.
class PanelsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    cv::Mat mask(240, 400, CV_8UC3, kSky);
    mask.rowRange(100, 240).setTo(kGrass);
    Write("masks/creek_00001.png", mask);
    RugdOptions options;
    options.annotations = folder_.Path("masks");
    options.out = folder_.Path("data");
    options.frames = folder_.Path("frames");
    ASSERT_TRUE(ConvertRugd(options).ok());
    const Status ran = RunMethods(
        *ReadDataset(folder_.Path("data")), {},
        {{FindDeterministicMethod("advisor", "search", false).value(),
          folder_.Path("run"), "{}"}},
        {});
    ASSERT_TRUE(ran.ok()) << ErrorMessage(ran);
  }

  void Write(const std::string& name, const cv::Mat& image) {
    fs::create_directories(fs::path(folder_.Path(name)).parent_path());
    ASSERT_TRUE(
        WritePng(terra::testing::ViewOf(image), folder_.Path(name)).ok());
  }

  Result<std::vector<Panel>> Make(const std::string& frames) {
    return MakePanels(folder_.Path("run"), *ReadDataset(folder_.Path("data")),
                      3, frames);
  }

  TempFolder folder_;
};

TEST_F(PanelsTest, AFrameStandsAboveItsMask) {
  Write("frames/creek/creek_00001.png", cv::Mat(240, 400, CV_8UC3, kFrame));
  const Dataset dataset = ReadDataset(folder_.Path("data")).value();
  const auto panels = Make(RugdFramesOf(dataset));
  ASSERT_TRUE(panels.ok()) << ErrorMessage(panels);
  ASSERT_EQ(panels->size(), 1U);
  EXPECT_THAT(panels->at(0).caption, HasSubstr("creek_00001: baseline "));
  const cv::Mat image = terra::testing::DecodeMat(panels->at(0).png);
  ASSERT_EQ(image.size(), cv::Size(400, 480));
  EXPECT_EQ(image.at<cv::Vec3b>(1, 1), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(image.at<cv::Vec3b>(240 + 1, 1), cv::Vec3b(255, 0, 0));
  // The routes lie on the frame as well as on the mask.
  cv::Mat touched;
  cv::inRange(image.rowRange(0, 240), kFrame, kFrame, touched);
  EXPECT_GT(240 * 400 - cv::countNonZero(touched), 400);
}

TEST_F(PanelsTest, WithoutFramesTheMaskStandsAlone) {
  const auto panels = Make("");
  ASSERT_TRUE(panels.ok()) << ErrorMessage(panels);
  EXPECT_EQ(terra::testing::DecodeMat(panels->at(0).png).size(),
            cv::Size(400, 240));
}

TEST_F(PanelsTest, AFrameOfAnotherSizeIsRefused) {
  Write("frames/creek_00001.png", cv::Mat(120, 200, CV_8UC3, kFrame));
  EXPECT_THAT(ErrorMessage(Make(folder_.Path("frames"))),
              HasSubstr("creek_00001.png: a frame must be"));
}

TEST_F(PanelsTest, AFolderWithoutFramesIsAnError) {
  EXPECT_THAT(ErrorMessage(Make(folder_.Path("run"))), HasSubstr("no RUGD"));
}

}  // namespace
}  // namespace terra::benchmark
