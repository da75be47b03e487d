#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "planner/planner_node.h"
#include "planner/waypoint_graph.h"
#include "terrain/files/file_watch.h"

namespace terra::planner {

/// A planner on a graph of surveyed waypoints, which it reads from nodes.csv
/// and edges.csv, and again when they change: the request in force then gets a
/// new baseline. Files that cannot be read later leave the graph as it is; the
/// heartbeat says why.
class GraphPlannerNode : public PlannerNode {
 public:
  /// `reach`: as PlanOnGraph's.
  GraphPlannerNode(std::string name, std::string folder, int reach,
                   bus::Outbox& out);

  /// Reads the graph. To be called once, before the node runs.
  Status Load();

  bus::Time Advance(bus::Time now) override;
  std::string last_error() const override;
  void AddCounters(bus::Counters& counters) const override;

 private:
  PlanFunction TakePlanFunction();

  std::string folder_;
  int reach_;
  FileWatch watch_;
  std::optional<WaypointGraph> read_;  ///< Not yet in use.
  std::string graph_error_;
  bus::Periodic look_{std::chrono::milliseconds(FileWatch::kPeriodMs)};
  std::int64_t loads_ = 0;
};

}  // namespace terra::planner
