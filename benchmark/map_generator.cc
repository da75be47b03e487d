#include "benchmark/map_generator.h"

#include <utility>

#include "planner/coarse_lattice.h"
#include "terrain/builtin_legends.h"
#include "terrain/require.h"

namespace terra::benchmark {
namespace {

constexpr std::uint8_t kBase = 0;
constexpr std::uint8_t kObstacle = 11;
constexpr IntRange kTerrains{1, 10};

constexpr int kPolygonTries = 30;
constexpr int kEndTries = 50;
constexpr int kMapTries = 1000;

std::uint8_t RandomTerrain(IntegerRandom& random) {
  return static_cast<std::uint8_t>(random.In(kTerrains));
}

bool AllBase(const ByteRaster& raster, const std::vector<RowSpan>& spans) {
  for (const RowSpan& span : spans) {
    if ((raster.row(span.y).segment(span.from, span.to - span.from) != kBase)
            .any()) {
      return false;
    }
  }
  return true;
}

bool KeepsFromPolygons(const Star& star, const ByteRaster& raster,
                       const MapParameters& parameters) {
  return parameters.separation < 0 ||
         AllBase(raster, PolygonSpans(star.Outline(parameters.separation),
                                      parameters.side, parameters.side));
}

// Draws one polygon; false when no place was found for it.
bool PlacePolygon(ByteRaster& raster, const MapParameters& parameters,
                  IntegerRandom& random, Rejections& rejections) {
  const int side = parameters.side;
  for (int i = 0; i < kPolygonTries; ++i) {
    const Star star = RandomStar(random, parameters.star, side);
    if (!KeepsFromPolygons(star, raster, parameters)) {
      ++rejections.polygon_misplaced;
      continue;
    }
    FillSpans(raster, PolygonSpans(star.Outline(), side, side),
              RandomTerrain(random));
    return true;
  }
  return false;
}

bool PlacePolygons(ByteRaster& raster, const MapParameters& parameters,
                   IntegerRandom& random, Rejections& rejections) {
  const int wanted = random.In(parameters.polygons);
  for (int placed = 0; placed < wanted; ++placed) {
    if (PlacePolygon(raster, parameters, random, rejections)) continue;
    return placed >= parameters.polygons.low;
  }
  return true;
}

void PlaceRibbon(ByteRaster& raster, const MapParameters& parameters,
                 IntegerRandom& random) {
  Ribbon ribbon;
  ribbon.vertical = random.In(0, 1) == 0;
  ribbon.half_width = random.In(parameters.ribbon_half_width);
  ribbon.amplitude = random.In(parameters.ribbon_amplitude);
  ribbon.center = random.In(parameters.side / 5, parameters.side * 4 / 5);
  ribbon.phase = random.In(0, kTurn - 1);
  ribbon.length_angle = random.In(parameters.ribbon_angle);
  FillRibbon(raster, ribbon, RandomTerrain(random));
}

void PlaceObstacle(ByteRaster& raster, const MapParameters& parameters,
                   IntegerRandom& random) {
  int width = random.In(parameters.obstacle_short);
  int height = random.In(parameters.obstacle_long);
  if (random.In(0, 1) == 0) std::swap(width, height);
  const int edge = parameters.obstacle_edge_distance;
  const int x = random.In(edge, parameters.side - width - edge);
  const int y = random.In(edge, parameters.side - height - edge);
  raster.block(y, x, height, width) = kObstacle;
}

std::optional<ByteRaster> DrawMap(const MapParameters& parameters,
                                  IntegerRandom& random,
                                  Rejections& rejections) {
  ByteRaster raster =
      ByteRaster::Constant(parameters.side, parameters.side, kBase);
  if (!PlacePolygons(raster, parameters, random, rejections)) {
    ++rejections.too_few_polygons;
    return std::nullopt;
  }
  if (parameters.ribbon) PlaceRibbon(raster, parameters, random);
  const int obstacles = random.In(parameters.obstacles);
  for (int i = 0; i < obstacles; ++i) PlaceObstacle(raster, parameters, random);
  return raster;
}

bool JoinedAtAllStrides(const TerrainMap& map, Cell start, Cell goal,
                        const std::vector<int>& strides) {
  for (const int stride : strides) {
    planner::LatticeOptions options;
    options.stride = stride;
    if (!planner::PlanOnLattice(map, start, goal, options).found()) {
      return false;
    }
  }
  return true;
}

std::optional<std::pair<Cell, Cell>> DrawEnds(const TerrainMap& map,
                                              const MapParameters& parameters,
                                              IntegerRandom& random,
                                              Rejections& rejections) {
  const int margin = parameters.end_margin;
  const int half = parameters.side / 2;
  const IntRange rows{margin, parameters.side - 1 - margin};
  for (int i = 0; i < kEndTries; ++i) {
    Cell start{random.In(margin, half - 1), random.In(rows)};
    Cell goal{random.In(half, parameters.side - 1 - margin), random.In(rows)};
    if (random.In(0, 1) == 0) std::swap(start, goal);
    if (!map.Passable(start) || !map.Passable(goal)) {
      ++rejections.end_blocked;
      continue;
    }
    const std::int64_t dx = goal.x - start.x;
    const std::int64_t dy = goal.y - start.y;
    const std::int64_t least = parameters.end_distance;
    if (dx * dx + dy * dy < least * least) {
      ++rejections.ends_too_close;
      continue;
    }
    if (!JoinedAtAllStrides(map, start, goal, parameters.strides)) {
      ++rejections.no_lattice_route;
      continue;
    }
    return std::pair{start, goal};
  }
  return std::nullopt;
}

std::uint64_t CaseSeed(Subset subset, std::uint64_t seed, int index) {
  const auto number =
      static_cast<std::uint64_t>(index) * 2 + (subset == Subset::kHard ? 1 : 0);
  return IntegerRandom::Mix(IntegerRandom::Mix(seed) + number);
}

}  // namespace

std::string_view SubsetName(Subset subset) {
  return subset == Subset::kEasy ? "easy" : "hard";
}

std::optional<Subset> FindSubset(std::string_view name) {
  for (const Subset subset : {Subset::kEasy, Subset::kHard}) {
    if (SubsetName(subset) == name) return subset;
  }
  return std::nullopt;
}

// Fitted with terra-calibrate on seeds 101 to 203 (docs/benchmark.md).
MapParameters CalibratedParameters(Subset subset) {
  MapParameters parameters;
  if (subset == Subset::kEasy) {
    parameters.polygons = {4, 7};
    parameters.star = {
        .radius = {55, 150}, .corners = {4, 6}, .percent = {70, 100}};
    parameters.separation = 15;
    parameters.obstacle_short = {15, 90};
    parameters.obstacle_long = {30, 100};
    parameters.obstacle_edge_distance = 24;
    parameters.end_margin = 5;
    parameters.end_distance = 400;
  } else {
    parameters.polygons = {7, 10};
    parameters.star = {
        .radius = {40, 180}, .corners = {5, 11}, .percent = {20, 100}};
    parameters.ribbon = true;
    parameters.ribbon_half_width = {15, 30};
    parameters.ribbon_amplitude = {20, 60};
    parameters.ribbon_angle = {kTurn / 2, kTurn * 3 / 2};
    parameters.obstacle_short = {30, 90};
    parameters.obstacle_long = {60, 160};
    parameters.obstacle_edge_distance = 20;
    parameters.end_margin = 10;
    parameters.end_distance = 410;
  }
  return parameters;
}

Rejections& Rejections::operator+=(const Rejections& other) {
  polygon_misplaced += other.polygon_misplaced;
  too_few_polygons += other.too_few_polygons;
  end_blocked += other.end_blocked;
  ends_too_close += other.ends_too_close;
  no_lattice_route += other.no_lattice_route;
  no_ends_found += other.no_ends_found;
  return *this;
}

GeneratedCase GenerateCase(Subset subset, std::uint64_t seed, int index,
                           const MapParameters& parameters) {
  TERRA_REQUIRE(index >= 0);
  IntegerRandom random(CaseSeed(subset, seed, index));
  Rejections rejections;
  for (int i = 0; i < kMapTries; ++i) {
    std::optional<ByteRaster> ids = DrawMap(parameters, random, rejections);
    if (!ids) continue;
    Result<TerrainMap> map =
        TerrainMap::Create(*std::move(ids), MultiTerraPathLegend());
    TERRA_REQUIRE(map.ok());
    const auto ends = DrawEnds(*map, parameters, random, rejections);
    if (ends) {
      return {std::move(map).value(), ends->first, ends->second, rejections};
    }
    ++rejections.no_ends_found;
  }
  FailRequirement("parameters from which a map can be drawn", __FILE__,
                  __LINE__);
}

}  // namespace terra::benchmark
