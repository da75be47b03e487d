// What was read from files is read again when one of them changes: the map
// server's map, the graph planner's graph. In virtual time.
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/codec.h"
#include "bus/map_node.h"
#include "planner/graph_planner_node.h"
#include "terrain/builtin_legends.h"
#include "terrain/files/map_file.h"
#include "tests/support/error_message.h"
#include "tests/support/temp_folder.h"
#include "tests/support/virtual_network.h"

namespace terra {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using terra_msg::baseline_t;
using terra_msg::map_header_t;
using testing::ErrorMessage;
using ::testing::HasSubstr;
using testing::TempFolder;
using testing::VirtualNetwork;

constexpr seconds kSeen(2);

// Writes into the file that is there. Its time is set, because file times are
// coarser than these tests are fast.
void WriteInPlace(const std::string& path, const std::string& text) {
  static int writes = 0;
  const auto before = fs::exists(path) ? fs::last_write_time(path)
                                       : fs::file_time_type::clock::now();
  std::ofstream(path, std::ios::binary | std::ios::trunc) << text;
  fs::last_write_time(path, before + seconds(++writes));
}

// Puts another file in its place, with the old one's time and size.
void Replace(const std::string& path, const std::string& text) {
  const auto time = fs::last_write_time(path);
  std::ofstream(path + ".new", std::ios::binary) << text;
  fs::last_write_time(path + ".new", time);
  fs::rename(path + ".new", path);
}

std::string Picture(int grey) {
  return "P5\n3 1\n255\n" + std::string{'\xFE', static_cast<char>(grey)} +
         '\xFE';
}

class ChangedMap : public ::testing::Test {
 protected:
  ChangedMap() {
    folder_.Write("site.yaml", Yaml("pictures/Floor_Edited.PGM"));
    folder_.Write("pictures/Floor_Edited.PGM", Picture(254));
    folder_.Write("cost.csv", Legend(1));
  }

