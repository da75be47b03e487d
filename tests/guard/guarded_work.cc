// Does one piece of work on fixed maps, for its instructions to be counted
// (count_instructions.py). Usage: guarded_work buckets|sweep|lattice|verify
//
// Only what happens inside TerraGuardedWork is counted. Vectors are those of
// the portable build, so that counts do not depend on the processor.

#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "benchmark/map_generator.h"
#include "planner/coarse_lattice.h"
#include "terrain/native_search.h"
#include "terrain/require.h"
#include "verifier/verify.h"

using terra::benchmark::GeneratedCase;

extern "C" [[gnu::noinline]] double TerraGuardedWork(
    const std::function<double()>& work) {
  return work();
}

namespace terra {
namespace {

struct Fixture {
  GeneratedCase drawn;
  planner::LatticePlan plan;
};

std::vector<Fixture> MakeFixtures() {
  using benchmark::Subset;
  std::vector<Fixture> fixtures;
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    GeneratedCase drawn = benchmark::GenerateCase(
        subset, 1, 0, benchmark::CalibratedParameters(subset));
    planner::LatticePlan plan =
        planner::PlanOnLattice(drawn.map, drawn.start, drawn.goal);
    fixtures.push_back({std::move(drawn), std::move(plan)});
  }
  return fixtures;
}

double SearchCost(NativeSearcher& searcher, const Fixture& f,
                  SearchMethod method) {
  return searcher
      .Search(f.drawn.map, f.drawn.start, f.drawn.goal,
              {.method = method, .instructions = InstructionSet::kPortable})
      .cost;
}

using Work = std::function<double(const Fixture&)>;

std::map<std::string, Work> AllWorks(NativeSearcher& searcher) {
  return {
      {"buckets",
       [&searcher](const Fixture& f) {
         return SearchCost(searcher, f, SearchMethod::kBuckets);
       }},
      {"sweep",
       [&searcher](const Fixture& f) {
         return SearchCost(searcher, f, SearchMethod::kSweep);
       }},
      {"lattice",
       [](const Fixture& f) {
         return planner::PlanOnLattice(f.drawn.map, f.drawn.start, f.drawn.goal)
             .cost;
       }},
      {"verify",
       [](const Fixture& f) {
         return verifier::CheckRoute(f.drawn.map, f.plan.waypoints,
                                     f.drawn.start, f.drawn.goal)
             .cost;
       }},
  };
}

int Run(const std::string& name) {
  NativeSearcher searcher;
  const auto works = AllWorks(searcher);
  const auto found = works.find(name);
  if (found == works.end()) {
    std::fprintf(stderr, "guarded_work: no work named %s\n", name.c_str());
    return 2;
  }
  const std::vector<Fixture> fixtures = MakeFixtures();
  const auto once = [&] {
    double sum = 0;
    for (const Fixture& f : fixtures) sum += found->second(f);
    return sum;
  };
  const double first = once();  // Memory that is kept is there from now on.
  TERRA_REQUIRE(TerraGuardedWork(once) == first);
  return 0;
}

}  // namespace
}  // namespace terra

int main(int argc, char** argv) {
  return terra::Run(argc == 2 ? argv[1] : "");
}
