#include "advisor/llm_methods.h"
#include "advisor/reference_pool.h"
#include "benchmark/speed/works.h"
#include "bus/map_exchange.h"
#include "planner/coarse_lattice.h"
#include "terrain/digest.h"
#include "terrain/require.h"

namespace terra::benchmark {

std::vector<TimedSample> TimeData(const SpeedCase& c, int rounds) {
  const auto bytes = static_cast<double>(c.map.ids().size());
  const TileGrid grid{c.map.width(), c.map.height()};
  std::vector<std::vector<std::uint8_t>> tiles;
  for (int i = 0; i < grid.count(); ++i) {
    tiles.push_back(ExtractTile(c.map.ids(), grid, i));
  }
  const std::int64_t digest = TileDigests(c.map.ids(), grid).back();
  const planner::LatticePlan plan =
      planner::PlanOnLattice(c.map, c.start, c.goal);
  const advisor::PlanningCase planning{
      "speed", c.map, c.start, c.goal, plan.waypoints, plan.cost, ""};
  const advisor::ReferencePool& pool = advisor::ReferencePool::Builtin();
  return TimeInterleaved(
      {
          {.name = "map digest",
           .run =
               [&] {
                 TERRA_REQUIRE(TileDigests(c.map.ids(), grid).back() == digest);
               },
           .calls = 4,
           .amount = bytes},
          {.name = "tile compression",
           .run =
               [&] {
                 for (const auto& tile : tiles) {
                   TERRA_REQUIRE(!bus::CompressTile(tile).empty());
                 }
               },
           .amount = bytes},
          {.name = "LLM input",
           .run =
               [&] {
                 const advisor::PreparedCase prepared =
                     advisor::PrepareCase(planning, {}, &pool);
                 TERRA_REQUIRE(!prepared.reference_missing);
               },
           .amount = bytes},
      },
      rounds);
}

}  // namespace terra::benchmark
