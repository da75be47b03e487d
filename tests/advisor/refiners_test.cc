#include "advisor/refiners.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "advisor/controls.h"
#include "advisor/polish.h"
#include "advisor/refiner_backend.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "terrain/segment.h"
#include "tests/advisor/refine_problem.h"
#include "tests/support/ascii_map.h"

namespace terra::advisor {
namespace {

using testing::MapFromAscii;
using testing::Random;
using testing::RandomRefineProblem;
using testing::RefineProblem;

struct Method {
  std::string name;
  std::function<RefineOutput(const RefineInput&)> refine;
};

RefineOutput Campana(const RefineInput& input, CampanaForm form) {
  return RefineByCampana(input, form);
}

// What promises never to be dearer than the baseline.
std::vector<Method> GatedMethods() {
  return {
      {"Search", RefineBySearch},
      {"Shortcut", RefineByShortcut},
      {"Band",
       [](const RefineInput& in) {
         return RefineByBand(in);
       }},
      {"NarrowBand",
       [](const RefineInput& in) {
         return RefineByBand(in, 2);
       }},
      {"CampanaKeepBest",
       [](const RefineInput& in) {
         return Campana(in, CampanaForm::kKeepBest);
       }},
      {"CampanaTerrain",
       [](const RefineInput& in) {
         return Campana(in, CampanaForm::kTerrainWeighted);
       }},
      {"AppStyle", RefineByAppStyle},
      {"BlindDetours", RefineByBlindDetours},
  };
}

// What only promises a route that can be driven.
std::vector<Method> UngatedMethods() {
  return {
      {"CampanaLastIterate",
       [](const RefineInput& in) {
         return Campana(in, CampanaForm::kLastIterate);
       }},
      {"ShortcutWithoutCost", ShortcutWithoutCost},
  };
}

::testing::AssertionResult IsARouteOf(const RefineProblem& problem,
                                      const RefineOutput& output) {
  const auto fail = [&](const std::string& what) {
    return ::testing::AssertionFailure()
           << what << ": " << FormatRoute(output.route) << " at " << output.cost
           << ", baseline " << FormatRoute(problem.baseline) << " at "
           << problem.baseline_cost;
  };
  if (output.route.size() < 2) return fail("too few waypoints");
  if (output.route.front() != problem.baseline.front()) return fail("start");
  if (output.route.back() != problem.baseline.back()) return fail("goal");
  const RouteWalk walk = WalkRoute(problem.map, output.route);
  if (!walk.feasible()) return fail("not feasible");
  if (walk.cost != output.cost) return fail("another cost than it says");
  const double optimum = NativeSearch(problem.map, problem.baseline.front(),
                                      problem.baseline.back())
                             .cost;
  if (output.cost < optimum - 1e-9) return fail("below the native optimum");
  return ::testing::AssertionSuccess();
}

class RefinerTest : public ::testing::TestWithParam<Method> {};

TEST_P(RefinerTest, ReturnsAFeasibleRouteThatIsNeverDearer) {
  Random random(1);
  int improved = 0;
  for (int i = 0; i < 150; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 70);
    const RefineOutput output = GetParam().refine(problem.input());
    ASSERT_TRUE(IsARouteOf(problem, output)) << "problem " << i;
    ASSERT_LE(output.cost, problem.baseline_cost) << "problem " << i;
    improved += output.cost < problem.baseline_cost - 1e-6 ? 1 : 0;
  }
  EXPECT_GT(improved, 10);
}

TEST_P(RefinerTest, ReturnsTheSameRouteAgain) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    EXPECT_EQ(GetParam().refine(problem.input()).route,
              GetParam().refine(problem.input()).route);
  }
}

TEST_P(RefinerTest, ToldToStopStillReturnsARoute) {
  Random random(3);
  std::stop_source stop;
  stop.request_stop();
  for (int i = 0; i < 20; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    RefineInput input = problem.input();
    input.stop = stop.get_token();
    const RefineOutput output = GetParam().refine(input);
    ASSERT_TRUE(IsARouteOf(problem, output));
    ASSERT_LE(output.cost, problem.baseline_cost);
  }
}

