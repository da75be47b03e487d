#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "terrain/driven_route.h"
#include "terrain/map.h"
#include "terrain/request_in_force.h"
#include "verifier/gate_memory.h"
#include "verifier/gate_messages.h"
#include "verifier/verify.h"

namespace terra::verifier {

struct GateOptions {
  /// A candidate must beat the deployed route by more than this, in cost.
  double margin = 0;
  /// The session that DEPLOYED is sent under (in a replay: was sent under).
  /// Anchors and poses name it; with 0 only advice from the start on can be
  /// accepted.
  std::int64_t session = 0;
};

/// What the gate counted; monotone within a session.
struct GateCounters {
  std::int64_t judged = 0;
  std::int64_t accepted = 0;
  std::int64_t repeats = 0;        ///< Advice that already has its verdict.
  std::int64_t unknown_key = 0;    ///< Advice for what the gate does not hold.
  std::int64_t failed_advice = 0;  ///< Advisors that had no answer.
  std::int64_t invalid_baselines = 0;
  std::int64_t other_baselines = 0;  ///< For another request or map.
  std::int64_t other_poses = 0;      ///< On a route that is not in force.
};

/// What a gate goes on from: all that decides, but for its memories.
struct GateState {
  RequestInForce request;
  std::int64_t answered_by = 0;  ///< As RequestRule has it.
  std::shared_ptr<const TerrainMap> map;
  std::int64_t map_id = 0;
  std::optional<BaselineEvent> baseline;
  Deployed deployed;
  int place = -1;  ///< Index on the route, -1 without one.
  bool on_route = true;
  std::int64_t decisions = 0;
};

/// Decides what is deployed: a state machine over events, without clock, I/O or
/// unbounded memory. The same events in the same order give the same decisions.
///
/// docs/gate.md states its rules and the invariants that the tests hold it to.
/// Threads: one.
class Gate {
 public:
  // (gcc counts what may throw in it as branches.)
  explicit Gate(GateOptions options = {})
      : options_(options) {}  // GCOVR_EXCL_BR_LINE

  /// A gate in a state that another one was in, with empty memories. Nothing
  /// where no gate can be in this state: a route that is not feasible on the
  /// map, a place that is not on it.
  static std::optional<Gate> GoOnFrom(const GateOptions& options,
                                      const GateState& state);

  Decisions On(const MapEvent& event);
  Decisions On(const RequestEvent& event);
  Decisions On(const BaselineEvent& event);
  Decisions On(const AdviceEvent& event);
  Decisions On(const PoseEvent& event);  ///< Never decides anything by itself.

  /// As On, where the memories say this of the advice, whatever they hold: for
  /// a gate whose memories lack what another one's had.
  Decisions OnGiven(const AdviceEvent& event, Lookup lookup);

  /// Returns whether advice would get a verdict now. Else it is a repeat,
  /// speaks of what the gate does not know, or needs none, and costs no walk of
  /// a map.
  bool WouldJudge(const AdviceEvent& event) const;

  /// What is in force, to be repeated while it is; request_id 0 = nothing yet.
  const Deployed& deployed() const { return deployed_; }
  /// The deployed route and how far the robot has come along it.
  const DrivenRoute& driven() const { return driven_; }
  const GateCounters& counters() const { return counters_; }
  bool has_map() const { return map_ != nullptr; }

  // ---- The core, for its digest and the journal. ----

  const RequestInForce& request() const { return requests_.current(); }
  std::int64_t answered_by() const { return requests_.answered_by(); }
  std::int64_t map_id() const { return map_id_; }
  /// The baseline that is held; null = none.
  const BaselineEvent* baseline() const {
    return baseline_ ? &baseline_->message : nullptr;
  }
  std::int64_t decisions() const { return decisions_; }
  /// What the memories said of the last event.
  Lookup lookup() const { return lookup_; }
  /// How many requests were remembered so far. A cancel may add one and change
  /// nothing else.
  std::int64_t num_remembered() const { return requests_.num_remembered(); }
  /// The memory of what was judged never had to forget anything.
  bool remembers_all_judged() const { return judged_.remembers_all(); }

 private:
  // The baseline of the current request, with what the gate found about it.
  struct HeldBaseline {
    BaselineEvent message;
    RouteCheck check;
  };

  struct PricedRoute {
    Route waypoints;
    double cost = kImpassable;
  };

  void OnChange(RequestRule::Change change, Decisions& out);

  bool Holds(const BaselineEvent& event) const;
  void DropBaseline();
  RouteCheck CheckBaseline(const BaselineEvent& event) const;
  void OnNoRoute(Decisions& out);
  void OnBadBaseline(Decisions& out);
  void ReportBaseline(Decisions& out);
  bool baseline_valid() const {
    return baseline_ && baseline_->check.feasible();
  }
  void RecheckBaseline(Decisions& out);
  void RecheckDeployed(Decisions& out);

  void Deploy(Deployed next, Decisions& out);
  void DeployBaseline(Cause cause, Decisions& out);
  void DeployNothing(Mode mode, Cause cause, Decisions& out);
  void KeepOnNewMap(double cost, Decisions& out);

  // The verdict's code so far: kNotChecked = the key matches what is in force;
  // nothing = the gate does not know what the advice speaks of.
  std::optional<Code> CheckKey(const AdviceEvent& event) const;
  std::optional<Code> IfReplaced(bool remembered, Code stale) const;
  // Fills in what the verdict says; the whole route when it is accepted.
  std::optional<PricedRoute> Judge(const AdviceEvent& event,
                                   Verdict& verdict) const;
  std::optional<PricedRoute> JudgeProposal(const AdviceEvent& event,
                                           Verdict& verdict) const;
  bool AnchorInForce(const Anchor& anchor) const;
  bool InForce(std::int64_t session, std::int64_t route_seq) const;
  Deployed Upgrade(const AdviceEvent& event, PricedRoute route) const;

  GateOptions options_;
  std::shared_ptr<const TerrainMap> map_;
  std::int64_t map_id_ = 0;
  RequestRule requests_;
  std::optional<HeldBaseline> baseline_;
  Deployed deployed_;
  DrivenRoute driven_;  // follows deployed_
  std::int64_t decisions_ = 0;
  ReplacedIds replaced_maps_{64};
  ReplacedIds replaced_baselines_{256};
  // The advice bus lets 200 messages a second through, each repeated once a
  // second: room for 20 s of a flood between two repetitions.
  JudgedAdvice judged_{4'096};
  GateCounters counters_;
  Lookup lookup_ = Lookup::kNone;
  std::optional<Lookup> given_;  // Instead of what the memories say.
};

}  // namespace terra::verifier
