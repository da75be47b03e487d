// PNG maps through ReadMap: ids, legend colours, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "terrain/png/png.h"
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

Pixels Grey(int width, int height, std::uint8_t value) {
  return {width, height, PixelOrder::kGrey,
          std::vector<std::uint8_t>(static_cast<std::size_t>(width * height),
                                    value)};
}

std::string SmallPng() {
  return EncodePng(Grey(30, 20, 1).view());
}

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
  Pixels image{6, 4, PixelOrder::kRgb, std::vector<std::uint8_t>(72, 255)};
  image.bytes[3 * (2 * 6 + 5) + 1] = 2;
  image.bytes[3 * (2 * 6 + 5)] = 254;  // Nearly red.
  image.bytes[3 * (2 * 6 + 5) + 2] = 1;
  const std::string path = folder.Write("m.png", EncodePng(image.view()));
  EXPECT_THAT(ErrorMessage(ReadMap(path)),
              AllOf(HasSubstr(path), HasSubstr("pixel (5, 2)"),
                    HasSubstr("RGB 254, 2, 1"), HasSubstr("#FE0201")));
}

TEST(PngMap, AnIdWithoutLegendEntryIsNamedWithItsCell) {
  const TempFolder folder;
  Pixels image = Grey(6, 4, 1);
  image.bytes[3 * 6 + 2] = 77;
  const std::string path = folder.Write("m.png", EncodePng(image.view()));
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

TEST(PngMap, MoreThan8192CellsASideAreRefused) {
  const TempFolder folder;
  const std::string path =
      folder.Write("m.png", EncodePng(Grey(8'222, 20, 1).view()));
  EXPECT_THAT(ErrorMessage(ReadMap(path)),
              AllOf(HasSubstr("8222 x 20"), HasSubstr("1 to 8192")));
}

TEST(PngMap, AMapOf8192CellsASideIsTaken) {
  const TempFolder folder;
  const std::string path =
      folder.Write("m.png", EncodePng(Grey(8'192, 1, 1).view()));
  const auto read = ReadMap(path);
  ASSERT_TRUE(read.ok()) << ErrorMessage(read);
  EXPECT_EQ(read->map.width(), 8192);
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
