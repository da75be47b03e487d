#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "verifier/verify.h"

namespace terra::verifier {

// ---- Events: what the shell takes off the bus, lengths already checked. ----

/// A complete map came into force.
struct MapEvent {
  std::shared_ptr<const TerrainMap> map;
  std::int64_t map_id = 0;
};

/// PLAN_REQUEST.
struct RequestEvent {
  std::int64_t request_id = 0;
  bool cancel = false;
  Cell start;
  Cell goal;
};

/// BASELINE, of the planner session in force (the shell drops replaced ones).
struct BaselineEvent {
  std::int64_t session = 0;
  std::string planner;
  std::int64_t request_id = 0;
  Cell start;
  Cell goal;
  std::int64_t map_id = 0;
  bool cancelled = false;  ///< The planner carries a cancelled request on.
  bool has_route = false;  ///< Status OK; else the planner found none.
  std::int64_t baseline_digest = 0;
  Route waypoints;
};

/// Where a proposal starts: an index into the dense cells of a deployed route.
struct Anchor {
  std::int64_t session = 0;
  std::int64_t route_seq = 0;
  std::int32_t index = 0;
  Cell cell;
};

/// What kind of answer an advisor has. Numbers are those of advice_t.
enum class AdviceKind : std::int8_t {
  kNone = 0,
  kRetain = 1,
  kPropose = 2,
  kMalformed = 3,
  kFailed = 4,
};

/// ADVICE.
struct AdviceEvent {
  std::int64_t session = 0;
  std::string advisor;
  std::int64_t attempt = 0;
  std::int32_t candidate = 0;
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  Anchor anchor;
  AdviceKind kind = AdviceKind::kNone;
  Route waypoints;
};

// ---- Decisions: what the shell publishes. ----

/// Numbers are those of deployed_t.
enum class Mode : std::int8_t {
  kNone = 0,
  kBaseline = 1,
  kCandidate = 2,
  kHold = 3,
};
enum class Cause : std::int8_t {
  kNone = 0,
  kNewRequest = 1,
  kNewBaseline = 2,
  kUpgrade = 3,
  kMapUpdate = 4,
  kRevertBlocked = 5,
  kRevertNotCheaper = 6,
  kBaselineInvalid = 7,
  kCancelled = 8,
  kNoRoute = 9,
};

/// DEPLOYED.
struct Deployed {
  std::int64_t decision = 0;
  std::int64_t route_seq = 0;
  std::int64_t request_id = 0;
  Cell start;
  Cell goal;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  Mode mode = Mode::kNone;
  Cause cause = Cause::kNone;
  std::string source;
  std::int64_t source_session = 0;
  std::int64_t source_attempt = 0;
  std::int32_t source_candidate = 0;
  Route waypoints;                     ///< Empty in modes none and hold.
  double cost = kImpassable;           ///< Recomputed here.
  double baseline_cost = kImpassable;  ///< Recomputed here.

  bool has_route() const {
    return mode == Mode::kBaseline || mode == Mode::kCandidate;
  }
  friend bool operator==(const Deployed&, const Deployed&) = default;
};

enum class Subject : std::int8_t { kAdvice = 1, kBaseline = 2 };

/// VERDICT.
struct Verdict {
  std::int64_t decision = 0;
  Subject subject = Subject::kAdvice;
  std::int64_t request_id = 0;
  std::int64_t map_id = 0;
  std::int64_t baseline_digest = 0;
  Anchor anchor;
  std::string advisor;
  std::int64_t advisor_session = 0;
  std::int64_t attempt = 0;
  std::int32_t candidate = 0;
  Code code = Code::kNotChecked;
  double candidate_cost = kImpassable;
  double baseline_cost = kImpassable;
  double cost_to_beat = kImpassable;
  std::int64_t route_seq_before = 0;
  int fail_segment = -1;
  Cell fail_cell;
};

using Decision = std::variant<Verdict, Deployed>;
using Decisions = std::vector<Decision>;

struct GateOptions {
  /// A candidate must beat the deployed route by more than this, in cost.
  double margin = 0;
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
};

/// Decides what is deployed: a state machine over events, without clock, I/O or
/// unbounded memory. The same events in the same order give the same decisions.
///
/// docs/gate.md states its rules and the invariants that the tests hold it to.
/// Threads: one.
class Gate {
 public:
  explicit Gate(GateOptions options = {}) : options_(options) {}

  Decisions On(const MapEvent& event);
  Decisions On(const RequestEvent& event);
  Decisions On(const BaselineEvent& event);
  Decisions On(const AdviceEvent& event);

  /// What is in force, to be repeated while it is; request_id 0 = nothing yet.
  const Deployed& deployed() const { return deployed_; }
  const GateCounters& counters() const { return counters_; }
  bool has_map() const { return map_ != nullptr; }

 private:
  // A bounded memory of ids that were replaced.
  class Replaced {
   public:
    explicit Replaced(std::size_t capacity) : capacity_(capacity) {}
    void Add(std::int64_t id);
    bool Has(std::int64_t id) const;

   private:
    std::size_t capacity_;
    std::deque<std::int64_t> ids_;
  };

  struct Request {
    std::int64_t id = 0;
    bool cancelled = false;
    Cell start;
    Cell goal;
  };

  // The baseline of the current request, with what the gate found about it.
  struct HeldBaseline {
    BaselineEvent message;
    RouteCheck check;
  };

  // (request, map, baseline, session, attempt, candidate)
  using AdviceKey = std::tuple<std::int64_t, std::int64_t, std::int64_t,
                               std::int64_t, std::int64_t, std::int32_t>;

  void Replace(const Request& request, Decisions& out);
  void DropBaseline();
  bool Adopt(const BaselineEvent& event, Decisions& out);
  RouteCheck CheckBaseline(const BaselineEvent& event) const;
  void Deploy(Deployed next, Decisions& out);
  void DeployBaseline(Cause cause, Decisions& out);
  void DeployNothing(Mode mode, Cause cause, Decisions& out);
  void ReportBaseline(Decisions& out);
  void OnBadBaseline(Decisions& out);

  /// The verdict's code so far: kNotChecked = the key matches what is in force;
  /// nothing = the gate does not know what the advice speaks of.
  std::optional<Code> CheckKey(const AdviceEvent& event) const;
  bool WasJudged(const AdviceEvent& event);
  void Judge(const AdviceEvent& event, Verdict& verdict) const;
  Deployed Upgrade(const AdviceEvent& event, double cost) const;

  GateOptions options_;
  std::shared_ptr<const TerrainMap> map_;
  std::int64_t map_id_ = 0;
  Request request_;
  std::optional<HeldBaseline> baseline_;
  // The planner session that last named the current request.
  std::int64_t answered_by_ = 0;
  Deployed deployed_;
  std::int64_t decisions_ = 0;
  Replaced replaced_requests_{64};
  Replaced replaced_maps_{64};
  Replaced replaced_baselines_{256};
  std::set<AdviceKey> judged_;
  std::deque<AdviceKey> judged_order_;
  GateCounters counters_;
};

}  // namespace terra::verifier
