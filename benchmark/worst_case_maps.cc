#include "benchmark/worst_case_maps.h"

#include <utility>

#include "benchmark/integer_random.h"

namespace terra::benchmark {
namespace {

constexpr std::uint8_t kWall = 11;
constexpr IntRange kCostTerrains{0, 10};

}  // namespace

WorstCase RowSerpentine(int side, std::uint8_t ground) {
  WorstCase c{ByteRaster::Constant(side, side, ground), {0, 0}, {}};
  int turn = side - 1;
  for (int y = 1; y < side; y += 2) {
    c.ids.row(y).setConstant(kWall);
    if (y + 1 < side) {
      c.ids(y, turn) = ground;
      turn = side - 1 - turn;
      c.goal = {turn, y + 1};
    }
  }
  return c;
}

WorstCase ColumnSerpentine(int side, std::uint8_t ground) {
  WorstCase c = RowSerpentine(side, ground);
  c.ids.transposeInPlace();
  std::swap(c.goal.x, c.goal.y);
  return c;
}

WorstCase Spiral(int side, std::uint8_t ground) {
  WorstCase c{ByteRaster::Constant(side, side, ground), {0, 0}, {}};
  bool low = false;
  for (int ring = 1; 2 * ring < side - 2; ring += 2) {
    const int length = side - 2 * ring;
    c.ids.row(ring).segment(ring, length).setConstant(kWall);
    c.ids.row(side - 1 - ring).segment(ring, length).setConstant(kWall);
    c.ids.col(ring).segment(ring, length).setConstant(kWall);
    c.ids.col(side - 1 - ring).segment(ring, length).setConstant(kWall);
    const int gap = low ? ring + 1 : side - 2 - ring;
    c.ids(gap, low ? ring : side - 1 - ring) = ground;
    low = !low;
  }
  c.goal = {side / 2, side / 2};
  c.ids(c.goal.y, c.goal.x) = ground;
  return c;
}

WorstCase ClosedRoom(int side, std::uint8_t ground) {
  WorstCase c{
      ByteRaster::Constant(side, side, ground), {side / 2, side / 2}, {}};
  const int low = side - 20;
  c.ids.block(low, low, 11, 11).setConstant(kWall);
  c.ids.block(low + 2, low + 2, 7, 7).setConstant(ground);
  c.goal = {low + 4, low + 4};
  return c;
}

WorstCase NoiseOfCosts(int side, std::uint64_t seed) {
  WorstCase c{ByteRaster(side, side), {0, 0}, {side - 1, side - 1}};
  IntegerRandom random(seed);
  for (Eigen::Index i = 0; i < c.ids.size(); ++i) {
    c.ids.data()[i] = static_cast<std::uint8_t>(random.In(kCostTerrains));
  }
  return c;
}

}  // namespace terra::benchmark
