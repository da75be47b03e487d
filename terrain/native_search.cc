#include "terrain/native_search.h"

#include <algorithm>
#include <utility>

#include "terrain/bucket_search.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"
#include "terrain/search_keys.h"
#include "terrain/sweep_search.h"

namespace terra {
namespace {

struct Query {
  const TerrainMap& map;
  Cell start;
  Cell goal;
  const NativeSearchOptions& options;
};

// Whether keys hold the way across the map at the lowest cost, so that sums of
// a key below the limit and an octile bound do not overflow.
template <typename Keys>
bool HoldMap(const TerrainMap& map) {
  const double steps = std::max(map.width(), map.height());
  return map.cost_grid().holds_units() &&
         steps * static_cast<double>(Keys(map).min_diagonal()) <
             static_cast<double>(Keys::kLimit);
}

}  // namespace

struct NativeSearcher::Workspace {
  SweepSearch sweep;
  BucketSearch<NarrowKeys> narrow;
  BucketSearch<WideKeys> wide;
  BucketSearch<DoubleKeys> doubles;

  SearchAttempt AttemptNarrow(const Query& query) {
    if (query.options.method == SearchMethod::kBuckets) {
      return Attempt(narrow, query);
    }
    const NarrowKeys keys(query.map);
    return sweep.Run(query.map, keys, query.start, query.goal,
                     keys.KeyAbove(query.options.upper_bound),
                     query.options.instructions);
  }

  template <typename Keys>
  static SearchAttempt Attempt(BucketSearch<Keys>& search, const Query& query) {
    const Keys keys(query.map);
    return search.Run(query.map, keys, query.start, query.goal,
                      keys.KeyAbove(query.options.upper_bound));
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
  const Query query{map, start, goal, options};
  SearchAttempt last;
  last.beyond_keys = true;
  const auto attempt = [&](SearchAttempt next) {
    result.expanded += next.expanded;
    result.passes += next.passes;
    last = std::move(next);
  };
  if (options.keys == KeyWidth::kNarrow && HoldMap<NarrowKeys>(map)) {
    attempt(workspace_->AttemptNarrow(query));
  }
  if (last.beyond_keys && options.keys != KeyWidth::kDouble &&
      HoldMap<WideKeys>(map)) {
    attempt(Workspace::Attempt(workspace_->wide, query));
  }
  if (last.beyond_keys) {
    attempt(Workspace::Attempt(workspace_->doubles, query));
  }
  if (last.found) {
    result.cells = std::move(last.cells);
    result.cost = WalkRoute(map, result.cells).cost;
  } else {
    result.status = SearchStatus::kNoRoute;
  }
  result.bytes = bytes();
  return result;
}

std::size_t NativeSearcher::bytes() const {
  return workspace_->sweep.bytes() + workspace_->narrow.bytes() +
         workspace_->wide.bytes() + workspace_->doubles.bytes();
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
