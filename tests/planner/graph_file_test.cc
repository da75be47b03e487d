#include "planner/graph_file.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/files/map_file.h"
#include "terrain/route_cost.h"
#include "tests/support/error_message.h"
#include "tests/support/random_map.h"
#include "tests/support/temp_folder.h"

namespace terra::planner {
namespace {

using ::testing::ElementsAre;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::Random;
using testing::TempFolder;

const std::string kNodes = "name,x,y\nford,3,4\nmill,20,4\n\"a, b\",0,8191\n";
const std::string kEdges = "from,to\nford,mill\nmill,\"a, b\"\n";

Result<WaypointGraph> Read(const TempFolder& folder, const std::string& nodes,
                           const std::string& edges) {
  const std::string path = folder.Write("nodes.csv", nodes);
  folder.Write("edges.csv", edges);
  return ReadWaypointGraph(path.substr(0, path.rfind('/')));
}

TEST(GraphFileTest, ReadsNodesAndEdgesBothWays) {
  const TempFolder folder;
  const auto graph = Read(folder, kNodes, kEdges);
  ASSERT_TRUE(graph.ok()) << ErrorMessage(graph);
  ASSERT_EQ(graph->nodes().size(), 3U);
  EXPECT_EQ(graph->nodes()[2].name, "a, b");
  EXPECT_EQ(graph->nodes()[2].cell, (Cell{0, 8191}));
  EXPECT_THAT(graph->Neighbours(0), ElementsAre(1U));
  EXPECT_THAT(graph->Neighbours(1), ElementsAre(0U, 2U));
}

TEST(GraphFileTest, NamesTheFileThatIsNotThere) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(ReadWaypointGraph(folder.Path("none"))),
              HasSubstr("nodes.csv"));
}

struct WrongTable {
  std::string name;
  std::string nodes;
  std::string edges;
  std::string complaint;
};

class WrongGraphFile : public ::testing::TestWithParam<WrongTable> {};

TEST_P(WrongGraphFile, IsRefusedWithFileAndLine) {
  const TempFolder folder;
  EXPECT_THAT(ErrorMessage(Read(folder, GetParam().nodes, GetParam().edges)),
              HasSubstr(GetParam().complaint));
}

INSTANTIATE_TEST_SUITE_P(
    Rows, WrongGraphFile,
    ::testing::Values(
        WrongTable{"NoColumn", "name,x\nford,3\n", kEdges, "nodes.csv"},
        WrongTable{"EmptyName", kNodes + ",1,1\n", kEdges, "nodes.csv:5: "},
        WrongTable{"LongName", kNodes + std::string(32, 'n') + ",1,1\n", kEdges,
                   "nodes.csv:5: a node's name has 1 to 31 bytes"},
        WrongTable{"ControlCharacter", kNodes + "a\tb,1,1\n", kEdges,
                   "nodes.csv:5: "},
        WrongTable{"NotANumber", kNodes + "c,1.5,1\n", kEdges, "nodes.csv:5: "},
        WrongTable{"Negative", kNodes + "c,1,-1\n", kEdges,
                   "nodes.csv:5: y must be 0 to 8191"},
        WrongTable{"BeyondAnyMap", kNodes + "c,8192,1\n", kEdges,
                   "nodes.csv:5: x must be 0 to 8191"},
        WrongTable{"NameTwice", kNodes + "ford,1,1\n", kEdges,
                   "nodes.csv:5: the node 'ford' comes twice"},
        WrongTable{"CellTwice", kNodes + "c,3,4\n", kEdges,
                   "nodes.csv:5: the node 'ford' is at (3, 4) too"},
        WrongTable{"UnknownNode", kNodes, kEdges + "ford,moon\n",
                   "edges.csv:4: there is no node 'moon'"},
        WrongTable{"ToItself", kNodes, kEdges + "ford,ford\n",
                   "edges.csv:4: an edge from a node to itself"},
        WrongTable{"EdgeTwice", kNodes, kEdges + "mill,ford\n",
                   "edges.csv:4: this edge is there already"}),
    [](const auto& tested) {
      return tested.param.name;
    });

TEST(GraphFileTest, DamagedFilesAreReadOrRefusedButNeverHarm) {
  const TempFolder folder;
  Random random(1);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string nodes = kNodes;
    std::string edges = kEdges;
    for (int k = random.Int(1, 4); k > 0; --k) {
      std::string& text = random.OneIn(2) ? nodes : edges;
      const auto at = static_cast<std::size_t>(
          random.Int(0, static_cast<int>(text.size()) - 1));
      if (random.OneIn(3)) {
        text.erase(at, static_cast<std::size_t>(random.Int(1, 5)));
        if (text.empty()) text = "\n";
      } else {
        text[at] = static_cast<char>(random.Int(0, 255));
      }
    }
    const auto graph = Read(folder, nodes, edges);
    if (!graph.ok()) {
      ++refused;
      EXPECT_FALSE(graph.error().message.empty());
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(GraphFileTest, TheExampleGraphLeadsAcrossTheExampleMap) {
  const auto graph = ReadWaypointGraph(TERRA_EXAMPLES "/graph");
  ASSERT_TRUE(graph.ok()) << ErrorMessage(graph);
  const TerrainMap map =
      std::move(ReadMap(TERRA_EXAMPLES "/demo.png").value().map);
  for (std::size_t a = 0; a < graph->nodes().size(); ++a) {
    for (const std::size_t b : graph->Neighbours(a)) {
      EXPECT_LT(
          SegmentCost(map, graph->nodes()[a].cell, graph->nodes()[b].cell),
          kImpassable)
          << graph->nodes()[a].name << " to " << graph->nodes()[b].name;
    }
  }
  const LatticePlan plan = PlanOnGraph(map, *graph, {30, 250}, {470, 250});
  EXPECT_TRUE(plan.found());
  EXPECT_GT(plan.waypoints.size(), 4U);
}

}  // namespace
}  // namespace terra::planner
