#include <array>
#include <utility>

#include "advisor/corridor.h"
#include "benchmark/methods/comparison_refiners.h"
#include "terrain/require.h"

namespace terra::benchmark {

RefineOutput RefineByBand(const RefineInput& input, int half_width) {
  const advisor::Corridor corridor(input.map, std::array{input.baseline},
                                   half_width);
  Route route = advisor::RouteInCorridor(
      input.map, corridor, input.baseline.front(), input.baseline.back());
  TERRA_REQUIRE(!route.empty());  // The baseline's own cells are a path.
  return advisor::OrBaseline(input, std::move(route));
}

}  // namespace terra::benchmark
