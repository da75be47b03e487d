#include "benchmark/speed/speed_case.h"

#include "benchmark/worst_case_maps.h"
#include "terrain/builtin_legends.h"

namespace terra::benchmark {
namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr int kCalibratedSide = 500;

MapParameters ScaledParameters(Subset subset, int side) {
  MapParameters p = CalibratedParameters(subset);
  const auto scale = [side](int length) {
    return static_cast<int>(std::int64_t{length} * side / kCalibratedSide);
  };
  const auto scale_range = [scale](IntRange& range) {
    range = {scale(range.low), scale(range.high)};
  };
  p.side = side;
  scale_range(p.star.radius);
  scale_range(p.ribbon_half_width);
  scale_range(p.ribbon_amplitude);
  scale_range(p.obstacle_short);
  scale_range(p.obstacle_long);
  p.separation = p.separation < 0 ? p.separation : scale(p.separation);
  p.obstacle_edge_distance = scale(p.obstacle_edge_distance);
  p.end_margin = scale(p.end_margin);
  p.end_distance = scale(p.end_distance);
  return p;
}

}  // namespace

SpeedCase MakeGeneratedCase(Subset subset, int index, int side) {
  GeneratedCase drawn =
      GenerateCase(subset, kSeed, index, ScaledParameters(subset, side));
  return {std::string(SubsetName(subset)), index, std::move(drawn.map),
          drawn.start, drawn.goal};
}

std::vector<SpeedCase> MakeWorstCases() {
  constexpr int kSide = 500;
  constexpr std::uint8_t kGround = 0;
  std::vector<SpeedCase> cases;
  const auto add = [&cases](const char* name, WorstCase made) {
    cases.push_back(
        {name, 0,
         TerrainMap::Create(std::move(made.ids), MultiTerraPathLegend())
             .value(),
         made.start, made.goal});
  };
  add("serpentine of rows", RowSerpentine(kSide, kGround));
  add("serpentine of columns", ColumnSerpentine(kSide, kGround));
  add("spiral", Spiral(kSide, kGround));
  add("goal in a closed room", ClosedRoom(kSide, kGround));
  add("a cost per cell", NoiseOfCosts(kSide, kSeed));
  return cases;
}

}  // namespace terra::benchmark
