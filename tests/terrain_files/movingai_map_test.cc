#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "terrain/files/map_formats.h"
#include "tests/support/error_message.h"

namespace terra {
namespace {

using testing::ErrorMessage;
using ::testing::HasSubstr;

TEST(MovingAiMap, CharactersAreTerrains) {
  const auto ids = ParseMovingAiMap(
      "type octile\nheight 2\nwidth 4\nmap\n.GSW\nT@O.\n", "m.map");
  ASSERT_TRUE(ids.ok()) << ErrorMessage(ids);
  ByteRaster expected(2, 4);
  expected << 0, 0, 1, 2, 3, 4, 4, 0;
  EXPECT_TRUE((*ids == expected).all());
}

TEST(MovingAiMap, WindowsLineEndsAndAMissingLastLineEndAreTaken) {
  EXPECT_TRUE(ParseMovingAiMap(
                  "type octile\r\nwidth 2\r\nheight 1\r\nmap\r\n..", "m.map")
                  .ok());
}

struct WrongMap {
  const char* text;
  const char* complaint;
};

class WrongMovingAiMap : public ::testing::TestWithParam<WrongMap> {};

TEST_P(WrongMovingAiMap, IsRefusedWithItsLine) {
  EXPECT_THAT(ErrorMessage(ParseMovingAiMap(GetParam().text, "m.map")),
              HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Maps, WrongMovingAiMap,
    ::testing::Values(
        WrongMap{"type octile\nheight 2\nwidth 2\n", "before the line"},
        WrongMap{"type hex\nheight 1\nwidth 1\nmap\n.\n",
                 "m.map:1: only maps of type octile"},
        WrongMap{"type octile\nheight 2\nheight 3\n", "m.map:3: this size"},
        WrongMap{"type octile\nheight 2 m\n", "m.map:2: not a size"},
        WrongMap{"type octile\nheight 2\nmap\n..\n..\n", "m.map:3: "},
        WrongMap{"type octile\nheight 0\n", "m.map:2: not a size"},
        WrongMap{"type octile\nheight x\n", "m.map:2: not a size"},
        WrongMap{"type octile\ndepth 3\n", "m.map:2: expected"},
        WrongMap{"type octile\nheight 2\nwidth 2\nmap\n..\n.\n",
                 "m.map:6: map row 1 has 1 characters"},
        WrongMap{"type octile\nheight 2\nwidth 2\nmap\n..\n.?\n",
                 "m.map:6: column 2"},
        WrongMap{"type octile\nheight 2\nwidth 2\nmap\n..\n",
                 "after 1 of 2 map rows"},
        WrongMap{"type octile\nheight 1\nwidth 2\nmap\n..\n..\n",
                 "m.map:6: text after"},
        WrongMap{"type octile\nheight 9000\nwidth 2\nmap\n", "1 to 8192"},
        WrongMap{"type octile\nheight 8192\nwidth 8192\nmap\n..\n",
                 "truncated"}));

}  // namespace
}  // namespace terra
