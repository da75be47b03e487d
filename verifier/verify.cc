#include "verifier/verify.h"

namespace terra::verifier {
namespace {

Code CodeOf(RouteFault fault) {
  switch (fault) {  // GCOVR_EXCL_BR_LINE (There are no other faults.)
    case RouteFault::kNone:
      return Code::kFeasible;
    case RouteFault::kOutOfBounds:
      return Code::kOutOfBounds;
    case RouteFault::kObstacle:
      return Code::kObstacle;
    case RouteFault::kWorkLimit:
      return Code::kWorkLimit;
  }
  return Code::kNotChecked;  // GCOVR_EXCL_LINE
}

RouteCheck Failed(Code code, int segment, Cell cell) {
  RouteCheck check;
  check.code = code;
  check.segment = segment;
  check.cell = cell;
  return check;
}

}  // namespace

std::string_view CodeName(Code code) {
  switch (code) {
    case Code::kNotChecked:
      return "not_checked";
    case Code::kAccepted:
      return "accepted";
    case Code::kRetained:
      return "retained";
    case Code::kFeasible:
      return "feasible";
    case Code::kParseError:
      return "parse_error";
    case Code::kTooFewWaypoints:
      return "too_few_waypoints";
    case Code::kStartMismatch:
      return "start_mismatch";
    case Code::kGoalMismatch:
      return "goal_mismatch";
    case Code::kOutOfBounds:
      return "out_of_bounds";
    case Code::kObstacle:
      return "obstacle";
    case Code::kWorkLimit:
      return "work_limit";
    case Code::kNotCheaper:
      return "not_cheaper";
    case Code::kNotBest:
      return "not_best";
    case Code::kBelowMargin:
      return "below_margin";
    case Code::kStaleRequest:
      return "stale_request";
    case Code::kStaleMap:
      return "stale_map";
    case Code::kStaleBaseline:
      return "stale_baseline";
    case Code::kLate:
      return "late";
    case Code::kBaselineInvalid:
      return "baseline_invalid";
    case Code::kMalformedMessage:
      return "malformed_message";
  }
  return "unknown";
}

RouteCheck CheckRoute(const TerrainMap& map, std::span<const Cell> route,
                      Cell start, Cell goal, const VerifyLimits& limits) {
  if (route.size() < 2) {
    return Failed(Code::kTooFewWaypoints, -1, {});
  }
  if (route.size() > limits.max_waypoints) {
    return Failed(Code::kWorkLimit, -1, {});
  }
  const int last_segment = static_cast<int>(route.size()) - 2;
  if (route.front() != start) {
    return Failed(Code::kStartMismatch, 0, route.front());
  }
  if (route.back() != goal) {
    return Failed(Code::kGoalMismatch, last_segment, route.back());
  }
  const RouteWalk walk = WalkRoute(map, route, limits.max_steps);
  RouteCheck check = Failed(CodeOf(walk.fault), walk.segment, walk.cell);
  check.steps = walk.steps;
  check.cost = walk.cost;
  return check;
}

Comparison CompareRoutes(const TerrainMap& map, Cell start, Cell goal,
                         std::span<const Cell> baseline,
                         std::span<const Cell> candidate,
                         const VerifyLimits& limits) {
  Comparison result;
  result.baseline = CheckRoute(map, baseline, start, goal, limits);
  result.candidate = CheckRoute(map, candidate, start, goal, limits);
  if (!result.baseline.feasible()) {
    result.code = Code::kBaselineInvalid;
  } else if (!result.candidate.feasible()) {
    result.code = result.candidate.code;
  } else {
    result.code = StrictlyCheaper(result.candidate.cost, result.baseline.cost)
                      ? Code::kAccepted
                      : Code::kNotCheaper;
  }
  return result;
}

}  // namespace terra::verifier
