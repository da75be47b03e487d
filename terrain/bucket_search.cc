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

// The labels of a search, for its path to be read from.
template <typename Key>
class LabelsOfPaths {
 public:
  // `mark`: above every key of this search, below those of the searches before.
  LabelsOfPaths(SearchLabels<Key>& labels, Key mark)
      : labels_(labels), mark_(mark) {}

  Key At(std::size_t index) const { return labels_.At(index); }
  bool IsMarked(std::size_t index) const { return labels_.At(index) == mark_; }
  void Mark(std::size_t index) { labels_.Set(index, mark_); }

 private:
  SearchLabels<Key>& labels_;
  Key mark_;
};

}  // namespace

template <typename Keys>
struct BucketSearch<Keys>::Task {
  const Keys& keys;
  const GridSteps grid;
  const OctileBound<Keys> to_goal;
  const Cell goal;
  const bool bounded_by_keys;
  Key bound;  // Falls to the key of the best path to the goal.
  SearchAttempt attempt;
};

template <typename Keys>
void BucketSearch<Keys>::Push(std::size_t index, Key total,
                              const Entry& entry) {
  labels_.Set(index, entry.key);
  queue_.Push(total, entry);
}

// A cell that is not searched on from, since its total is not below the bound.
template <typename Keys>
void BucketSearch<Keys>::LeaveOut(const Task& task, Cell cell, Key total) {
  if (total == task.bound) {
    as_good_.push_back(cell);
  }
}

// Labels the neighbours of a cell to which it leads at a lower key.
template <typename Keys>
void BucketSearch<Keys>::Expand(Task& task, const Entry& entry,
                                std::size_t index) {
  ++task.attempt.expanded;
  const StepSets& sets =
      task.grid.InUniformBlock(index) ? kNaturalSteps : kAllSteps;
  for (unsigned steps = sets[entry.arrival()]; steps != 0; steps &= steps - 1) {
    const auto d = static_cast<std::size_t>(std::countr_zero(steps));
    const std::size_t next = task.grid.Neighbour(index, d);
    const std::uint16_t code = task.grid.Code(next);
    if (code == 0 || !task.grid.MayPassCorner(index, d)) {
      continue;
    }
    const Key key = entry.key + (d % 2 == 0 ? task.keys.Straight(code)
                                            : task.keys.Diagonal(code));
    if (key >= labels_.At(next)) {
      continue;
    }
    const Cell cell{entry.x() + kSteps[d].x, entry.y() + kSteps[d].y};
    const Key total = key + task.to_goal(cell.x, cell.y);
    if (total >= task.bound) {
      task.attempt.beyond_keys = task.bounded_by_keys;
      LeaveOut(task, cell, total);
      continue;
    }
    Push(next, total, Entry(key, cell.x, cell.y, d));
    // What its expansion will ask for in other rows.
    labels_.Prefetch(task.grid.Neighbour(next, 2));
    labels_.Prefetch(task.grid.Neighbour(next, 6));
    if (cell == task.goal) {
      task.attempt.found = true;
      task.bound = key;
      as_good_.clear();
    }
  }
}

// Every cheapest path is labelled, but for what lies behind the cells that were
// left out with the goal's own key as their total.
template <typename Keys>
CellPath BucketSearch<Keys>::ReadPath(const TerrainMap& map, const Task& task,
                                      Cell start, Key mark) {
  LabelsOfPaths<Key> labels(labels_, mark);
  return PathExtraction(map, task.keys, start, task.goal, labels, as_good_)
      .Run();
}

template <typename Keys>
SearchAttempt BucketSearch<Keys>::Run(const TerrainMap& map, const Keys& keys,
                                      Cell start, Cell goal, Key bound) {
  const Key origin = labels_.Begin(map.cost_grid().size());
  Task task{keys, GridSteps(map),        OctileBound<Keys>(keys, goal),
            goal, bound == Keys::kLimit, origin + bound,
            {}};
  SearchAttempt& attempt = task.attempt;
  const Key least = origin + task.to_goal(start.x, start.y);
  if (least >= task.bound) {
    attempt.beyond_keys = task.bounded_by_keys;
    return attempt;
  }
  // A quarter of the shortest step: wide enough to have few empty buckets,
  // narrow enough that few cells are expanded too early.
  queue_.Reset(least, keys.min_straight() / 4, 2 * keys.max_diagonal());
  Push(map.cost_grid().Index(start), least,
       Entry(origin, start.x, start.y, kNoArrival));
  as_good_.clear();
  while (!queue_.empty() && queue_.floor() <= task.bound) {
    const Entry entry = queue_.Pop();
    const Cell cell{entry.x(), entry.y()};
    const std::size_t index = map.cost_grid().Index(cell);
    if (labels_.At(index) != entry.key) {
      continue;  // Improved since.
    }
    const Key total =
        attempt.found ? entry.key + task.to_goal(cell.x, cell.y) : least;
    if (total < task.bound) {
      Expand(task, entry, index);
    } else {
      LeaveOut(task, cell, total);
    }
  }
  if (attempt.found) {
    attempt.beyond_keys = false;
    attempt.cells = ReadPath(map, task, start, origin + Keys::kNone);
  }
  return attempt;
}

static_assert(WideKeys::kNone >> SearchLabels<WideKeys::Key>::kKeyBits == 0);
static_assert(RoundedKeys::kNone >> SearchLabels<RoundedKeys::Key>::kKeyBits ==
              0);

template class BucketSearch<WideKeys>;
template class BucketSearch<RoundedKeys>;

}  // namespace terra
