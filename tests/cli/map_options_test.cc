// What the options of maps and datasets do in every command that has them.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadBytes;
using testing::RunResult;
using testing::TempFolder;

RunResult Terra(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {testing::ProgramPath("terra")};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return testing::RunToEnd(command);
}

constexpr char kYaml[] =
    "image: site.PGM\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: no\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.25\n";
constexpr char kNotice[] = "with which map savers mark unknown ground";

// Free ground with a column of grey 205 in its middle, as Nav2 saves it.
class UnknownGroundTest : public ::testing::Test {
 protected:
  UnknownGroundTest() {
    std::string pgm = "P5\n5 3\n255\n";
    for (int y = 0; y < 3; ++y) pgm += "\xFE\xFE\xCD\xFE\xFE";
    folder_.Write("site.PGM", pgm);
    folder_.Write("data/maps/site.PGM", pgm);
    folder_.Write("data/maps/site.Yaml", kYaml);
    folder_.Write("data/cases.csv",
                  "# a comment\ncase_id, map, start_x, start_y, goal_x, goal_y"
                  "\na, maps/site.Yaml, 0, 1, 4, 1\n");
    folder_.Write("data/legend.csv",
                  "id,name,cost,color\n0,free,1,#FFFFFF\n1,wall,Inf,#000000\n"
                  "2,unknown,INF,#808080\n");
  }

  RunResult OnMap(std::vector<std::string> arguments,
                  const std::string& unknown) {
    arguments.insert(arguments.end(),
                     {"--map", folder_.Write("SITE.YML", kYaml)});
    return WithUnknown(std::move(arguments), unknown);
  }
  static RunResult WithUnknown(std::vector<std::string> arguments,
                               const std::string& unknown) {
    if (!unknown.empty()) {
      arguments.insert(arguments.end(), {"--unknown", unknown});
    }
    return Terra(arguments);
  }

  TempFolder folder_;
};

TEST_F(UnknownGroundTest, EveryCommandOnAMapKnowsIt) {
  const std::vector<std::string> ends = {"--start", "0,1", "--goal", "4,1"};
  const std::vector<std::string> straight = {"--baseline", "[(0, 1), (4, 1)]",
                                             "--candidate", "[(0, 1), (4, 1)]"};
  std::vector<std::vector<std::string>> commands = {
      {"oracle"}, {"plan", "--stride", "2"}, {"verify"}};
  for (std::vector<std::string>& command : commands) {
    command.insert(command.end(), ends.begin(), ends.end());
    if (command[0] == "verify") {
      command.insert(command.end(), straight.begin(), straight.end());
    }
    const RunResult usual = OnMap(command, "");
    EXPECT_EQ(usual.exit_code, 0) << usual.output;
    EXPECT_THAT(usual.output, HasSubstr(kNotice)) << command[0];
    const RunResult free = OnMap(command, "free");
    EXPECT_EQ(free.exit_code, 0) << free.output;
    EXPECT_THAT(free.output, Not(HasSubstr(kNotice))) << command[0];
    const RunResult closed = OnMap(command, "impassable");
    EXPECT_THAT(closed.output, Not(HasSubstr(kNotice))) << command[0];
    EXPECT_NE(closed.output, free.output) << command[0];
  }
  const RunResult picture =
      OnMap({"render", "--out", folder_.Path("p.png")}, "3");
  EXPECT_EQ(picture.exit_code, 0) << picture.output;
  const RunResult nonsense =
      OnMap({"oracle", "--start", "0,1", "--goal", "4,1"}, "unkown");
  EXPECT_EQ(nonsense.exit_code, 2);
  EXPECT_THAT(nonsense.output, HasSubstr("neither impassable nor free"));
}

TEST_F(UnknownGroundTest, ItsCostIsTheUsers) {
  const std::vector<std::string> oracle = {"oracle", "--start", "0,1",
                                           "--goal", "4,1",     "--json"};
  EXPECT_THAT(OnMap(oracle, "2.5").output, HasSubstr("\"cost\":5.5"));
  EXPECT_EQ(OnMap(oracle, "impassable").exit_code, 1);
}

TEST_F(UnknownGroundTest, CommandsOnADatasetKnowItToo) {
  const std::string out = folder_.Path("gap.csv");
  const std::vector<std::string> gap = {
      "bench",     "gap", "--dataset", folder_.Path("data"),
      "--strides", "2",   "--out",     out};
  const RunResult usual = WithUnknown(gap, "");
  ASSERT_EQ(usual.exit_code, 0) << usual.output;
  EXPECT_THAT(usual.output, HasSubstr(kNotice));
  EXPECT_THAT(ReadBytes(out), HasSubstr("a,2,4,4"));
  const RunResult closed = WithUnknown(gap, "impassable");
  ASSERT_EQ(closed.exit_code, 0) << closed.output;
  EXPECT_THAT(closed.output, Not(HasSubstr(kNotice)));
  EXPECT_THAT(ReadBytes(out), HasSubstr("a,2,inf,inf"));

  const std::string routes =
      folder_.Write("r.csv", "case_id,k,route\na,1,\"[(0, 1), (4, 1)]\"\n");
  const RunResult verified =
      WithUnknown({"verify", "--dataset", folder_.Path("data"), "--routes",
                   routes, "--out", folder_.Path("v.csv")},
                  "impassable");
  ASSERT_EQ(verified.exit_code, 0) << verified.output;
  EXPECT_THAT(ReadBytes(folder_.Path("v.csv")), HasSubstr("a,1,obstacle,inf"));

  const RunResult run = WithUnknown(
      {"bench", "run", "--dataset", folder_.Path("data"), "--method", "coarse",
       "--stride", "2", "--out", folder_.Path("run")},
      "free");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(ReadBytes(folder_.Path("run/run.json")),
              ContainsRegex("cases.csv:[0-9a-f]+ --unknown free\""));
}

TEST_F(UnknownGroundTest, TheMapServerHasItAsAnOption) {
  const std::string map_server = testing::ProgramPath("terra-map");
  const std::string config = folder_.Write("c.toml", "unknown = \"free\"\n");
  const RunResult taken =
      testing::RunToEnd({map_server, "--config", config, "--print-config"});
  EXPECT_EQ(taken.exit_code, 0) << taken.output;
  EXPECT_THAT(taken.output, HasSubstr("unknown=\"free\""));
  folder_.Write("c.toml", "unknown = \"yes\"\n");
  const RunResult refused =
      testing::RunToEnd({map_server, "--config", config, "--print-config"});
  EXPECT_EQ(refused.exit_code, 2) << refused.output;
  EXPECT_THAT(refused.output, HasSubstr("neither impassable nor free"));
}

TEST_F(UnknownGroundTest, ADatasetMayHaveAnyNameThatTheSystemAllows) {
  const std::string folder = folder_.Path("d\xE4ta");
  std::filesystem::rename(folder_.Path("data"), folder);
  const RunResult run =
      Terra({"bench", "run", "--dataset", folder, "--method", "coarse",
             "--stride", "2", "--out", folder_.Path("r\xE4n")});
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, Not(HasSubstr("json.exception")));
  EXPECT_THAT(ReadBytes(folder_.Path("r\xE4n/run.json")),
              HasSubstr("\"command_line\""));
}

TEST(NumberOptions, AreNeverOctal) {
  const RunResult run = Terra({"plan", "--map", "none.png", "--start", "0,0",
                               "--goal", "1,1", "--stride", "050"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.output, HasSubstr("050 is not a whole number"));
}

}  // namespace
}  // namespace terra
