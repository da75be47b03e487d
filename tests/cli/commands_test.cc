// `terra` as people use it: what it prints, what it says when something is
// wrong, and how it exits.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using ::testing::HasSubstr;
using testing::RunResult;
using ::testing::StartsWith;

RunResult Terra(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {testing::ProgramPath("terra")};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return testing::RunToEnd(command);
}

// A 5 x 3 MovingAI map: a wall in the middle column, open at the top.
class TerraCommand : public ::testing::Test {
 protected:
  RunResult OnMap(std::vector<std::string> arguments,
                  const std::string& start = "0,2",
                  const std::string& goal = "4,2") {
    arguments.insert(arguments.end(),
                     {"--map", map_, "--start", start, "--goal", goal});
    return Terra(arguments);
  }

  testing::TempFolder folder_;
  std::string map_ = folder_.Write("wall.map",
                                   "type octile\nheight 3\nwidth 5\nmap\n"
                                   ".....\n..@..\n..@..\n");
};

TEST_F(TerraCommand, OraclePrintsCostAndRouteAsJson) {
  const RunResult run = OnMap({"oracle", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_NEAR(json["cost"].get<double>(), 4 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(json["waypoints"].front(), nlohmann::json({0, 2}));
  EXPECT_EQ(json["waypoints"].back(), nlohmann::json({4, 2}));
  EXPECT_TRUE(json.contains("expanded") && json.contains("seconds"));
}

TEST_F(TerraCommand, NoRouteIsJsonWithNullAndExitOne) {
  folder_.Write("wall.map",
                "type octile\nheight 3\nwidth 5\nmap\n"
                "..@..\n..@..\n..@..\n");
  for (const char* command : {"plan", "oracle"}) {
    const RunResult run = OnMap({command, "--json"});
    EXPECT_EQ(run.exit_code, 1) << command;
    EXPECT_THAT(run.output, StartsWith("{\"cost\":null,\"waypoints\":[]"))
        << command;
  }
}

TEST_F(TerraCommand, CornerCuttingOffGoesAround) {
  folder_.Write("wall.map",
                "type octile\nheight 3\nwidth 3\nmap\n"
                ".@.\n@..\n...\n");
  EXPECT_EQ(OnMap({"oracle"}, "0,0", "2,2").exit_code, 0);
  EXPECT_EQ(
      OnMap({"oracle", "--corner-cutting", "off"}, "0,0", "2,2").exit_code, 1);
}

TEST_F(TerraCommand, StartOnAnObstacleIsNamed) {
  const RunResult run = OnMap({"plan"}, "2,1");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("start (2, 1) is on impassable ground"));
}

TEST_F(TerraCommand, GoalOutsideTheMapIsNamedWithTheLimits) {
  const RunResult run = OnMap({"oracle"}, "0,0", "5,0");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("goal (5, 0) is outside the map; x is 0 "
                                    "to 4, y is 0 to 2"));
}

TEST_F(TerraCommand, MissingMapIsNamed) {
  const RunResult run = Terra(
      {"plan", "--map", "/nowhere.png", "--start", "0,0", "--goal", "1,1"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("/nowhere.png: there is no such file"));
}

TEST_F(TerraCommand, VerifyNamesTheFirstFailingCell) {
  const RunResult run =
      OnMap({"verify", "--baseline", "[(0, 2), (2, 0), (4, 2)]", "--candidate",
             "[(0, 2), (4, 2)]", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["code"], "obstacle");
  EXPECT_EQ(json["deployed"], "baseline");
  EXPECT_EQ(json["candidate_cost"], nullptr);
  EXPECT_EQ(json["candidate"]["cell"], nlohmann::json({2, 2}));
}

TEST_F(TerraCommand, VerifyTakesACandidateThatCannotBeReadAsAVerdict) {
  const RunResult run =
      OnMap({"verify", "--baseline", "[(0, 2), (2, 0), (4, 2)]", "--candidate",
             "[(0, 2), (4", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_EQ(nlohmann::json::parse(run.output)["code"], "parse_error");
}

TEST_F(TerraCommand, EqualCostIsNotCheaper) {
  const RunResult run =
      OnMap({"verify", "--baseline", "[(0, 2), (2, 0), (4, 2)]", "--candidate",
             "[(0, 2), (2, 0), (4, 2)]", "--json"});
  EXPECT_EQ(nlohmann::json::parse(run.output)["code"], "not_cheaper");
}

TEST_F(TerraCommand, AnInvalidBaselineIsAVerdictLikeAnyOther) {
  const std::vector<std::string> command = {"verify", "--baseline",
                                            "[(0, 2), (4, 2)]", "--candidate",
                                            "[(0, 2), (2, 0), (4, 2)]"};
  const RunResult text = OnMap(command);
  EXPECT_EQ(text.exit_code, 0) << text.output;
  EXPECT_THAT(text.output, HasSubstr("verdict    baseline_invalid"));
  EXPECT_THAT(text.output, HasSubstr("deployed   nothing"));
  EXPECT_THAT(text.output, HasSubstr("baseline   obstacle in segment 0"));
  std::vector<std::string> with_json = command;
  with_json.push_back("--json");
  const RunResult run = OnMap(with_json);
  EXPECT_EQ(run.exit_code, 0) << run.output;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["code"], "baseline_invalid");
  EXPECT_EQ(json["deployed"], nullptr);
}

TEST_F(TerraCommand, AdviseBeatsADearBaselineAndRetainsAnOptimalOne) {
  const std::string detour = "[(0, 2), (0, 0), (4, 0), (4, 2)]";
  for (const char* backend : {"search", "shortcut"}) {
    const RunResult run =
        OnMap({"advise", "--backend", backend, "--baseline", detour, "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto json = nlohmann::json::parse(run.output);
    EXPECT_EQ(json["code"], "accepted") << backend;
    EXPECT_LT(json["candidate_cost"], json["baseline_cost"]) << backend;
  }
  const RunResult run =
      OnMap({"advise", "--backend", "search", "--stride", "1", "--json"});
  EXPECT_EQ(nlohmann::json::parse(run.output)["code"], "retained");
}

TEST_F(TerraCommand, RenderWritesAPicture) {
  const std::string out = folder_.Path("out.png");
  const RunResult run = Terra({"render", "--map", map_, "--route",
                               "[(0, 2), (2, 0), (4, 2)]", "--out", out});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(testing::ReadBytes(out), StartsWith("\x89PNG"));
}

TEST_F(TerraCommand, PictureThatCannotBeWrittenIsAnError) {
  const RunResult run =
      Terra({"render", "--map", map_, "--out", "/nowhere/out.png"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("/nowhere/out.png"));
}

TEST_F(TerraCommand, DatasetRoutesWithAnUnknownCaseNameTheLine) {
  folder_.Write("cases.csv",
                "case_id,map,start_x,start_y,goal_x,goal_y\n"
                "a,wall.map,0,2,4,2\n");
  folder_.Write("routes.csv",
                "case_id,k,route\na,1,\"[(0, 2), (2, 0), (4, 2)]\"\n"
                "b,1,\"[(0, 2), (4, 2)]\"\n");
  const RunResult run =
      Terra({"verify", "--dataset", folder_.Path(""), "--routes",
             folder_.Path("routes.csv"), "--out", folder_.Path("out.csv")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("routes.csv:3"));
}

TEST_F(TerraCommand, MapsReadUnderTheDefaultLegendAreNamedOnce) {
  const std::string data = folder_.Path("data");
  folder_.Write("data/wall.map", "type octile\nheight 1\nwidth 2\nmap\n..\n");
  folder_.Write("data/cases.csv",
                "case_id,map,start_x,start_y,goal_x,goal_y\n"
                "a,wall.map,0,0,1,0\nb,wall.map,0,0,1,0\n");
  const std::vector<std::string> gap = {
      "bench", "gap", "--dataset", data, "--out", folder_.Path("gap.csv")};
  const std::string notice =
      "no legend.csv: wall.map is read under the legend multiterrapath";
  const std::string output = Terra(gap).output;
  const std::size_t at = output.find(notice);
  ASSERT_NE(at, std::string::npos) << output;
  EXPECT_EQ(output.find(notice, at + 1), std::string::npos) << output;
  folder_.Write("data/legend.csv", "id,name,cost,color\n0,ground,1,#ffffff\n");
  EXPECT_THAT(Terra(gap).output, Not(HasSubstr(notice)));
}

TEST_F(TerraCommand, DatasetRoutesAreCheckedUnderTheCostModel) {
  folder_.Write("cases.csv",
                "case_id,map,start_x,start_y,goal_x,goal_y\n"
                "a,wall.map,0,1,4,1\n");
  folder_.Write("legend.csv",
                "id,name,cost,color\n"
                "0,ground,1,#ffffff\n4,out of bounds,inf,#000000\n");
  const std::string routes = folder_.Write(
      "routes.csv",
      "case_id,k,route\na,0,\"[(0, 1), (1, 1), (2, 0), (3, 1), (4, 1)]\"\n");
  const std::string out = folder_.Path("verdicts.csv");
  for (const auto& [corners, code] :
       {std::pair{"on", "feasible"}, std::pair{"off", "obstacle"}}) {
    const RunResult run =
        Terra({"verify", "--dataset", folder_.Path("."), "--routes", routes,
               "--out", out, "--corner-cutting", corners});
    EXPECT_EQ(run.exit_code, 0) << run.output;
    EXPECT_THAT(testing::ReadBytes(out), HasSubstr(std::string("a,0,") + code));
  }
}

TEST_F(TerraCommand, PlanThatFindsNoRouteNamesTheStride) {
  folder_.Write("wall.map",
                "type octile\nheight 3\nwidth 5\nmap\n"
                "..@..\n..@..\n..@..\n");
  EXPECT_THAT(OnMap({"plan", "--stride", "3"}).output,
              HasSubstr("on the lattice of stride 3; try a smaller --stride"));
}

TEST_F(TerraCommand, AFileWithoutEventsIsNoLog) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{
           {"log", "info", map_},
           {"log", "audit", map_},
           {"log", "report", map_, "--out", folder_.Path("page.html")}}) {
    const RunResult run = Terra(arguments);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.output, HasSubstr("holds no events"));
  }
}

TEST_F(TerraCommand, AForeignLogIsNothingToAudit) {
  // One event of LCM's format: sync word, number, time, lengths, channel, data.
  const std::string log(
      "\xED\xA1\xDA\x01"
      "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\1"
      "\0\0\0\3\0\0\0\4FOOdata",
      35);
  const RunResult run =
      Terra({"log", "audit", folder_.Write("foreign.lcmlog", log)});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.output, HasSubstr("nothing to audit"));
}

TEST_F(TerraCommand, ANameThatIsNoUtf8StandsInTheJsonOfAPrompt) {
  const RunResult run = OnMap({"prompt", "--json", "--stride", "2", "--out",
                               folder_.Path("question\xFF")});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_THAT(run.output, HasSubstr("question\uFFFD\""));
}

TEST(TerraUsage, WrongUsageExitsWithTwoAndPointsToHelp) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"fly"},
      {"plan"},
      {"plan", "--map", "m.png", "--start", "1;2", "--goal", "3,4"},
      {"plan", "--map", "m.png", "--start", "1,2", "--goal", "3,4", "--stride",
       "0"},
      {"verify", "--map", "m.png"},
      {"render", "--map", "m.png"},
      {"advise", "--backend", "magic"},
      {"request", "--start", "1,2"},
      {"request", "--start", "1,2", "--goal", "3,4", "--map", "m.png",
       "--keep"},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    const RunResult run = Terra(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.output;
    EXPECT_THAT(run.output, HasSubstr("--help"));
  }
}

TEST(TerraUsage, AMissingSubcommandIsAskedForWithItsNames) {
  EXPECT_THAT(Terra({"fly"}).output, HasSubstr("plan, oracle, verify"));
  EXPECT_THAT(Terra({"log"}).output, HasSubstr("info, audit, report"));
}

TEST(TerraUsage, VerifySaysWhichOptionsGoTogether) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{
           {"verify"},
           {"verify", "--corner-cutting", "off"},
           {"verify", "--map", "m.png", "--start", "1,1", "--goal", "2,2",
            "--baseline", "[(1,1),(2,2)]", "--candidate", "[]", "--dataset",
            "d", "--routes", "r.csv", "--out", "v.csv"}}) {
    const RunResult run = Terra(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.output, HasSubstr("--candidate, or --dataset"));
  }
  EXPECT_THAT(Terra({"verify", "--dataset", "d"}).output,
              HasSubstr("--routes is required"));
}