TEST_P(RefinerTest, LeavesARouteToTheSameCellAlone) {
  const TerrainMap map = MapFromAscii({"123", "456"});
  const Route stay = {{1, 1}, {1, 1}};
  const RefineOutput output = GetParam().refine({map, stay, 0});
  EXPECT_EQ(output.route, stay);
  EXPECT_EQ(output.cost, 0);
}

INSTANTIATE_TEST_SUITE_P(All, RefinerTest, ::testing::ValuesIn(GatedMethods()),
                         [](const auto& tested) {
                           return tested.param.name;
                         });

class UngatedRefinerTest : public ::testing::TestWithParam<Method> {};

TEST_P(UngatedRefinerTest, ReturnsAFeasibleRoute) {
  Random random(4);
  int dearer = 0;
  for (int i = 0; i < 150; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 70);
    const RefineOutput output = GetParam().refine(problem.input());
    ASSERT_TRUE(IsARouteOf(problem, output)) << "problem " << i;
    dearer += output.cost > problem.baseline_cost + 1e-6 ? 1 : 0;
  }
  // Why a cost gate is needed.
  EXPECT_GT(dearer, 10);
}

INSTANTIATE_TEST_SUITE_P(All, UngatedRefinerTest,
                         ::testing::ValuesIn(UngatedMethods()),
                         [](const auto& tested) {
                           return tested.param.name;
                         });

TEST(RefineBySearchTest, IsTheNativeOptimum) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    const double optimum = NativeSearch(problem.map, problem.baseline.front(),
                                        problem.baseline.back())
                               .cost;
    EXPECT_NEAR(RefineBySearch(problem.input()).cost, optimum, 1e-9);
  }
}

TEST(RefineByBandTest, AsWideAsTheMapIsTheNativeOptimum) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 50);
    const double optimum = NativeSearch(problem.map, problem.baseline.front(),
                                        problem.baseline.back())
                               .cost;
    EXPECT_NEAR(RefineByBand(problem.input(), 50).cost, optimum, 1e-9);
  }
}

TEST(RefineByBandTest, GetsNoDearerInAWiderBand) {
  Random random(7);
  for (int i = 0; i < 50; ++i) {
    const RefineProblem problem = RandomRefineProblem(random, 60);
    double narrower = problem.baseline_cost;
    for (const int half_width : {0, 1, 3, 9, 27}) {
      const double cost = RefineByBand(problem.input(), half_width).cost;
      EXPECT_LE(cost, narrower + 1e-9);
      narrower = cost;
    }
  }
}

// A road of cost 1, six cells wide, around a field of cost 9.
TerrainMap RoadAroundAField() {
  ByteRaster ids = ByteRaster::Constant(41, 81, 1);
  ids.block(6, 6, 29, 69) = 9;
  return TerrainMap::Create(ids, testing::AsciiLegend()).value();
}
const Route kRoad = {{2, 20}, {2, 2}, {40, 2}, {78, 2}, {78, 20}};

TEST(ShortcutTest, StaysOnTheRoadWhereTheStraightLineIsDearer) {
  const TerrainMap map = RoadAroundAField();
  const double cost = WalkRoute(map, kRoad).cost;
  const RefineInput input{map, kRoad, cost};
  for (const auto& refine : {RefineByShortcut, RefineByAppStyle}) {
    const RefineOutput refined = refine(input);
    // Two corners are cut, at 2 - sqrt 2 a diagonal step.
    EXPECT_LT(refined.cost, cost - 4);
    for (const Cell c : RasterizeRoute(refined.route)) {
      EXPECT_EQ(map.Cost(c), 1) << ToString(c);
    }
  }
  EXPECT_GT(ShortcutWithoutCost(input).cost, 2 * cost);
}

TEST(ShortcutTest, TakesTheStraightLineOnOpenGround) {
  const TerrainMap map = MapFromAscii({"11111", "11111", "11111"});
  const Route bent = {{0, 0}, {0, 2}, {4, 2}, {4, 0}};
  for (const auto& refine :
       {RefineByShortcut, RefineByAppStyle, RefineBySearch}) {
    const RefineOutput refined = refine({map, bent, 8});
    EXPECT_DOUBLE_EQ(refined.cost, 4);
    EXPECT_EQ(FormatRoute(refined.route), "[(0, 0), (4, 0)]");
  }
  EXPECT_EQ(FormatRoute(ShortcutWithoutCost({map, bent, 8}).route),
            "[(0, 0), (4, 0)]");
}

