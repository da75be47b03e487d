#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "tests/support/error_message.h"
#include "tests/support/hand_made_png.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using testing::Chunk;
using testing::ErrorMessage;
using testing::HandMade;
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

struct Negate {
  const char* text;
  bool turns;
};

class NegateOfRosMap : public ::testing::TestWithParam<Negate> {};

TEST_P(NegateOfRosMap, IsReadAsNav2DoesIt) {
  const TempFolder folder;
  const auto file = ReadMap(WriteRosMap(
      folder,
      Replaced(kYaml, "negate: 0", std::string("negate: ") + GetParam().text),
      {255, 0}));
  EXPECT_EQ(IdsOf(file), GetParam().turns ? (std::vector<int>{1, 0})
                                          : (std::vector<int>{0, 1}))
      << ErrorMessage(file);
}

INSTANTIATE_TEST_SUITE_P(
    Spellings, NegateOfRosMap,
    ::testing::Values(Negate{"0", false}, Negate{"1", true}, Negate{"2", true},
                      Negate{"yes", true}, Negate{"Yes", true},
                      Negate{"TRUE", true}, Negate{"on", true},
                      Negate{"y", true}, Negate{"no", false},
                      Negate{"False", false}, Negate{"OFF", false},
                      Negate{"n  # not turned", false}));

TEST(RosMap, NonsenseForNegateIsRefused) {
  const TempFolder folder;
  for (const char* text : {"maybe", "0.5", "1,0", "[1]", "''", "1 0"}) {
    const auto file = ReadMap(WriteRosMap(
        folder, Replaced(kYaml, "negate: 0", std::string("negate: ") + text),
        {255}));
    EXPECT_THAT(ErrorMessage(file), HasSubstr("m.yaml:4: 'negate' takes"))
        << text;
  }
}

// What map savers write: 254 free, 205 unknown, 0 occupied.
constexpr char kSavedYaml[] =
    "image: m.pgm\nmode: Trinary\nresolution: 0.05\norigin: [0, 0, 0]\n"
    "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n";

TEST(RosMap, UnknownGroundThatBecomesFreeIsSaidOnce) {
  const TempFolder folder;
  const auto file =
      ReadMap(WriteRosMap(folder, kSavedYaml, {254, 205, 205, 0}));
  EXPECT_EQ(IdsOf(file), (std::vector<int>{0, 0, 0, 1})) << ErrorMessage(file);
  ASSERT_EQ(file->notices.size(), 1U);
  EXPECT_THAT(file->notices[0],
              ::testing::AllOf(HasSubstr("m.yaml: 2 cells (50 %)"),
                               HasSubstr("free_thresh of 0.25"),
                               HasSubstr("--unknown impassable")));
}

TEST(RosMap, WhatIsNotDoubtfulIsNotSpokenOf) {
  const TempFolder folder;
  const auto none = ReadMap(WriteRosMap(folder, kSavedYaml, {254, 0, 206}));
  ASSERT_TRUE(none.ok()) << ErrorMessage(none);
  EXPECT_TRUE(none->notices.empty());
  const auto unknown = ReadMap(WriteRosMap(folder, kYaml, {254, 0, 205}));
  ASSERT_TRUE(unknown.ok()) << ErrorMessage(unknown);
  EXPECT_TRUE(unknown->notices.empty());
}

struct Unknown {
  const char* rule;
  double cost;
};

class UnknownOfRosMap : public ::testing::TestWithParam<Unknown> {};

TEST_P(UnknownOfRosMap, CostsWhatTheUserSays) {
  const TempFolder folder;
  MapFileOptions options;
  options.unknown = ParseUnknownGround(GetParam().rule).value();
  // 150 is unknown by the thresholds, 205 by what savers mean.
  const auto file =
      ReadMap(WriteRosMap(folder, kSavedYaml, {254, 205, 150, 0}), options);
  ASSERT_EQ(IdsOf(file), (std::vector<int>{0, 2, 2, 1})) << ErrorMessage(file);
  EXPECT_TRUE(file->notices.empty());
  EXPECT_EQ(file->map.legend().Find(2)->cost, GetParam().cost);
  EXPECT_EQ(file->map.legend().Find(1)->cost, kImpassable);
}

INSTANTIATE_TEST_SUITE_P(Rules, UnknownOfRosMap,
                         ::testing::Values(Unknown{"impassable", kImpassable},
                                           Unknown{"inf", kImpassable},
                                           Unknown{"free", 1},
                                           Unknown{"2.5", 2.5}));