TEST(TerraUsage, WrongBusOptionsExitWithTwo) {
  for (const char* command : {"request", "monitor"}) {
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--robot", "lower"},
          std::vector<std::string>{"--lcm-url", "udpm://10.0.0.1:7667"}}) {
      std::vector<std::string> arguments = {command};
      if (arguments.front() == "request") {
        arguments.insert(arguments.end(), {"--start", "1,1", "--goal", "2,2"});
      }
      arguments.insert(arguments.end(), options.begin(), options.end());
      EXPECT_EQ(Terra(arguments).exit_code, 2) << command;
    }
  }
}

TEST(TerraUsage, EveryCommandHasAnExample) {
  for (const char* command :
       {"plan", "oracle", "verify", "advise", "render", "request", "monitor"}) {
    const RunResult run = Terra({command, "--help"});
    EXPECT_EQ(run.exit_code, 0) << command;
    EXPECT_THAT(run.output, HasSubstr(std::string("terra ") + command + " "))
        << command;
  }
}

TEST(TerraUsage, ProgramsOnTheBusRefuseUnknownOptionsAndConfigKeys) {
  const testing::TempFolder folder;
  const std::string config = folder.Write("bad.toml", "strude = 50\n");
  const std::string planner = testing::ProgramPath("terra-planner");
  EXPECT_EQ(testing::RunToEnd({planner, "--strude", "50"}).exit_code, 2);
  const RunResult run = testing::RunToEnd({planner, "--config", config});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.output, HasSubstr("bad.toml: there is no option strude"));
}