double Length(const Route& route) {
  double length = 0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    length +=
        std::hypot(route[i].x - route[i - 1].x, route[i].y - route[i - 1].y);
  }
  return length;
}

TerrainMap OpenGround(int width, int height) {
  ByteRaster ids = ByteRaster::Constant(height, width, 1);
  return TerrainMap::Create(ids, testing::AsciiLegend()).value();
}

TEST(CampanaTest, DrawsTheRouteStraightOnOpenGround) {
  const TerrainMap map = OpenGround(101, 61);
  const Route bent = {{0, 30}, {20, 10}, {50, 50}, {80, 5}, {100, 30}};
  const double cost = WalkRoute(map, bent).cost;
  const RefineOutput last =
      RefineByCampana({map, bent, cost}, CampanaForm::kLastIterate);
  ASSERT_EQ(last.route.size(), bent.size());
  for (const Cell c : last.route) EXPECT_EQ(c.y, 30);
  EXPECT_DOUBLE_EQ(last.cost, 100);
}

TEST(CampanaTest, SlidesAlongAnObstacle) {
  ByteRaster ids = ByteRaster::Constant(61, 101, 1);
  ids.block(20, 40, 41, 20) = 0;  // A block from below up to row 20.
  const TerrainMap map =
      TerrainMap::Create(ids, testing::AsciiLegend()).value();
  const Route around = {{5, 50}, {30, 10}, {50, 2}, {70, 10}, {95, 50}};
  const double cost = WalkRoute(map, around).cost;
  const RefineOutput last =
      RefineByCampana({map, around, cost}, CampanaForm::kLastIterate);
  EXPECT_LT(last.cost, cost);
  EXPECT_LT(Length(last.route), Length(around) - 5);
  // Nobody goes through it.
  EXPECT_GT(Length(last.route), 2 * std::hypot(35, 31) + 18);
}

TEST(CampanaTest, LengthObjectiveLeavesTheRoadAndKeepBestDoesNot) {
  const TerrainMap map = RoadAroundAField();
  const double cost = WalkRoute(map, kRoad).cost;
  const RefineInput input{map, kRoad, cost};
  EXPECT_GT(RefineByCampana(input, CampanaForm::kLastIterate).cost, cost);
  EXPECT_LE(RefineByCampana(input, CampanaForm::kKeepBest).cost, cost);
}

TEST(CampanaTest, CannotMoveARouteWithoutInnerWaypoints) {
  const TerrainMap map = OpenGround(9, 9);
  const Route line = {{0, 0}, {0, 0}, {8, 3}, {8, 3}};
  const double cost = WalkRoute(map, line).cost;
  EXPECT_EQ(RefineByCampana({map, line, cost}, CampanaForm::kLastIterate).route,
            line);
}

TEST(RefinerBackendTest, EachProposesOnlyWhatIsCheaper) {
  Random random(8);
  EXPECT_EQ(RefinerBackendNames(),
            (std::vector<std::string>{"search", "shortcut", "band", "campana",
                                      "app"}));
  for (const std::string& name : RefinerBackendNames()) {
    const auto backend = MakeRefinerBackend(name);
    ASSERT_NE(backend, nullptr);
    EXPECT_EQ(backend->name(), name);
    for (int i = 0; i < 20; ++i) {
      const RefineProblem problem = RandomRefineProblem(random, 50);
      const AdviceAnswer answer = backend->Advise(
          {problem.map, 0, 0, problem.baseline.front(), problem.baseline.back(),
           problem.baseline, problem.baseline_cost},
          {});
      if (answer.kind == AnswerKind::kRetain) {
        EXPECT_TRUE(answer.candidates.empty());
        continue;
      }
      ASSERT_EQ(answer.kind, AnswerKind::kPropose);
      ASSERT_EQ(answer.candidates.size(), 1U);
      EXPECT_LT(WalkRoute(problem.map, answer.candidates[0].route).cost,
                problem.baseline_cost);
    }
  }
  EXPECT_EQ(MakeRefinerBackend("oracle"), nullptr);
}

}  // namespace
}  // namespace terra::advisor
