#include "planner/graph_planner_node.h"

#include <algorithm>
#include <utility>

#include "planner/graph_file.h"

namespace terra::planner {
namespace {

// Until there is a graph no plan is asked for.
LatticePlan NoPlan(const TerrainMap& /*map*/, Cell /*start*/, Cell /*goal*/) {
  return {};
}

}  // namespace

GraphPlannerNode::GraphPlannerNode(std::string name, std::string folder,
                                   int reach, bus::Outbox& out)
    : PlannerNode(std::move(name), NoPlan, out),
      folder_(std::move(folder)),
      reach_(reach),
      watch_([this]() -> Status {
        Result<WaypointGraph> graph = ReadWaypointGraph(folder_);
        if (!graph.ok()) return graph.error();
        read_ = *std::move(graph);
        return Done{};
      }) {}

Status GraphPlannerNode::Load() {
  Status loaded = watch_.Begin();
  if (loaded.ok()) PlanWith(TakePlanFunction(), {});
  return loaded;
}

PlanFunction GraphPlannerNode::TakePlanFunction() {
  ++loads_;
  return [graph = *std::exchange(read_, std::nullopt), reach = reach_](
             const TerrainMap& map, Cell start, Cell goal) {
    return PlanOnGraph(map, graph, start, goal, reach);
  };
}

bus::Time GraphPlannerNode::Advance(bus::Time now) {
  if (look_.Due(now)) {
    if (const std::optional<Status> loaded = watch_.Look()) {
      graph_error_ =
          loaded->ok() ? "" : "graph not reloaded: " + loaded->error().message;
      if (loaded->ok()) PlanWith(TakePlanFunction(), now);
    }
  }
  return std::min(look_.next(), PlannerNode::Advance(now));
}

std::string GraphPlannerNode::last_error() const {
  return graph_error_.empty() ? PlannerNode::last_error() : graph_error_;
}

void GraphPlannerNode::AddCounters(bus::Counters& counters) const {
  PlannerNode::AddCounters(counters);
  counters.emplace_back("graph_loads", loads_);
}

}  // namespace terra::planner