TEST(RosMap, ARuleForUnknownGroundIsRefusedWhereThereIsNone) {
  const TempFolder folder;
  MapFileOptions options;
  options.unknown = ParseUnknownGround("free").value();
  EXPECT_THAT(
      ErrorMessage(ReadMap(
          folder.Write("m.map", "type octile\nheight 1\nwidth 1\nmap\n.\n"),
          options)),
      HasSubstr("there is no unknown ground for --unknown"));
  options.legend =
      folder.Write("l.csv", "id,name,cost,color\n0,road,1,#FFFFFF\n");
  EXPECT_THAT(ErrorMessage(ReadMap(
                  WriteRosMap(folder, std::string(kYaml) + "mode: raw\n", {0}),
                  options)),
              HasSubstr("in mode scale and raw there is no unknown ground"));
  for (const char* text : {"", "Free", "0", "-1", "nan", "2,5", "blocked"}) {
    EXPECT_THAT(ErrorMessage(ParseUnknownGround(text)),
                HasSubstr("neither impassable nor free nor a cost"))
        << text;
  }
}

// A PNG of one row, as its format's text says, and the ids that map_server and
// Nav2 make of it under kYaml: free above a mean of 205.02, occupied below
// 89.25.
struct PictureForm {
  std::string name;
  HandMade png;
  std::vector<int> ids;
};

std::string Row(std::initializer_list<int> bytes) {
  std::string row(1, '\0');  // The filter.
  for (const int byte : bytes) row += static_cast<char>(byte);
  return row;
}

std::string Row16(std::initializer_list<int> samples) {
  std::string row(1, '\0');
  for (const int sample : samples) {
    row += static_cast<char>(sample >> 8);
    row += static_cast<char>(sample & 0xFF);
  }
  return row;
}

std::string Bytes(std::initializer_list<int> bytes) {
  return Row(bytes).substr(1);
}

class PngOfRosMap : public ::testing::TestWithParam<PictureForm> {};

TEST_P(PngOfRosMap, GivesTheCellsOfMapServer) {
  const TempFolder folder;
  HandMade png = GetParam().png;
  png.width = static_cast<std::uint32_t>(GetParam().ids.size());
  folder.Write("m.PNG", png.Bytes());
  const auto file =
      ReadMap(folder.Write("M.YAML", Replaced(kYaml, "m.pgm", "m.PNG")));
  EXPECT_EQ(IdsOf(file), GetParam().ids) << ErrorMessage(file);
}

const std::string kPalette =
    Chunk("PLTE", Bytes({255, 255, 255, 0, 0, 0, 205, 205, 205, 255, 0, 0}));

INSTANTIATE_TEST_SUITE_P(
    Forms, PngOfRosMap,
    ::testing::Values(
        PictureForm{"Grey",
                    {.color_type = 0, .rows = Row({255, 206, 205, 90, 89, 0})},
                    {0, 0, 2, 2, 1, 1}},
        PictureForm{"GreyOfOneBit",
                    {.depth = 1, .color_type = 0, .rows = Row({0xA0})},
                    {0, 1, 0}},
        PictureForm{"GreyOfFourBits",  // 221, 204, 0, 255
                    {.depth = 4, .color_type = 0, .rows = Row({0xDC, 0x0F})},
                    {0, 2, 1, 0}},
        PictureForm{"GreyOfSixteenBits",
                    {.depth = 16,
                     .color_type = 0,
                     .rows = Row16({65535, 205 * 257, 205 * 257 + 30, 0})},
                    {0, 2, 0, 1}},
        PictureForm{"Rgb",
                    {.color_type = 2,
                     .rows = Row({255, 255, 255, 205, 205, 205, 206, 205, 205,
                                  90, 89, 89, 90, 89, 88, 255, 0, 0})},
                    {0, 2, 0, 2, 1, 1}},
        PictureForm{"RgbOfSixteenBits",
                    {.depth = 16,
                     .color_type = 2,
                     .rows = Row16({65535, 65535, 65535, 0, 65535, 0, 205 * 257,
                                    205 * 257, 205 * 257})},
                    {0, 1, 2}},
        PictureForm{"RgbInterlaced",
                    {.color_type = 2,
                     .interlace = 1,
                     .rows = Row({255, 255, 255}) + Row({0, 0, 0})},
                    {0, 1}},
        PictureForm{"RgbWithATransparentColour",
                    {.color_type = 2,
                     .chunks = Chunk("tRNS", Bytes({0, 255, 0, 255, 0, 255})),
                     .rows = Row({255, 255, 255, 254, 254, 254, 0, 0, 0})},
                    {2, 0, 1}},
        // Alpha is a fourth channel; grey with alpha counts three times.
        PictureForm{
            "Rgba",
            {.color_type = 6,
             .rows = Row({255, 255, 255, 255, 255, 255, 255, 0,  0,  0,
                          0,   255, 0,   0,   0,   0,   33,  33, 33, 255,
                          100, 100, 100, 255, 205, 205, 205, 255})},
            {0, 2, 1, 1, 1, 2, 0}},
        PictureForm{"RgbaOfSixteenBits",
                    {.depth = 16,
                     .color_type = 6,
                     .rows = Row16({65535, 65535, 65535, 65535, 65535, 65535,
                                    65535, 0, 0, 0, 0, 65535})},
                    {0, 2, 1}},
        PictureForm{
            "GreyAndAlpha",
            {.color_type = 4,
             .rows = Row({255, 255, 255, 0, 0, 255, 0, 0, 33, 255, 100, 255})},
            {0, 2, 1, 1, 1, 2}},
        PictureForm{"GreyWithATransparentGrey",
                    {.color_type = 0,
                     .chunks = Chunk("tRNS", Bytes({0, 255})),
                     .rows = Row({255, 254, 0})},
                    {2, 0, 1}},
        PictureForm{
            "Palette",
            {.color_type = 3, .chunks = kPalette, .rows = Row({0, 1, 2, 3})},
            {0, 1, 2, 1}},
        PictureForm{"PaletteOfTwoBits",
                    {.depth = 2,
                     .color_type = 3,
                     .chunks = kPalette,
                     .rows = Row({0x1B})},
                    {0, 1, 2, 1}},
        PictureForm{"PaletteWithAlpha",
                    {.color_type = 3,
                     .chunks = kPalette + Chunk("tRNS", Bytes({0, 255})),
                     .rows = Row({0, 1, 2})},
                    {2, 1, 0}}),
    [](const auto& tested) {
      return tested.param.name;
    });

