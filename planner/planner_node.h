#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bus/map_receiver.h"
#include "bus/node.h"
#include "bus/request_tracker.h"
#include "planner/coarse_lattice.h"

namespace terra::planner {

/// Plans on a fixed graph, from start to goal. Called with ends of any value.
using PlanFunction =
    std::function<LatticePlan(const TerrainMap& map, Cell start, Cell goal)>;

/// A baseline planner on the bus: listens to map, PLAN_REQUEST, DEPLOYED and
/// VERDICT, publishes BASELINE at once and then 5 times a second. It waits for
/// nobody. A baseline that neither DEPLOYED nor VERDICT names within 10 ms was
/// perhaps lost: it is said again at once, three times at most.
///
/// A planner of one's own is this node with another PlanFunction (see
/// main.cc), or any program that publishes BASELINE.
class PlannerNode : public bus::Node {
 public:
  PlannerNode(std::string name, PlanFunction plan, bus::Outbox& out);

  bus::Time Advance(bus::Time now) override;
  std::string state() const override;
  std::string last_error() const override;
  void AddCounters(bus::Counters& counters) const override;

 protected:
  /// For a planner whose graph has changed: plans the request in force with
  /// another function, now and from now on.
  void PlanWith(PlanFunction plan, bus::Time now);

 private:
  /// The gate has the baseline in hand: it names it.
  void OnAnswer(std::int64_t request_id, std::int64_t map_id,
                std::int64_t baseline_digest);
  void SayAgain(bus::Time now);
  void OnDeployed(const terra_msg::deployed_t& message, bus::Time now);
  void OnRequestChanged(bus::Time now);
  void Plan(bus::Time now);
  void FillBaseline(const RequestInForce& request);
  void FillRoute(const LatticePlan& plan);

  std::string name_;
  PlanFunction plan_;
  bus::Outbox& out_;
  bus::MapReceiver map_;
  bus::RequestTracker requests_;
  bus::SenderTracker gate_;
  terra_msg::baseline_t baseline_{};
  bool has_baseline_ = false;
  bus::Periodic repeat_{bus::kStatePeriod};
  // When a baseline that no answer names is said again; kNever once one does.
  bus::Time unanswered_at_ = bus::kNever;
  int quick_repeats_ = 0;
  std::int64_t all_quick_repeats_ = 0;
  // When to say that there is no map; kNever once there is one.
  bus::Time no_map_at_ = bus::kNever;
  bus::Time planned_at_{};
  std::int64_t plans_ = 0;
};

}  // namespace terra::planner
