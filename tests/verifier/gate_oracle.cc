#include "tests/verifier/gate_oracle.h"

namespace terra::verifier {
namespace {

bool AnchorIsAhead(const Observed& now, const Anchor& anchor) {
  const bool named = anchor.session == kTraceOptions.session &&
                     anchor.route_seq == now.deployed.route_seq;
  return (anchor.index == 0 || named) && now.on_route &&
         anchor.index >= static_cast<int>(now.place) &&
         anchor.index < static_cast<int>(now.cells.size());
}

}  // namespace

OracleCheck CheckDeployed(const Observed& now) {
  return OracleCheckRoute(*now.map, now.deployed.waypoints, now.deployed.start,
                          now.deployed.goal);
}

bool SpeaksOfWhatIsInForce(const Observed& now, const AdviceEvent& advice) {
  return advice.request_id != 0 && !now.cancelled() && now.map != nullptr &&
         advice.request_id == now.deployed.request_id &&
         advice.map_id == now.map_id && now.baseline &&
         advice.baseline_digest == now.baseline->baseline_digest;
}

Route Joined(const Observed& now, const AdviceEvent& advice) {
  Route cells(now.cells.begin(), now.cells.begin() + advice.anchor.index);
  for (const Cell& cell : OracleCells(*now.map, advice.waypoints)) {
    cells.push_back(cell);
  }
  if (cells.size() == 1) cells.push_back(cells.front());
  return cells;
}

Code OracleVerdict(const Observed& now, const AdviceEvent& advice) {
  if (!now.baseline_valid()) return Code::kBaselineInvalid;
  if (!AnchorIsAhead(now, advice.anchor)) return Code::kLate;
  if (advice.kind == AdviceKind::kRetain) return Code::kRetained;
  if (advice.kind == AdviceKind::kMalformed) return Code::kParseError;
  const Cell anchor = now.cells[static_cast<std::size_t>(advice.anchor.index)];
  if (advice.anchor.cell != anchor) return Code::kStartMismatch;
  const OracleCheck check =
      OracleCheckRoute(*now.map, advice.waypoints, anchor, now.deployed.goal);
  if (!check.feasible()) return check.code;
  const ExactCost whole =
      OracleCheckRoute(*now.map, Joined(now, advice), now.deployed.start,
                       now.deployed.goal)
          .cost;
  if (!ExactlyCheaper(whole, now.baseline_check.cost)) return Code::kNotCheaper;
  // The way up to the anchor is shared: comparing the wholes compares the rest.
  return ExactlyCheaper(whole, CheckDeployed(now).cost) ? Code::kAccepted
                                                        : Code::kNotBest;
}

}  // namespace terra::verifier