TEST(RosMap, UnknownGroundOfColourPicturesIsKnown) {
  const TempFolder folder;
  for (const HandMade& png :
       {HandMade{.width = 2,
       .color_type = 2,
       .rows = Row({205, 205, 205, 254, 254, 254})},
        HandMade{.width = 2,
        .color_type = 6,
        .rows = Row({205, 205, 205, 255, 254, 254, 254, 255})},
        HandMade{.width = 2,
        .depth = 16,
        .color_type = 0,
        .rows = Row16({205 * 257, 254 * 257})}}) {
    folder.Write("m.pgm", png.Bytes());
    const std::string path = folder.Write("m.yaml", kSavedYaml);
    MapFileOptions options;
    const auto usual = ReadMap(path, options);
    ASSERT_EQ(IdsOf(usual), (std::vector<int>{0, 0})) << ErrorMessage(usual);
    EXPECT_EQ(usual->notices.size(), 1U);
    options.unknown = ParseUnknownGround("impassable").value();
    EXPECT_EQ(IdsOf(ReadMap(path, options)), (std::vector<int>{2, 0}));
  }
}

TEST(RosMap, GradedModesTakeOnlyGreyOpaquePixels) {
  const TempFolder folder;
  MapFileOptions options;
  options.legend = folder.Write(
      "l.csv", "id,name,cost,color\n0,road,1,#FFFFFF\n100,mud,5,#806040\n");
  const auto read = [&](const HandMade& png) {
    folder.Write("m.pgm", png.Bytes());
    return ReadMap(folder.Write("m.yaml", std::string(kYaml) + "mode: scale\n"),
                   options);
  };
  const auto rgb = read(
      {.width = 2, .color_type = 2, .rows = Row({0, 0, 0, 100, 100, 100})});
  EXPECT_EQ(IdsOf(rgb), (std::vector<int>{0, 100})) << ErrorMessage(rgb);
  const auto alpha =
      read({.width = 2, .color_type = 4, .rows = Row({0, 255, 100, 255})});
  EXPECT_EQ(IdsOf(alpha), (std::vector<int>{0, 100})) << ErrorMessage(alpha);
  EXPECT_THAT(
      ErrorMessage(read(
          {.width = 2, .color_type = 2, .rows = Row({0, 0, 0, 100, 99, 100})})),
      HasSubstr("pixel (1, 0) is not grey"));
  EXPECT_THAT(
      ErrorMessage(
          read({.width = 2, .color_type = 4, .rows = Row({0, 255, 100, 0})})),
      HasSubstr("pixel (1, 0) is transparent"));
  EXPECT_THAT(ErrorMessage(read({.depth = 16, .rows = Row16({1})})),
              HasSubstr("16 bits"));
}

