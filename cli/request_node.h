#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/map_receiver.h"
#include "bus/node.h"
#include "bus/time.h"
#include "cli/advisor_watch.h"

namespace terra::cli {

/// What `terra request` asks and how long it waits.
struct RequestPlan {
  std::int64_t request_id = 0;
  Cell start;
  Cell goal;
  std::int64_t map_id = 0;  ///< 0 = the map in force.
  bus::Duration wait{};     ///< For the refined route, or another map.
  bool keep = false;        ///< Go on asking until stopped.
  bool want_map = false;    ///< Wait for the map too: a picture is wanted.
};

/// Asks the running set for a route and follows what becomes of it.
///
/// Repeats PLAN_REQUEST 5 times a second until a BASELINE and a DEPLOYED both
/// name its id. Ends when a candidate is deployed, when an advisor's answer was
/// refused or retained, when all advisors gave up, or when the time is up; and
/// then only with the map, if it is wanted and there is a route to draw on it.
///
/// A request stays current over map updates. So a planner that finds no route
/// has the last word only on the map that the map server offers, and when that
/// has not just changed; until then its next answer is waited for. A baseline
/// is waited for at least 2 s, however short the time for a refined route.
class RequestNode : public bus::Node {
 public:
  RequestNode(const RequestPlan& plan, bus::Outbox& out);

  bus::Time Advance(bus::Time now) override;
  std::string state() const override { return "asking"; }
  bool done() const override { return done_; }

  /// Milliseconds after the first request; nothing where it never came.
  using Latency = std::optional<double>;

  const std::optional<terra_msg::baseline_t>& baseline() const {
    return baseline_;
  }
  const std::optional<terra_msg::deployed_t>& deployed() const {
    return deployed_;
  }
  const std::vector<terra_msg::verdict_t>& verdicts() const {
    return verdicts_;
  }
  /// Did the gate judge any advice on this request, or deploy it?
  bool advised() const;
  /// A route is deployed.
  bool HasRoute() const;
  Latency baseline_ms() const { return baseline_ms_; }
  Latency deployed_ms() const { return deployed_ms_; }
  Latency refined_ms() const { return refined_ms_; }
  const bus::MapReceiver& map() const { return map_; }
  /// The map that the map server offers; 0 = none was heard.
  std::int64_t offered_map_id() const { return offered_map_id_; }
  const AdvisorWatch& advisors() const { return advisors_; }

 private:
  void OnHeader(const terra_msg::map_header_t& message, bus::Time now);
  void OnBaseline(const terra_msg::baseline_t& message, bus::Time now);
  void OnDeployed(const terra_msg::deployed_t& message, bus::Time now);
  void OnVerdict(const terra_msg::verdict_t& message, bus::Time now);
  bool Answered() const;
  bool Refused(bus::Time now) const;
  bool Settled(bus::Time now) const;
  bool TimeIsUp(bus::Time now) const;
  double MillisecondsSinceStart(bus::Time now) const;

  RequestPlan plan_;
  bus::Outbox& out_;
  bus::MapReceiver map_;
  bus::SenderTracker map_server_;
  bus::SenderTracker planner_;
  bus::SenderTracker gate_;
  terra_msg::plan_request_t request_{};
  bus::Periodic repeat_{bus::kStatePeriod};
  bus::Time started_at_ = bus::kNever;
  std::int64_t offered_map_id_ = 0;
  std::optional<terra_msg::baseline_t> baseline_;
  bus::Time baseline_since_{};  ///< Status and map of baseline_ are so old.
  std::optional<terra_msg::deployed_t> deployed_;
  std::vector<terra_msg::verdict_t> verdicts_;
  AdvisorWatch advisors_;
  bus::Time reason_until_{};  ///< Until then a heartbeat may tell the reason.
  Latency baseline_ms_;
  Latency deployed_ms_;
  Latency refined_ms_;
  bool done_ = false;
};

}  // namespace terra::cli
