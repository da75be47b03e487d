#include "advisor/refiners.h"
#include "benchmark/speed/works.h"
#include "planner/coarse_lattice.h"
#include "terrain/native_search.h"
#include "terrain/require.h"
#include "terrain/segment.h"
#include "verifier/verify.h"

namespace terra::benchmark {
namespace {

// Baseline, native search below its cost, both routes verified and compared.
void RunChain(const SpeedCase& c) {
  const planner::LatticePlan plan =
      planner::PlanOnLattice(c.map, c.start, c.goal);
  const SearchResult found =
      NativeSearch(c.map, c.start, c.goal, {.upper_bound = plan.cost});
  const verifier::Comparison compared = verifier::CompareRoutes(
      c.map, c.start, c.goal, plan.waypoints, CornersOf(found.cells));
  TERRA_REQUIRE(compared.candidate.feasible() && compared.baseline.feasible() &&
                compared.candidate.cost <= compared.baseline.cost);
}

}  // namespace

std::vector<TimedSample> TimeChain(const SpeedCase& c, int rounds) {
  const planner::LatticePlan plan =
      planner::PlanOnLattice(c.map, c.start, c.goal);
  const auto steps = static_cast<double>(
      verifier::CheckRoute(c.map, plan.waypoints, c.start, c.goal).steps);
  return TimeInterleaved(
      {
          {.name = "lattice r=50",
           .run =
               [&] {
                 TERRA_REQUIRE(
                     planner::PlanOnLattice(c.map, c.start, c.goal).cost ==
                     plan.cost);
               },
           .calls = 20},
          {.name = "verify",
           .run =
               [&] {
                 TERRA_REQUIRE(verifier::CheckRoute(c.map, plan.waypoints,
                                                    c.start, c.goal)
                                   .cost == plan.cost);
               },
           .calls = 200,
           .amount = steps},
          {.name = "shortcut",
           .run =
               [&] {
                 TERRA_REQUIRE(advisor::RefineByShortcut(
                                   {c.map, plan.waypoints, plan.cost})
                                   .cost <= plan.cost);
               }},
          {.name = "baseline, search, verify",
           .run =
               [&] {
                 RunChain(c);
               }},
      },
      rounds);
}

}  // namespace terra::benchmark
