#include "advisor/refiners.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "advisor/refiner_backend.h"
#include "benchmark/methods/comparison_refiners.h"
#include "benchmark/methods/controls.h"
#include "terrain/native_search.h"
#include "terrain/route_cost.h"
#include "terrain/route_text.h"
#include "tests/advisor/refine_problem.h"
#include "tests/support/ascii_map.h"

namespace terra::advisor {
namespace {

using benchmark::CampanaForm;
using benchmark::RefineByAppStyle;
using benchmark::RefineByBand;
using benchmark::RefineByBlindDetours;
using benchmark::RefineByCampana;
using benchmark::ShortcutWithoutCost;
using benchmark::StraightLine;

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

TEST(RefinerBackendTest, EachProposesOnlyWhatIsCheaper) {
  Random random(8);
  EXPECT_EQ(RefinerBackendNames(),
            (std::vector<std::string>{"search", "shortcut"}));
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
  for (const char* other : {"oracle", "band", "campana", "app"}) {
    EXPECT_EQ(MakeRefinerBackend(other), nullptr) << other;
  }
}

}  // namespace
}  // namespace terra::advisor
