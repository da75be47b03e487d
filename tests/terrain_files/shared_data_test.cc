// Real maps of other people, where they are there: what we read and find must
// agree with what was published or computed by other programs.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "terrain/builtin_legends.h"
#include "terrain/files/csv.h"
#include "terrain/files/legend_file.h"
#include "terrain/files/map_file.h"
#include "terrain/native_search.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"

namespace terra {
namespace {

using testing::ErrorMessage;
using testing::TempFolder;

std::string DataPath(const std::string& name) {
  return std::string(TERRA_SHARED_DATA) + "/" + name;
}

class SharedData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(DataPath("README.md"))) {
      GTEST_SKIP() << "the third-party maps are not there: "
                   << TERRA_SHARED_DATA;
    }
  }

  // MovingAI ground and swamp at these costs, the rest blocked.
  TerrainMap MovingAiMap(const std::string& name, double swamp,
                         bool corner_cutting) {
    const TempFolder folder;
    std::vector<Terrain> terrains = MovingAiLegend().terrains();
    terrains.at(kMovingAiSwamp).cost = swamp;
    MapFileOptions options;
    options.legend = folder.Path("legend.csv");
    options.cost_model.corner_cutting = corner_cutting;
    EXPECT_TRUE(
        WriteLegend(Legend::Create(terrains).value(), options.legend).ok());
    return ReadMap(DataPath("movingai/" + name), options).value().map;
  }
};

// Every n-th problem of a scenario file between passable cells.
struct Problem {
  Cell start;
  Cell goal;
  double length = 0;
};
std::vector<Problem> ReadScenario(const std::string& path, int every) {
  std::vector<Problem> problems;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);  // version
  for (int number = 0; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string bucket, map, width, height;
    Problem problem;
    if (fields >> bucket >> map >> width >> height >> problem.start.x >>
        problem.start.y >> problem.goal.x >> problem.goal.y >> problem.length) {
      if (number++ % every == 0) problems.push_back(problem);
    }
  }
  return problems;
}

class MovingAiScenario : public SharedData,
                         public ::testing::WithParamInterface<const char*> {};

TEST_P(MovingAiScenario, OptimalLengthsAreThePublishedOnes) {
  constexpr double kPrintedPrecision = 0.0051;
  const std::string name = GetParam();
  const TerrainMap map = MovingAiMap(name, 1, false);
  int checked = 0;
  for (const Problem& problem :
       ReadScenario(DataPath("movingai/" + name + ".scen"), 20)) {
    if (!map.Passable(problem.start) || !map.Passable(problem.goal)) continue;
    EXPECT_NEAR(NativeSearch(map, problem.start, problem.goal).cost,
                problem.length, kPrintedPrecision)
        << ToString(problem.start) << " to " << ToString(problem.goal);
    ++checked;
  }
  EXPECT_GT(checked, 30);
}

INSTANTIATE_TEST_SUITE_P(Maps, MovingAiScenario,
                         ::testing::Values("arena2.map", "Paris_1_256.map",
                                           "random512-25-3.map", "icecrown.map",
                                           "theglaive.map"));

struct CostColumn {
  const char* column;
  double swamp;
  bool corner_cutting;
};

class MovingAiCosts : public SharedData,
                      public ::testing::WithParamInterface<CostColumn> {};

TEST_P(MovingAiCosts, AgreeWithAnotherProgramsDijkstra) {
  const CsvTable table =
      ReadCsv(DataPath("movingai/reference_costs.csv"),
              {"map", "sx", "sy", "gx", "gy", GetParam().column})
          .value();
  for (const char* name : {"icecrown.map", "theglaive.map"}) {
    const TerrainMap map =
        MovingAiMap(name, GetParam().swamp, GetParam().corner_cutting);
    int checked = 0;
    for (const CsvRow& row : table.rows) {
      const auto field = [&](const char* column) {
        return row.fields[static_cast<std::size_t>(table.Column(column))];
      };
      if (field("map") != name) continue;
      const auto cell = [&](const char* x, const char* y) {
        return Cell{ParseInteger(field(x)).value(),
                    ParseInteger(field(y)).value()};
      };
      const double expected = ParseNumber(field(GetParam().column)).value();
      EXPECT_NEAR(NativeSearch(map, cell("sx", "sy"), cell("gx", "gy")).cost,
                  expected, 1e-8)
          << name << " line " << row.line;
      ++checked;
    }
    EXPECT_GE(checked, 16);
  }
}

INSTANTIATE_TEST_SUITE_P(Columns, MovingAiCosts,
                         ::testing::Values(CostColumn{"unit_nocut", 1, false},
                                           CostColumn{"unit_cut", 1, true},
                                           CostColumn{"S3_nocut", 3, false},
                                           CostColumn{"S3_cut", 3, true}));

