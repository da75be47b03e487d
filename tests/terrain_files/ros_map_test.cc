#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;

constexpr char kYaml[] =
    "image: m.pgm\n"
    "resolution: 0.05\n"
    "origin: [-10, 2.5, 0.1]\n"
    "negate: 0\n"
    "occupied_thresh: 0.65\n"
    "free_thresh: 0.196\n";

// A yaml and its picture of one row of grey values.
std::string WriteRosMap(const TempFolder& folder, const std::string& yaml,
                        const std::vector<int>& greys) {
  std::string pgm =
      "P5\n# made by a test\n" + std::to_string(greys.size()) + " 1\n255\n";
  for (const int grey : greys) pgm += static_cast<char>(grey);
  folder.Write("m.pgm", pgm);
  return folder.Write("m.yaml", yaml);
}

std::string Replaced(std::string text, const std::string& from,
                     const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::vector<int> IdsOf(const Result<MapFile>& file) {
  if (!file.ok()) return {};
  const ByteRaster& ids = file->map.ids();
  return {ids.data(), ids.data() + ids.size()};
}

TEST(RosMap, ThresholdsSeparateFreeUnknownAndOccupied) {
  const TempFolder folder;
  // Occupancy (255 - grey) / 255: 205 is 0.1961 (just not free), 206 is free;
  // 89 is 0.651 (occupied), 90 is 0.647 (unknown).
  const auto file =
      ReadMap(WriteRosMap(folder, kYaml, {255, 206, 205, 90, 89, 0}));
  ASSERT_TRUE(file.ok()) << ErrorMessage(file);
  EXPECT_EQ(IdsOf(file), (std::vector<int>{0, 0, 2, 2, 1, 1}));
  EXPECT_EQ(file->placement, (MapPlacement{0.05, -10, 2.5, 0.1}));
  EXPECT_FALSE(file->map.Passable({2, 0})) << "unknown ground is impassable";
}

TEST(RosMap, NegateTurnsTheGreyValuesRound) {
  const TempFolder folder;
  const auto file = ReadMap(WriteRosMap(
      folder, Replaced(kYaml, "negate: 0", "negate: 1"), {255, 128, 0}));
  EXPECT_EQ(IdsOf(file), (std::vector<int>{1, 2, 0})) << ErrorMessage(file);
}

TEST(RosMap, GradedModesNeedALegend) {
  const TempFolder folder;
  for (const char* mode : {"scale", "raw"}) {
    const std::string path = WriteRosMap(
        folder, std::string(kYaml) + "mode: " + mode + "\n", {0, 100});
    EXPECT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("--legend"));
    MapFileOptions options;
    options.legend = folder.Write(
        "l.csv", "id,name,cost,color\n0,road,1,#FFFFFF\n100,mud,5,#806040\n");
    const auto file = ReadMap(path, options);
    EXPECT_EQ(IdsOf(file), (std::vector<int>{0, 100})) << ErrorMessage(file);
  }
}

struct WrongYaml {
  const char* from;
  const char* to;
  const char* complaint;
};

class WrongRosMap : public ::testing::TestWithParam<WrongYaml> {};

TEST_P(WrongRosMap, IsRefusedWithAReason) {
  const TempFolder folder;
  const std::string path = WriteRosMap(
      folder, Replaced(kYaml, GetParam().from, GetParam().to), {255});
  EXPECT_THAT(ErrorMessage(ReadMap(path)), HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Yamls, WrongRosMap,
    ::testing::Values(
        WrongYaml{"image: m.pgm\n", "", "no 'image'"},
        WrongYaml{"image: m.pgm", "image: none.pgm", "no such file"},
        WrongYaml{"resolution: 0.05", "resolution: 0", "m.yaml:2: "},
        WrongYaml{"resolution: 0.05", "resolution: nan", "m.yaml:2: "},
        WrongYaml{"resolution: 0.05", "resolution: fine", "m.yaml:2: "},
        WrongYaml{"[-10, 2.5, 0.1]", "[-10, 2.5]", "m.yaml:3: "},
        WrongYaml{"[-10, 2.5, 0.1]", "[-10, .inf, 0]", "'origin'"},
        WrongYaml{"negate: 0", "mode: funny", "known are trinary"},
        WrongYaml{"free_thresh: 0.196", "free_thresh: 0.9", "is above"},
        WrongYaml{"free_thresh: 0.196", "free_thresh: 1.5", "m.yaml:6: "},
        WrongYaml{"image: m.pgm", "image: [m.pgm", "m.yaml:"}));

TEST(RosMap, ATruncatedPictureIsRefused) {
  const TempFolder folder;
  const std::string path = folder.Write("m.yaml", kYaml);
  folder.Write("m.pgm", "P5\n30 20\n255\nabc");
  EXPECT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("truncated"));
}

}  // namespace
}  // namespace terra