TEST(RosMap, ATruncatedColourPictureIsRefusedAtEveryLength) {
  const TempFolder folder;
  const std::string path = folder.Write("m.yaml", kYaml);
  const std::string whole =
      HandMade{
          .width = 2, .color_type = 6, .rows = Row({1, 2, 3, 4, 5, 6, 7, 8})}
          .Bytes();
  for (std::size_t length = 8; length < whole.size(); ++length) {
    folder.Write("m.pgm", std::string_view(whole).substr(0, length));
    ASSERT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("truncated")) << length;
  }
}

TEST(RosMap, APgmOfAnotherSizeThanItsHeaderSaysIsRefused) {
  const TempFolder folder;
  const std::string path = folder.Write("m.yaml", kYaml);
  folder.Write("m.pgm", "P5\n2 1\n255\nabcdef");
  EXPECT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("4 bytes more"));
  folder.Write("m.pgm", "P512 1 255 aa");
  EXPECT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("neither a binary PGM"));
  folder.Write("m.pgm", "P5\n2 1\n255xab");
  EXPECT_THAT(ErrorMessage(ReadMap(path)), HasSubstr("one white space"));
  folder.Write("m.pgm", "P5\n2 1\n255\nab\n");
  EXPECT_TRUE(ReadMap(path).ok()) << "a line feed at the end is harmless";
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

TEST(RosMap, ATextOfDocumentsWithoutEndIsRefused) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(ReadMap(WriteRosMap(folder, ",\n", {255}))),
              HasSubstr("not a map_server yaml"));
}

INSTANTIATE_TEST_SUITE_P(
    Yamls, WrongRosMap,
    ::testing::Values(
        WrongYaml{"image: m.pgm\n", "", "no 'image'"},
        WrongYaml{"image: m.pgm", "image: none.pgm", "no such file"},
        WrongYaml{"resolution: 0.05", "resolution: 0", "m.yaml:2: "},
        WrongYaml{"resolution: 0.05", "resolution: nan", "m.yaml:2: "},
        WrongYaml{"resolution: 0.05", "resolution: fine", "m.yaml:2: "},
        WrongYaml{"resolution: 0.05", "resolution: 0,05", "a point, no unit"},
        WrongYaml{"resolution: 0.05", "resolution: 5 cm", "a point, no unit"},
        WrongYaml{"resolution: 0.05", "resolution: 0.05m", "m.yaml:2: "},
        WrongYaml{"resolution: 0.05",
                  "resolution:", "m.yaml:2: 'resolution' has no value"},
        WrongYaml{"negate: 0", "negate: ~", "m.yaml:4: 'negate' has no value"},
        WrongYaml{"resolution: 0.05", "resolution: [0.05]", "m.yaml:2: "},
        WrongYaml{"[-10, 2.5, 0.1]", "[-10, 2.5]",
                  "m.yaml:3: 'origin' takes three numbers, [x, y, yaw]"},
        WrongYaml{"[-10, 2.5, 0.1]", "[-10, 2.5, 0, 0.1]", "three numbers"},
        WrongYaml{"[-10, 2.5, 0.1]", "-10 2.5 0.1", "three numbers"},
        WrongYaml{"[-10, 2.5, 0.1]", "[-10, 2.5 m, 0]", "'2.5 m'"},
        WrongYaml{"[-10, 2.5, 0.1]", "[-10, .inf, 0]", "'origin'"},
        WrongYaml{"negate: 0", "negate: 0\nmode: funny", "known are trinary"},
        WrongYaml{"negate: 0", "negate: 0\nmode: [scale]", "m.yaml:5: 'mode'"},
        WrongYaml{"negate: 0", "negate: 0\nmode: ''", "m.yaml:5: 'mode'"},
        WrongYaml{"negate: 0", "negate: 0\nMode: scale",
                  "m.yaml:5: 'Mode' must be written 'mode'"},
        WrongYaml{"negate: 0", "negate: 0\nnegate: 1",
                  "m.yaml:5: 'negate' comes twice"},
        WrongYaml{"negate: 0\n", "", "no 'negate'"},
        WrongYaml{"image: m.pgm", "image: ''", "m.yaml:1: 'image'"},
        WrongYaml{"free_thresh: 0.196", "free_thresh: 19.6%", "m.yaml:6: "},
        WrongYaml{"free_thresh: 0.196", "free_thresh: 0.1\n---\nnegate: 1",
                  "one list of"},
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
