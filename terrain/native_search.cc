#include "terrain/native_search.h"

#include <algorithm>
#include <array>
#include <utility>

#include "terrain/bucket_search.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"
#include "terrain/search_keys.h"
#include "terrain/steps.h"
#include "terrain/sweep_search.h"

namespace terra {
namespace {

struct Query {
  const TerrainMap& map;
  Cell start;
  Cell goal;
  const NativeSearchOptions& options;
  double bound;  // Cost of a route that there is; or kImpassable.
};

// A caller who knows no route may still have one: the straight line, which
// costs a microsecond to look at.
double UpperBound(const TerrainMap& map, Cell start, Cell goal,
                  const NativeSearchOptions& options) {
  if (options.upper_bound != kImpassable ||
      options.method != SearchMethod::kAutomatic) {
    return options.upper_bound;
  }
  const RouteWalk line = WalkRoute(map, std::array{start, goal});
  return line.feasible() ? line.cost : kImpassable;
}

// Whether keys hold the way across the map at the lowest cost, and have room
// for what a search adds up before it compares: a key below the limit, a step
// and an octile bound.
template <typename Keys>
bool HoldMap(const TerrainMap& map) {
  const Keys keys(map);
  const double steps = std::max(map.width(), map.height());
  const double across = steps * static_cast<double>(keys.min_diagonal());
  const auto limit = static_cast<double>(Keys::kLimit);
  return map.cost_grid().holds_units() && across < limit &&
         limit + static_cast<double>(keys.max_diagonal()) + across <
             static_cast<double>(Keys::kNone);
}

// Whether a sweep is worth starting. A known route's cost settles it; without
// one narrow keys are tried, and wider ones where the sweep has met paths
// beyond them. (Wide keys find the path that narrow ones find. Rounded keys may
// find another, so wide ones are always tried first, whatever the bound.)
bool NarrowKeysMayHoldResult(const Query& query) {
  return HoldMap<NarrowKeys>(query.map) &&
         (query.bound == kImpassable ||
          NarrowKeys(query.map).KeyAbove(query.bound) < NarrowKeys::kLimit);
}

double OctileCost(const Query& query) {
  return query.map.costs().min_cost() * OctileDistance(query.start, query.goal);
}

// Wide vectors sweep a map in less time than A* takes in all but the easiest
// cases, which nothing tells from those where A* expands most of the map.
// Vectors of four cells do where a known cost leaves out cells, unless it is so
// near the empty map's cost that A* leaves out more (measured on generated
// maps, docs/performance.md).
bool PreferSweep(const Query& query) {
  if (query.options.method != SearchMethod::kAutomatic) {
    return query.options.method == SearchMethod::kSweep;
  }
  if (query.options.instructions != InstructionSet::kPortable) {
    return true;
  }
  constexpr double kNear = 1.35;
  return query.options.upper_bound != kImpassable &&
         query.options.upper_bound > kNear * OctileCost(query);
}

}  // namespace

struct NativeSearcher::Workspace {
  SweepSearch sweep;
  BucketSearch<WideKeys> wide;
  BucketSearch<RoundedKeys> rounded;

  SearchAttempt Sweep(const Query& query) {
    const NarrowKeys keys(query.map);
    return sweep.Run(query.map, keys, query.start, query.goal,
                     keys.KeyAbove(query.bound), query.options.instructions);
  }

  template <typename Keys>
  static SearchAttempt Attempt(BucketSearch<Keys>& search, const Keys& keys,
                               const Query& query) {
    return search.Run(query.map, keys, query.start, query.goal,
                      keys.KeyAbove(query.bound));
  }
};

NativeSearcher::NativeSearcher() : workspace_(std::make_unique<Workspace>()) {}
NativeSearcher::~NativeSearcher() = default;
NativeSearcher::NativeSearcher(NativeSearcher&&) noexcept = default;
NativeSearcher& NativeSearcher::operator=(NativeSearcher&&) noexcept = default;

SearchResult NativeSearcher::Search(const TerrainMap& map, Cell start,
                                    Cell goal,
                                    const NativeSearchOptions& options) {
  SearchResult result;
  result.status = CheckSearchEnds(map, start, goal);
  if (!result.found()) {
    return result;
  }
  if (start == goal) {
    result.cost = 0;
    result.cells = {start};
    return result;
  }
  const Query query{map, start, goal, options,
                    UpperBound(map, start, goal, options)};
  SearchAttempt last;
  last.beyond_keys = true;
  const auto attempt = [&](SearchAttempt next) {
    result.expanded += next.expanded;
    result.passes += next.passes;
    last = std::move(next);
  };
  if (options.keys == KeyWidth::kNarrow && PreferSweep(query) &&
      NarrowKeysMayHoldResult(query)) {
    attempt(workspace_->Sweep(query));
  }
  if (last.beyond_keys && options.keys != KeyWidth::kRounded &&
      HoldMap<WideKeys>(map)) {
    attempt(Workspace::Attempt(workspace_->wide, WideKeys(map), query));
  }
  const int num_levels = RoundedKeys::NumLevels(map);
  for (int level = 0; last.beyond_keys && level < num_levels; ++level) {
    attempt(Workspace::Attempt(workspace_->rounded, RoundedKeys(map, level),
                               query));
  }
  const double cost =
      last.found ? WalkRoute(map, last.cells).cost : kImpassable;
  // Keys are coarser than costs: one below the bound may cost a little more.
  if (last.found && cost <= options.upper_bound * kAboveRounding) {
    result.cells = std::move(last.cells);
    result.cost = cost;
  } else {
    result.status = SearchStatus::kNoRoute;
  }
  result.bytes = bytes();
  return result;
}

std::size_t NativeSearcher::bytes() const {
  return workspace_->sweep.bytes() + workspace_->wide.bytes() +
         workspace_->rounded.bytes();
}

SearchResult NativeSearch(const TerrainMap& map, Cell start, Cell goal,
                          const NativeSearchOptions& options) {
  constexpr std::size_t kMaxBytesKept = std::size_t{64} << 20;
  thread_local NativeSearcher searcher;
  SearchResult result = searcher.Search(map, start, goal, options);
  if (searcher.bytes() > kMaxBytesKept) {
    searcher = NativeSearcher();
  }
  return result;
}

}  // namespace terra
