// PNG maps through ReadMap: ids, legend colours, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "terrain/builtin_legends.h"
#include "terrain/files/image.h"
#include "terrain/files/map_file.h"
#include "tests/support/error_message.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using ::testing::AllOf;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;
using testing::TempFolder;

std::string PngBytes(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  return {bytes.begin(), bytes.end()};
}

std::string SmallPng() {
  return PngBytes(cv::Mat(20, 30, CV_8UC1, 1.0));
}

// Positions in a PNG: the header chunk's fields.
constexpr std::size_t kWidthAt = 16;
constexpr std::size_t kColorTypeAt = 25;

TEST(PngMap, IdsSurviveWritingAndReading) {
  const TempFolder folder;
  Random random(3);
  const TerrainMap map = RandomMap(random, 41, 27, RandomMapKind::kNoise);
  const std::string path = folder.Path("m.png");
  ASSERT_TRUE(WriteIdPng(map, path).ok());
  const auto read = ReadMap(path);
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_TRUE((read->map.ids() == map.ids()).all());
  EXPECT_EQ(read->map.legend(), MultiTerraPathLegend());
}

TEST(PngMap, ColoursMeanTheSameIds) {
  const TempFolder folder;
  Random random(4);
  const TerrainMap map = RandomMap(random, 41, 27, RandomMapKind::kNoise);
  const std::string path = folder.Path("m.png");
  ASSERT_TRUE(WriteColorPng(map, path).ok());
  const auto read = ReadMap(path);
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_TRUE((read->map.ids() == map.ids()).all());
}

TEST(PngMap, AnUnknownColourIsNamedWithItsPixelAndNeverRounded) {
  const TempFolder folder;
  cv::Mat image(4, 6, CV_8UC3, cv::Scalar(255, 255, 255));
  image.at<cv::Vec3b>(2, 5) = cv::Vec3b(1, 2, 254);  // nearly red, as BGR
  const std::string path = folder.Write("m.png", PngBytes(image));
  EXPECT_THAT(ErrorMessage(ReadMap(path)),
              AllOf(HasSubstr(path), HasSubstr("pixel (5, 2)"),
                    HasSubstr("RGB 254, 2, 1"), HasSubstr("#FE0201")));
}

TEST(PngMap, AnIdWithoutLegendEntryIsNamedWithItsCell) {
  const TempFolder folder;
  cv::Mat image(4, 6, CV_8UC1, 1.0);
  image.at<unsigned char>(3, 2) = 77;
  const std::string path = folder.Write("m.png", PngBytes(image));
  EXPECT_THAT(ErrorMessage(ReadMap(path)),
              AllOf(HasSubstr(path), HasSubstr("77"), HasSubstr("(2, 3)")));
}

TEST(PngMap, ATruncatedFileIsRefusedAtEveryLength) {
  const TempFolder folder;
  const std::string whole = SmallPng();
  for (std::size_t length = 8; length < whole.size(); ++length) {
    const std::string path =
        folder.Write("m.png", std::string_view(whole).substr(0, length));
    ASSERT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("truncated"))
        << length << " bytes";
  }
}

// The decoder's own complaints go to stderr; ours must not depend on them.
TEST(PngMap, ADamagedByteNeverGivesAnotherMap) {
  const TempFolder folder;
  Random random(5);
  const TerrainMap map = RandomMap(random, 16, 16, RandomMapKind::kNoise);
  const std::string path = folder.Path("m.png");
  ASSERT_TRUE(WriteIdPng(map, path).ok());
  const std::string whole = testing::ReadBytes(path);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    folder.Write("m.png", damaged);
    const auto read = ReadMap(path);
    if (!read.ok()) continue;
    ASSERT_TRUE(read->map.ids().rows() == map.ids().rows() &&
                (read->map.ids() == map.ids()).all())
        << "byte " << at;
  }
}

TEST(PngMap, MoreThan8192CellsASideAreRefusedBeforeDecoding) {
  const TempFolder folder;
  std::string bytes = SmallPng();
  bytes[kWidthAt + 2] = 0x20;  // 8192 + 30
  const std::string path = folder.Write("m.png", bytes);
  EXPECT_THAT(ErrorMessage(ReadMap(path)),
              AllOf(HasSubstr("8222 x 20"), HasSubstr("1 to 8192")));
}

TEST(PngMap, AMapOf8192CellsASideIsTaken) {
  const TempFolder folder;
  const std::string path =
      folder.Write("m.png", PngBytes(cv::Mat(1, 8192, CV_8UC1, 1.0)));
  const auto read = ReadMap(path);
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_EQ(read->map.width(), 8192);
}

TEST(PngMap, PicturesThatWouldBeConvertedSilentlyAreRefused) {
  const TempFolder folder;
  const auto message = [&](const std::string& bytes) {
    return ErrorMessage(ReadMap(folder.Write("m.png", bytes)));
  };
  EXPECT_THAT(message(PngBytes(cv::Mat(2, 2, CV_16UC1, 1.0))),
              HasSubstr("16 bits per channel"));
  EXPECT_THAT(message(PngBytes(cv::Mat(2, 2, CV_8UC4, 1.0))),
              HasSubstr("an alpha channel"));
  std::string palette = SmallPng();
  palette[kColorTypeAt] = 3;
  EXPECT_THAT(message(palette), HasSubstr("a palette"));
}

TEST(MapFile, AnUnknownKindOfFileListsTheKnownOnes) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(ReadMap(folder.Write("m.jpg", "\xFF\xD8\xFF"))),
              HasSubstr("Known are 8-bit PNG"));
  EXPECT_THAT(ErrorMessage(ReadMap(folder.Write("m.png", ""))),
              HasSubstr("not a map"));
}

TEST(MapFile, AMissingFileAndAFolderAreToldApart) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(ReadMap(folder.Path("none.png"))),
              HasSubstr("no such file"));
  EXPECT_THAT(ErrorMessage(ReadMap(folder.Path(""))),
              HasSubstr("not a regular file"));
}

}  // namespace
}  // namespace terra