TEST(TerraUsage, AConfigurationThatIsNoTomlIsRefusedWithItsLine) {
  const testing::TempFolder folder;
  std::string parts = "a";
  for (int i = 0; i < 50'000; ++i) parts += ".a";
  struct Case {
    std::string text;
    std::string says;
  };
  for (const Case& tested :
       {Case{"stride = 50\nname = \"planner\n", "line 2: this is no TOML"},
        Case{"name = planner\n", "line 1: this is no TOML"},
        Case{"stride = 050\n", "line 1: this is no TOML"},
        Case{"stride = 50\nstride = 60\n", "line 2: this is no TOML"},
        Case{"\n[planner]\nstride = 50\n",
             "line 2: options stand in no section"},
        Case{"[?]\n", "line 1: this is no TOML"},
        Case{"stride = 2026-12-01\n", "line 1: expected a string, a number"},
        Case{"[" + parts + "]\nstride = 50\n", "larger than 64 kB"},
        Case{"[" + parts.substr(0, 60'000) + "]\n", "line 1: no option has"},
        Case{parts.substr(0, 200) + " = 1\n", "line 1: no option has"}}) {
    const std::string config = folder.Write("bad.toml", tested.text);
    const RunResult run = testing::RunToEnd(
        {testing::ProgramPath("terra-planner"), "--config", config});
    const std::string begin = tested.text.substr(0, 40);
    EXPECT_EQ(run.exit_code, 2) << begin;
    EXPECT_THAT(run.output, HasSubstr("bad.toml: ")) << begin;
    EXPECT_THAT(run.output, HasSubstr(tested.says)) << begin;
  }
}

TEST(TerraUsage, AConfigurationHoldsWhatTomlHolds) {
  const testing::TempFolder folder;
  const std::string config = folder.Write("good.toml", R"(# A comment.
name = 'the "planner"'   # another
stride = 0x32
robot = "A\u0042C"
)");
  const RunResult run =
      testing::RunToEnd({testing::ProgramPath("terra-planner"), "--config",
                         config, "--print-config"});
  EXPECT_EQ(run.exit_code, 0) << run.output;
  for (const char* line :
       {"name='the \"planner\"'\n", "stride=50\n", "robot=\"ABC\"\n"}) {
    EXPECT_THAT(run.output, HasSubstr(line));
  }
}

TEST(TerraUsage, PrintedConfigIsReadBackTheSame) {
  const testing::TempFolder folder;
  struct Case {
    std::string program;
    std::vector<std::string> options;
    std::vector<std::string> lines;
  };
  for (const Case& tested :
       {Case{"terra-planner", {"--stride", "25"}, {"stride=25\n"}},
        // What is on without a word of the user's says so too.
        Case{"terra-advisor", {}, {"method=\"advisor\"\n", "images=true\n"}},
        Case{"terra-advisor",
             {"--method", "direct", "--no-images", "--price", "m=1:2"},
             {"method=\"direct\"\n", "images=false\n", "m=1:2"}},
        Case{"terra-advisor",
             {"--record", "a\\b 'c' #d.jsonl"},
             {"record=\"a\\\\b 'c' #d.jsonl\"\n"}}}) {
    std::vector<std::string> command = {testing::ProgramPath(tested.program),
                                        "--print-config"};
    command.insert(command.end(), tested.options.begin(), tested.options.end());
    const RunResult first = testing::RunToEnd(command);
    ASSERT_EQ(first.exit_code, 0) << first.output;
    for (const std::string& line : tested.lines) {
      EXPECT_THAT(first.output, HasSubstr(line));
    }
    const std::string config = folder.Write("read.toml", first.output);
    EXPECT_EQ(testing::RunToEnd(
                  {command.front(), "--config", config, "--print-config"})
                  .output,
              first.output);
  }
}

TEST(TerraUsage, ExampleConfigurationsOfTheUnitsAreRead) {
  for (const std::string name : {"map", "planner", "verifier", "advisor"}) {
    const RunResult run = testing::RunToEnd(
        {testing::ProgramPath("terra-" + name), "--config",
         TERRA_EXAMPLE_CONFIGS "/" + name + "-demo.toml", "--print-config"});
    EXPECT_EQ(run.exit_code, 0) << run.output;
  }
}

}  // namespace
}  // namespace terra
