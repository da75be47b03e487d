// Nobody reads what the processes log: a stopped terminal, a pipe whose reader
// hangs. Nobody waits for that reader.
#include <string>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "tests/support/unread_output.h"
#include "tests/system/robot.h"

namespace terra {
namespace {

using terra_msg::deployed_t;
using testing::Robot;
using testing::UnreadOutput;

TerrainMap BarMap() {
  ByteRaster ids = ByteRaster::Zero(120, 160);
  ids.block(30, 70, 90, 20).setConstant(10);
  return TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
}

class UnreadLog : public ::testing::TestWithParam<UnreadOutput::Kind> {};

TEST_P(UnreadLog, StopsNoProcessFromServingNorFromEnding) {
  const UnreadOutput unread(GetParam());
  Robot robot(BarMap());
  robot.StartBehind(unread.AsStandardErrorOf());
  const std::vector<std::string> names = {"map", "planner", "verifier",
                                          "logger", "advisor"};
  robot.Start("map");
  robot.Start("planner", {"--stride", "20"});
  robot.Start("verifier");
  robot.Start("logger", {"--out", robot.folder().Path("log")});
  robot.Start("advisor");
  for (const std::string& name : names) {
    EXPECT_TRUE(robot.WaitForReady(name)) << name;
  }
  ASSERT_TRUE(robot.Ask(11, {5, 60}, {155, 60}));
  EXPECT_TRUE(robot.WaitForDeployed(11, deployed_t::MODE_CANDIDATE));
  for (const std::string& name : names) {
    EXPECT_EQ(robot.process(name).Terminate(), 0) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, UnreadLog,
                         ::testing::Values(UnreadOutput::Kind::kPipe,
                                           UnreadOutput::Kind::kTerminal));

}  // namespace
}  // namespace terra
