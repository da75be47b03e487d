#include "verifier/verify.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/ascii_map.h"
#include "tests/support/random_map.h"

namespace terra::verifier {
namespace {

using testing::MapFromAscii;
using testing::Random;
using testing::RandomMap;
using testing::RandomMapKind;

constexpr int kHuge = std::numeric_limits<int>::max();
constexpr int kTiny = std::numeric_limits<int>::min();

const TerrainMap& Field() {
  static const TerrainMap map = MapFromAscii({"111111", "19#991", "111111"});
  return map;
}
constexpr Cell kStart{0, 1};
constexpr Cell kGoal{5, 1};

struct Case {
  const char* name;
  Route route;
  Code code;
  int segment;
  Cell cell;
};

// ---- One table of what a route can be wrong in. ----

TEST(CheckRouteTest, NamesTheFirstFailingCheckAndWhere) {
  const Case cases[] = {
      {"empty", {}, Code::kTooFewWaypoints, -1, {}},
      {"one waypoint", {kStart}, Code::kTooFewWaypoints, -1, {}},
      {"other start", {{1, 1}, kGoal}, Code::kStartMismatch, 0, {1, 1}},
      {"other goal", {kStart, {0, 0}, {4, 1}}, Code::kGoalMismatch, 1, {4, 1}},
      {"both ends: the start counts",
       {{1, 1}, {4, 1}},
       Code::kStartMismatch,
       0,
       {1, 1}},
      {"above", {kStart, {1, -1}, kGoal}, Code::kOutOfBounds, 0, {1, -1}},
      {"left", {kStart, {-1, 1}, kGoal}, Code::kOutOfBounds, 0, {-1, 1}},
      {"right", {kStart, {0, 0}, {6, 0}, kGoal}, Code::kOutOfBounds, 1, {6, 0}},
      {"below", {kStart, {0, 3}, kGoal}, Code::kOutOfBounds, 0, {0, 3}},
      {"far outside",
       {kStart, {0, 0}, {kHuge, 0}, kGoal},
       Code::kOutOfBounds,
       1,
       {6, 0}},
      {"the other end of the numbers",
       {kStart, {kTiny, 1}, kGoal},
       Code::kOutOfBounds,
       0,
       {-1, 1}},
      {"obstacle between waypoints",
       {kStart, kGoal},
       Code::kObstacle,
       0,
       {2, 1}},
      {"obstacle at a waypoint",
       {kStart, {2, 0}, {2, 1}, kGoal},
       Code::kObstacle,
       1,
       {2, 1}},
      {"obstacle before the edge, in travel order",
       {kStart, {2, 1}, {9, 9}, kGoal},
       Code::kObstacle,
       0,
       {2, 1}},
  };
  for (const Case& c : cases) {
    const RouteCheck check = CheckRoute(Field(), c.route, kStart, kGoal);
    EXPECT_EQ(CodeName(check.code), CodeName(c.code)) << c.name;
    EXPECT_EQ(check.segment, c.segment) << c.name;
    EXPECT_EQ(check.cell, c.cell) << c.name;
    EXPECT_FALSE(check.feasible()) << c.name;
    EXPECT_EQ(check.cost, kImpassable) << c.name;
  }
}

TEST(CheckRouteTest, FeasibleRouteHasItsCostAndSteps) {
  const Route route = {kStart, {1, 0}, {4, 0}, kGoal};
  const RouteCheck check = CheckRoute(Field(), route, kStart, kGoal);
  EXPECT_EQ(check.code, Code::kFeasible);
  EXPECT_DOUBLE_EQ(check.cost, 3 + 2 * std::numbers::sqrt2);
  EXPECT_EQ(check.steps, 5);
  EXPECT_EQ(check.segment, -1);
}

TEST(CheckRouteTest, StartEqualToGoalIsARouteOfTwoWaypoints) {
  const RouteCheck check =
      CheckRoute(Field(), Route{kStart, kStart}, kStart, kStart);
  EXPECT_EQ(check.code, Code::kFeasible);
  EXPECT_EQ(check.cost, 0);
  EXPECT_EQ(CheckRoute(Field(), Route{kStart}, kStart, kStart).code,
            Code::kTooFewWaypoints);
}

TEST(CheckRouteTest, RepeatedWaypointsAreFree) {
  const Route once = {kStart, {0, 0}, {5, 0}, kGoal};
  const Route often = {kStart, kStart, {0, 0}, {0, 0}, {5, 0}, kGoal, kGoal};
  EXPECT_EQ(CheckRoute(Field(), often, kStart, kGoal).cost,
            CheckRoute(Field(), once, kStart, kGoal).cost);
}

TEST(CheckRouteTest, BlockedStartFailsEvenWhenItMatches) {
  const RouteCheck check =
      CheckRoute(Field(), Route{{2, 1}, kGoal}, {2, 1}, kGoal);
  EXPECT_EQ(check.code, Code::kObstacle);
  EXPECT_EQ(check.segment, 0);
}

TEST(CheckRouteTest, WaypointLimitIsExact) {
  VerifyLimits limits;
  limits.max_waypoints = 4;
  const Route four = {kStart, {0, 0}, {5, 0}, kGoal};
  const Route five = {kStart, {0, 0}, {5, 0}, kGoal, kGoal};
  EXPECT_TRUE(CheckRoute(Field(), four, kStart, kGoal, limits).feasible());
  EXPECT_EQ(CheckRoute(Field(), five, kStart, kGoal, limits).code,
            Code::kWorkLimit);
}

TEST(CheckRouteTest, StepLimitIsExact) {
  VerifyLimits limits;
  limits.max_steps = 7;
  const Route seven = {kStart, {0, 0}, {5, 0}, kGoal};
  EXPECT_TRUE(CheckRoute(Field(), seven, kStart, kGoal, limits).feasible());
  limits.max_steps = 6;
  EXPECT_EQ(CheckRoute(Field(), seven, kStart, kGoal, limits).code,
            Code::kWorkLimit);
}

TEST(CheckRouteTest, TheBusAllows2048WaypointsAnd80000Steps) {
  EXPECT_EQ(kBusLimits.max_waypoints, 2'048u);
  EXPECT_EQ(kBusLimits.max_steps, 80'000);
}

// ---- Costs. ----

TEST(StrictlyCheaperTest, MeansByMoreThanEpsilon) {
  EXPECT_TRUE(StrictlyCheaper(10 - 1.1e-6, 10));
  EXPECT_FALSE(StrictlyCheaper(10 - 0.9e-6, 10));
  EXPECT_FALSE(StrictlyCheaper(10, 10));
  EXPECT_FALSE(StrictlyCheaper(10 + 1.1e-6, 10));
}

TEST(StrictlyCheaperTest, NothingThatIsNotANumberIsCheaper) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(StrictlyCheaper(nan, 10));
  EXPECT_FALSE(StrictlyCheaper(1, nan));
  EXPECT_FALSE(StrictlyCheaper(kImpassable, kImpassable));
  EXPECT_TRUE(StrictlyCheaper(1, kImpassable));
}

// ---- The paper's decision. ----

TEST(CompareRoutesTest, AcceptsOnlyTheStrictlyCheaperCandidate) {
  const TerrainMap map = MapFromAscii({"111", "191", "111"});
  const Route through = {{0, 1}, {2, 1}};
  const Route around = {{0, 1}, {1, 0}, {2, 1}};
  const auto code = [&map](const Route& baseline, const Route& candidate) {
    return CompareRoutes(map, {0, 1}, {2, 1}, baseline, candidate).code;
  };
  EXPECT_EQ(code(through, around), Code::kAccepted);
  EXPECT_EQ(code(around, through), Code::kNotCheaper);
  EXPECT_EQ(code(around, around), Code::kNotCheaper);
}

// Two ways through one cell that differs from the others by a little.
TEST(CompareRoutesTest, BothSidesOfEpsilonOnAMap) {
  const auto code = [](double gain) {
    ByteRaster ids(2, 2);
    ids << 0, 1, 0, 0;
    Legend legend = Legend::Create({{0, "ground", 1, {0, 0, 0}},
                                    {1, "better", 1 - gain, {1, 1, 1}}})
                        .value();
    const TerrainMap map = TerrainMap::Create(ids, std::move(legend)).value();
    const Route below = {{0, 0}, {0, 1}, {1, 1}};
    const Route above = {{0, 0}, {1, 0}, {1, 1}};
    return CompareRoutes(map, {0, 0}, {1, 1}, below, above).code;
  };
  EXPECT_EQ(code(1.1e-6), Code::kAccepted);
  EXPECT_EQ(code(0.9e-6), Code::kNotCheaper);
}

TEST(CompareRoutesTest, NothingIsAcceptedAgainstAnInvalidBaseline) {
  const Route around = {kStart, {1, 0}, {4, 0}, kGoal};
  const Comparison result =
      CompareRoutes(Field(), kStart, kGoal, Route{kStart, kGoal}, around);
  EXPECT_EQ(result.code, Code::kBaselineInvalid);
  EXPECT_FALSE(result.accepted());
  EXPECT_TRUE(result.candidate.feasible());
  EXPECT_EQ(result.baseline.code, Code::kObstacle);
}

TEST(CompareRoutesTest, AnInfeasibleCandidateKeepsItsOwnCode) {
  const Route around = {kStart, {1, 0}, {4, 0}, kGoal};
  EXPECT_EQ(
      CompareRoutes(Field(), kStart, kGoal, around, Route{kStart, kGoal}).code,
      Code::kObstacle);
}

// ---- Codes. ----

TEST(CodeNameTest, EveryCodeHasItsOwnName) {
  const std::pair<Code, const char*> names[] = {
      {Code::kNotChecked, "not_checked"},
      {Code::kAccepted, "accepted"},
      {Code::kRetained, "retained"},
      {Code::kFeasible, "feasible"},
      {Code::kParseError, "parse_error"},
      {Code::kTooFewWaypoints, "too_few_waypoints"},
      {Code::kStartMismatch, "start_mismatch"},
      {Code::kGoalMismatch, "goal_mismatch"},
      {Code::kOutOfBounds, "out_of_bounds"},
      {Code::kObstacle, "obstacle"},
      {Code::kWorkLimit, "work_limit"},
      {Code::kNotCheaper, "not_cheaper"},
      {Code::kNotBest, "not_best"},
      {Code::kBelowMargin, "below_margin"},
      {Code::kStaleRequest, "stale_request"},
      {Code::kStaleMap, "stale_map"},
      {Code::kStaleBaseline, "stale_baseline"},
      {Code::kLate, "late"},
      {Code::kBaselineInvalid, "baseline_invalid"},
      {Code::kMalformedMessage, "malformed_message"},
  };
  for (const auto& [code, name] : names) {
    EXPECT_EQ(CodeName(code), name);
  }
  EXPECT_EQ(CodeName(static_cast<Code>(1'000)), "unknown");
  EXPECT_EQ(RouteCheck{}.code, Code::kNotChecked);
  EXPECT_FALSE(Comparison{}.accepted());
}

// ---- A second, naive reading of the rules. ----

struct NaiveResult {
  Code code = Code::kFeasible;
  double cost = 0;
};

NaiveResult NaiveCheck(const TerrainMap& map, const Route& route, Cell start,
                       Cell goal) {
  if (route.size() < 2) return {Code::kTooFewWaypoints, 0};
  if (!(route.front() == start)) return {Code::kStartMismatch, 0};
  if (!(route.back() == goal)) return {Code::kGoalMismatch, 0};
  NaiveResult result;
  std::optional<Cell> previous;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    int e_x = std::abs(route[i + 1].x - route[i].x);
    int e_y = -std::abs(route[i + 1].y - route[i].y);
    int e = e_x + e_y;
    Cell at = route[i];
    for (;;) {
      if (at.x < 0 || at.y < 0 || at.x >= map.width() || at.y >= map.height()) {
        return {Code::kOutOfBounds, 0};
      }
      const double cost = map.legend().Find(map.ids()(at.y, at.x))->cost;
      if (std::isinf(cost)) return {Code::kObstacle, 0};
      if (previous && !(*previous == at)) {
        result.cost +=
            cost * std::hypot(at.x - previous->x, at.y - previous->y);
      }
      previous = at;
      if (at == route[i + 1]) break;
      const int e2 = 2 * e;
      if (e2 >= e_y) {
        e += e_y;
        at.x += route[i].x < route[i + 1].x ? 1 : -1;
      }
      if (e2 <= e_x) {
        e += e_x;
        at.y += route[i].y < route[i + 1].y ? 1 : -1;
      }
    }
  }
  return result;
}

TEST(CheckRouteTest, AgreesWithANaiveReadingOnRandomMaps) {
  Random random(20);
  std::set<Code> seen;
  for (int i = 0; i < 3'000; ++i) {
    const TerrainMap map =
        RandomMap(random, random.Int(2, 24), random.Int(2, 24),
                  static_cast<RandomMapKind>(random.Int(0, 2)));
    const auto cell = [&] {
      return random.OneIn(25) ? Cell{random.Int(-3, 27), random.Int(-3, 27)}
                              : Cell{random.Int(0, map.width() - 1),
                                     random.Int(0, map.height() - 1)};
    };
    const Cell start = cell();
    const Cell goal = cell();
    Route route = {start};
    for (int k = random.Int(0, 3); k > 0; --k) {
      route.push_back(cell());
    }
    if (!random.OneIn(20)) route.push_back(goal);
    if (random.OneIn(20)) route.front() = cell();
    const RouteCheck check = CheckRoute(map, route, start, goal);
    const NaiveResult naive = NaiveCheck(map, route, start, goal);
    ASSERT_EQ(CodeName(check.code), CodeName(naive.code)) << i;
    if (check.feasible()) {
      ASSERT_NEAR(check.cost, naive.cost, 1e-9 * (1 + naive.cost)) << i;
    }
    seen.insert(check.code);
  }
  EXPECT_EQ(seen, (std::set{Code::kTooFewWaypoints, Code::kStartMismatch,
                            Code::kGoalMismatch, Code::kOutOfBounds,
                            Code::kObstacle, Code::kFeasible}));
}

}  // namespace
}  // namespace terra::verifier