  std::string picture() const {
    return folder_.Path("pictures/Floor_Edited.PGM");
  }
  static std::string Yaml(const std::string& image) {
    return "image: " + image +
           "\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
           "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  }
  static std::string Legend(int cost) {
    return "id,name,cost,color\n0,free," + std::to_string(cost) +
           ",#FFFFFF\n1,wall,inf,#000000\n2,unknown,inf,#808080\n";
  }

  void Start(const std::string& legend = "") {
    MapFileOptions options;
    options.legend = legend;
    node_ = &network_.Start("map", [&](bus::Outbox& out) {
      auto node = std::make_unique<bus::MapNode>(folder_.Path("site.yaml"),
                                                 options, out);
      const Status loaded = node->Load();
      EXPECT_TRUE(loaded.ok()) << ErrorMessage(loaded);
      return node;
    });
    network_.Run(seconds(1));
    ASSERT_EQ(Last().map_revision, 1);
    first_id_ = Last().map_id;
  }

  map_header_t Last() const { return network_.Sent<map_header_t>().back(); }
  bool SeesAnotherMap(std::int64_t than) {
    return network_.RunUntil(
        [&] {
          return Last().map_id != than;
        },
        kSeen);
  }

  TempFolder folder_;
  VirtualNetwork network_;
  bus::Node* node_ = nullptr;
  std::int64_t first_id_ = 0;
};

TEST_F(ChangedMap, ThePictureThatTheYamlNamesIsWatched) {
  Start();
  WriteInPlace(picture(), Picture(0));
  EXPECT_TRUE(SeesAnotherMap(first_id_));
  EXPECT_EQ(Last().map_revision, 2);
}

TEST_F(ChangedMap, AFileOfTheSameSizeAndTimeInItsPlaceIsSeen) {
  Start();
  Replace(picture(), Picture(0));
  EXPECT_TRUE(SeesAnotherMap(first_id_));
}

TEST_F(ChangedMap, TheYamlMayNameAnotherPicture) {
  folder_.Write("other.pgm", Picture(0));
  Start();
  WriteInPlace(folder_.Path("site.yaml"), Yaml("other.pgm"));
  ASSERT_TRUE(SeesAnotherMap(first_id_));
  // The new one is watched from now on.
  WriteInPlace(folder_.Path("other.pgm"), Picture(254));
  EXPECT_TRUE(SeesAnotherMap(Last().map_id));
  EXPECT_EQ(Last().map_id, first_id_);
}

TEST_F(ChangedMap, TheLegendIsWatched) {
  Start(folder_.Path("cost.csv"));
  WriteInPlace(folder_.Path("cost.csv"), Legend(2));
  EXPECT_TRUE(SeesAnotherMap(first_id_));
}

TEST_F(ChangedMap, AFileThatGoesLeavesTheMapAndComesBackAsAnother) {
  Start();
  for (const char* name : {"pictures/Floor_Edited.PGM", "site.yaml"}) {
    const std::string path = folder_.Path(name);
    fs::rename(path, path + ".away");
    network_.Run(seconds(3));
    EXPECT_EQ(Last().map_id, first_id_);
    EXPECT_THAT(node_->last_error(), HasSubstr("no such file"));
    fs::rename(path + ".away", path);
    network_.Run(kSeen);
    EXPECT_EQ(node_->last_error(), "");
    EXPECT_EQ(Last().map_id, first_id_);
  }
  fs::remove(picture());
  network_.Run(seconds(3));
  folder_.Write("pictures/Floor_Edited.PGM", Picture(0));
  EXPECT_TRUE(SeesAnotherMap(first_id_));
}

TEST_F(ChangedMap, AnUnreadablePictureThatIsMendedIsSeen) {
  Start();
  WriteInPlace(picture(), "P5\n3 1\n255\n");
  network_.Run(seconds(3));
  EXPECT_EQ(Last().map_id, first_id_);
  EXPECT_THAT(node_->last_error(), HasSubstr("truncated"));
  WriteInPlace(picture(), Picture(0));
  EXPECT_TRUE(SeesAnotherMap(first_id_));
}

TEST_F(ChangedMap, AFileThatNeverRestsIsReadAllTheSame) {
  Start();
  bus::Time next = network_.now();
  const bool seen = network_.RunUntil(
      [&] {
        if (network_.now() >= next) {
          Replace(picture(), Picture(0));
          next = network_.now() + milliseconds(100);
        }
        return Last().map_id != first_id_;
      },
      kSeen);
  EXPECT_TRUE(seen);
}

TEST_F(ChangedMap, NothingIsReadAgainWithoutAChange) {
  Start(folder_.Path("cost.csv"));
  network_.Run(seconds(5));
  EXPECT_EQ(Last().map_revision, 1);
}

class ChangedGraph : public ::testing::Test {
 protected:
  ChangedGraph() {
    folder_.Write("graph/nodes.csv", "name,x,y\na,5,5\nb,30,40\nc,55,5\n");
    folder_.Write("graph/edges.csv", "from,to\na,b\nb,c\n");
    ByteRaster ids = ByteRaster::Zero(60, 60);
    const TerrainMap map =
        TerrainMap::Create(std::move(ids), MultiTerraPathLegend()).value();
    EXPECT_TRUE(WriteIdPng(map, folder_.Path("map.png")).ok());
    network_.Start("map", [&](bus::Outbox& out) {
      auto node = std::make_unique<bus::MapNode>(folder_.Path("map.png"),
                                                 MapFileOptions{}, out);
      EXPECT_TRUE(node->Load().ok());
      return node;
    });
    planner_ = &network_.Start("planner", [&](bus::Outbox& out) {
      auto node = std::make_unique<planner::GraphPlannerNode>(
          "planner", folder_.Path("graph"), 10, out);
      EXPECT_TRUE(node->Load().ok());
      return node;
    });
    terra_msg::plan_request_t request{};
    request.session = 1;
    request.seq = 1;
    request.request_id = 9;
    request.action = terra_msg::plan_request_t::ACTION_GO;
    request.start_x = request.start_y = 5;
    request.goal_x = 55;
    request.goal_y = 5;
    network_.Run(seconds(2));
    network_.Inject(request);
    network_.Run(seconds(1));
  }

  Route Baseline() const {
    return bus::WaypointsOf(network_.Sent<baseline_t>().back());
  }

  TempFolder folder_;
  VirtualNetwork network_;
  bus::Node* planner_ = nullptr;
  const Route over_b_ = {{5, 5}, {30, 40}, {55, 5}};
};

TEST_F(ChangedGraph, TheRequestInForceGetsABaselineOfTheNewGraph) {
  ASSERT_EQ(Baseline(), over_b_);
  WriteInPlace(folder_.Path("graph/nodes.csv"),
               "name,x,y\na,5,5\nb,30,20\nc,55,5\n");
  const Route over_new_b = {{5, 5}, {30, 20}, {55, 5}};
  EXPECT_TRUE(network_.RunUntil(
      [&] {
        return Baseline() == over_new_b;
      },
      kSeen));
  EXPECT_EQ(network_.Sent<baseline_t>().back().request_id, 9);
}

TEST_F(ChangedGraph, ABadGraphLeavesTheOldOneAndIsReported) {
  WriteInPlace(folder_.Path("graph/edges.csv"), "from,to\na,nowhere\n");
  network_.Run(kSeen);
  EXPECT_EQ(Baseline(), over_b_);
  EXPECT_THAT(planner_->last_error(), HasSubstr("edges.csv:2: "));
  WriteInPlace(folder_.Path("graph/edges.csv"), "from,to\na,c\n");
  EXPECT_TRUE(network_.RunUntil(
      [&] {
        return Baseline() == Route{{5, 5}, {55, 5}};
      },
      kSeen));
  EXPECT_EQ(planner_->last_error(), "");
}

}  // namespace
}  // namespace terra
