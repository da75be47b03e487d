#include "terrain/bucket_search.h"

#include <algorithm>
#include <array>
#include <bit>

#include "terrain/path_extraction.h"
#include "terrain/search_steps.h"

namespace terra {
namespace {

constexpr std::size_t kNoArrival = kSteps.size();

constexpr unsigned Bit(std::size_t step) {
  return 1U << step % kSteps.size();
}

// Steps worth trying from a cell, by the step that led to it.
using StepSets = std::array<unsigned, kSteps.size() + 1>;

// Anywhere but back.
constexpr StepSets kAllSteps = [] {
  StepSets sets{};
  for (std::size_t d = 0; d < kSteps.size(); ++d) {
    sets[d] = 0xff & ~Bit(d + 4);
  }
  sets[kNoArrival] = 0xff;
  return sets;
}();

// Canonical pruning: in the middle of a 3x3 block of one terrain, straight on,
// and after a diagonal step also half a turn to either side.
//
// Why no optimal path is lost (p the cell before x, n a neighbour of x that is
// left out, all in the uniform block): n can be reached from p without x at a
// lower cost, except after a straight step p-x, when n lies half a turn aside:
// then p-y-n, first diagonal and then straight, costs the same. Take n with an
// optimal path over x, and let all cells of lower optimal cost be labelled
// optimally (induction over cost). A lower cost contradicts optimality, so only
// the equal one is left. There y is labelled optimally, with some arrival step
// of its own, and n is a straight step from y. If that is left out in turn, it
// is for a strictly cheaper way to n (ties concern diagonal steps only), which
// again contradicts optimality. So n is labelled from y.
constexpr StepSets kNaturalSteps = [] {
  StepSets sets{};
  for (std::size_t d = 0; d < kSteps.size(); ++d) {
    sets[d] = d % 2 == 0 ? Bit(d) : Bit(d + 7) | Bit(d) | Bit(d + 1);
  }
  sets[kNoArrival] = 0xff;
  return sets;
}();

}  // namespace

template <typename Keys>
void BucketSearch<Keys>::Prepare(std::size_t num_cells) {
  ++search_;
  if (labels_.size() < num_cells || search_ == 0) {
    labels_.assign(num_cells, Label{Key{}, 0});
    search_ = 1;
  }
}

template <typename Keys>
SearchAttempt BucketSearch<Keys>::Run(const TerrainMap& map, const Keys& keys,
                                      Cell start, Cell goal, Key bound) {
  Prepare(map.cost_grid().size());
  SearchAttempt attempt;
  const GridSteps grid(map);
  const OctileBound<Keys> to_goal(keys, goal);
  const auto key_of = [this](std::size_t index) {
    return labels_[index].search == search_ ? labels_[index].key : Keys::kNone;
  };
  const auto push = [&](std::size_t index, Key key, Key total, int x, int y,
                        std::size_t arrival) {
    labels_[index] = Label{key, search_};
    queue_.Push(total, Entry(key, x, y, arrival));
  };

  const Key least = to_goal(start.x, start.y);
  const bool bounded_by_keys = bound == Keys::kLimit;
  if (least >= bound) {
    attempt.beyond_keys = bounded_by_keys;
    return attempt;
  }
  // A quarter of the shortest step: wide enough to have few empty buckets,
  // narrow enough that few cells are expanded too early.
  queue_.Reset(least, keys.min_straight() / 4, 2 * keys.max_diagonal());
  push(map.cost_grid().Index(start), Key{}, least, start.x, start.y,
       kNoArrival);
  while (!queue_.empty() && queue_.floor() < bound) {
    const Entry entry = queue_.Pop();
    const int x = entry.x();
    const int y = entry.y();
    const std::size_t index = map.cost_grid().Index(Cell{x, y});
    const bool improved_since = labels_[index].key != entry.key;
    if (improved_since ||
        (attempt.found && entry.key + to_goal(x, y) >= bound)) {
      continue;
    }
    ++attempt.expanded;
    const StepSets& sets =
        grid.InUniformBlock(index) ? kNaturalSteps : kAllSteps;
    for (unsigned steps = sets[entry.arrival()]; steps != 0;
         steps &= steps - 1) {
      const auto d = static_cast<std::size_t>(std::countr_zero(steps));
      const std::size_t next = grid.Neighbour(index, d);
      const std::uint16_t code = grid.Code(next);
      if (code == 0 || !grid.MayPassCorner(index, d)) {
        continue;
      }
      const Key key =
          entry.key + (d % 2 == 0 ? keys.Straight(code) : keys.Diagonal(code));
      if (key >= key_of(next)) {
        continue;
      }
      const int next_x = x + kSteps[d].x;
      const int next_y = y + kSteps[d].y;
      const Key total = key + to_goal(next_x, next_y);
      if (total >= bound) {
        attempt.beyond_keys = bounded_by_keys;
        continue;
      }
      push(next, key, total, next_x, next_y, d);
      if (next_x == goal.x && next_y == goal.y) {
        attempt.found = true;
        bound = key;
      }
    }
  }
  if (attempt.found) {
    attempt.beyond_keys = false;
    attempt.cells = ExtractPath(map, keys, start, goal, key_of);
  }
  return attempt;
}

template class BucketSearch<NarrowKeys>;
template class BucketSearch<WideKeys>;
template class BucketSearch<DoubleKeys>;

}  // namespace terra
