#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/route_cost.h"

namespace terra::verifier {

/// Outcome of a check. Numbers are those of verdict_t; zero is never accepted.
enum class Code : std::int16_t {
  kNotChecked = 0,
  kAccepted = 1,
  kRetained = 2,
  kFeasible = 3,  ///< Offline only: nothing to compare with.
  kParseError = 10,
  kTooFewWaypoints = 11,
  kStartMismatch = 12,
  kGoalMismatch = 13,
  kOutOfBounds = 20,
  kObstacle = 21,
  kWorkLimit = 22,
  kNotCheaper = 30,   ///< Than the baseline: the paper's non-improving.
  kNotBest = 31,      ///< Cheaper than the baseline, not than what is deployed.
  kBelowMargin = 32,  ///< Cheaper, but by less than the configured margin.
  kStaleRequest = 40,
  kStaleMap = 41,
  kStaleBaseline = 42,
  kLate = 43,
  kBaselineInvalid = 50,
  kMalformedMessage = 51,
};

/// Returns "accepted", "not_cheaper", ... as printed and documented.
std::string_view CodeName(Code code);

/// "Strictly cheaper" means by more than this (paper, Problem Formulation).
inline constexpr double kEpsilon = 1e-6;

/// Returns whether a cost is strictly lower; false for anything not a number.
constexpr bool StrictlyCheaper(double candidate, double than) {
  return candidate < than - kEpsilon;
}

struct VerifyLimits {
  std::size_t max_waypoints = 1'000'000;
  std::int64_t max_steps = 1'000'000'000;
};

/// The limits on the bus.
inline constexpr VerifyLimits kBusLimits = {2'048, 80'000};

/// What a route is worth, and where it fails.
struct RouteCheck {
  Code code = Code::kNotChecked;  ///< kFeasible or the first failing check.
  double cost = kImpassable;      ///< Finite only when kFeasible.
  int segment = -1;               ///< Where it failed, from 0; else -1.
  Cell cell;
  std::int64_t steps = 0;

  bool feasible() const { return code == Code::kFeasible; }
};

/// Checks a route against the map, in a fixed order: structure, end points,
/// geometry in travel order (each waypoint and segment cell inside the map and
/// passable). Bounded by the limits whatever the coordinates.
/// Source: paper, LLM-Advisor (deterministic verification).
RouteCheck CheckRoute(const TerrainMap& map, std::span<const Cell> route,
                      Cell start, Cell goal, const VerifyLimits& limits = {});

/// The paper's decision on one candidate.
struct Comparison {
  Code code = Code::kNotChecked;  ///< kAccepted, kNotCheaper or what failed;
                                  ///< kBaselineInvalid when the baseline fails.
  RouteCheck candidate;
  RouteCheck baseline;

  bool accepted() const { return code == Code::kAccepted; }
};

/// Checks both routes and accepts the candidate only if it is strictly cheaper
/// than a valid baseline.
Comparison CompareRoutes(const TerrainMap& map, Cell start, Cell goal,
                         std::span<const Cell> baseline,
                         std::span<const Cell> candidate,
                         const VerifyLimits& limits = {});

}  // namespace terra::verifier