TEST_F(SharedData, TheRugdLegendIsTheOfficialOne) {
  const CsvTable table = ReadCsv(DataPath("rugd/rugd_classes.csv"),
                                 {"id", "name", "R", "G", "B", "paper_cost"})
                             .value();
  EXPECT_EQ(table.rows.size(), RugdLegend().terrains().size());
  for (const CsvRow& row : table.rows) {
    const auto field = [&](const char* column) {
      return row.fields[static_cast<std::size_t>(table.Column(column))];
    };
    const Terrain* terrain =
        RugdLegend().Find(ParseInteger(field("id")).value());
    ASSERT_NE(terrain, nullptr);
    EXPECT_EQ(terrain->name, field("name"));
    EXPECT_EQ(std::to_string(terrain->color.r), field("R"));
    EXPECT_EQ(std::to_string(terrain->color.g), field("G"));
    EXPECT_EQ(std::to_string(terrain->color.b), field("B"));
    const std::string cost = field("paper_cost");
    EXPECT_EQ(terrain->cost,
              cost.empty() ? kImpassable : ParseNumber(cost).value());
  }
}

struct RugdShare {
  const char* name;
  double percent;
};

class RugdMasks : public SharedData,
                  public ::testing::WithParamInterface<RugdShare> {};

TEST_P(RugdMasks, HaveTheKnownShareOfPassableCells) {
  MapFileOptions options;
  options.legend = "rugd";
  const auto file = ReadMap(DataPath("rugd/") + GetParam().name, options);
  ASSERT_TRUE(file.ok()) << ErrorMessage(file);
  EXPECT_EQ(file->map.width(), 688);
  EXPECT_EQ(file->map.height(), 550);
  const auto passable = static_cast<double>((file->map.classes() != 0).count());
  EXPECT_NEAR(100 * passable / (688 * 550), GetParam().percent, 0.051);
}

INSTANTIATE_TEST_SUITE_P(
    Files, RugdMasks,
    ::testing::Values(RugdShare{"creek_00001.png", 41.2},
                      RugdShare{"park-1_00001.png", 49.0},
                      RugdShare{"park-2_02001.png", 40.7},
                      RugdShare{"trail_00001.png", 39.4},
                      RugdShare{"trail-10_00001.png", 47.5},
                      RugdShare{"village_00003.png", 43.2}));

struct OccupancyCounts {
  const char* name;
  int width;
  int height;
  int free;
  int occupied;
};

class Nav2Maps : public SharedData,
                 public ::testing::WithParamInterface<OccupancyCounts> {};

TEST_P(Nav2Maps, HaveTheCellsThatAnotherReaderCounts) {
  const auto file = ReadMap(DataPath("other/nav2/") + GetParam().name);
  ASSERT_TRUE(file.ok()) << ErrorMessage(file);
  EXPECT_EQ(file->map.width(), GetParam().width);
  EXPECT_EQ(file->map.height(), GetParam().height);
  const ByteRaster& ids = file->map.ids();
  EXPECT_EQ((ids == kOccupancyFree).count(), GetParam().free);
  EXPECT_EQ((ids == kOccupancyOccupied).count(), GetParam().occupied);
}

INSTANTIATE_TEST_SUITE_P(
    Files, Nav2Maps,
    ::testing::Values(
        OccupancyCounts{"TenByTen.yaml", 10, 10, 78, 20},
        OccupancyCounts{"depot.yaml", 604, 307, 179481, 5947},
        OccupancyCounts{"smoothers_world.yaml", 300, 300, 79424, 10576},
        OccupancyCounts{"tb3_sandbox.yaml", 384, 384, 7903, 870}));

// Counted by another program (numpy, from PIL's pixels).
struct OccupancyFile {
  const char* name;
  int occupied;
  int free;
  int unknown;
};

class OccupancyFiles : public SharedData,
                       public ::testing::WithParamInterface<OccupancyFile> {};

TEST_P(OccupancyFiles, HaveTheCellsThatAnotherProgramCounts) {
  const auto file = ReadMap(DataPath("geo/occupancy/") + GetParam().name);
  ASSERT_TRUE(file.ok()) << ErrorMessage(file);
  const ByteRaster& ids = file->map.ids();
  EXPECT_EQ((ids == kOccupancyOccupied).count(), GetParam().occupied);
  EXPECT_EQ((ids == kOccupancyFree).count(), GetParam().free);
  EXPECT_EQ((ids == kOccupancyUnknown).count(), GetParam().unknown);
}

INSTANTIATE_TEST_SUITE_P(
    Files, OccupancyFiles,
    ::testing::Values(OccupancyFile{"basement_fixed.map.yaml", 14374, 275742,
                                    1399884},
                      OccupancyFile{"depot.yaml", 5947, 179481, 0},
                      OccupancyFile{"depot_keepout.yaml", 31213, 154215, 0},
                      OccupancyFile{"nav2_test/testmap.yaml", 29, 71, 0},
                      OccupancyFile{"ros1_test/testmap2.yaml", 56, 88, 0}));

TEST_F(SharedData, AGradedNav2MapNeedsALegend) {
  const auto file = ReadMap(DataPath("other/nav2/depot_speed.yaml"));
  EXPECT_NE(ErrorMessage(file).find("--legend"), std::string::npos);
}

}  // namespace
}  // namespace terra
