#include "terrain/native_search.h"

#include <algorithm>

#include "terrain/bucket_search.h"
#include "terrain/route_cost.h"
#include "terrain/search_ends.h"
#include "terrain/search_keys.h"

namespace terra {
namespace {

struct Query {
  const TerrainMap& map;
  Cell start;
  Cell goal;
  double upper_bound;
};

// Whether keys hold the bound below a path across the map added to any path.
template <typename Keys>
bool HoldsMap(const TerrainMap& map) {
  const double steps = std::max(map.width(), map.height());
  return map.cost_grid().holds_units() &&
         steps * static_cast<double>(Keys(map).min_diagonal()) <
             static_cast<double>(Keys::kLimit);
}

}  // namespace

struct NativeSearcher::Workspace {
  BucketSearch<NarrowKeys> narrow;
  BucketSearch<WideKeys> wide;
  BucketSearch<DoubleKeys> doubles;

  // Searches with one kind of keys. Returns whether that settled the matter:
  // not when paths were dropped only because such keys do not hold them.
  template <typename Keys>
  bool Settle(BucketSearch<Keys>& search, const Query& query,
              SearchResult& result) {
    const Keys keys(query.map);
    const auto bound = keys.KeyAbove(query.upper_bound);
    auto attempt = search.Run(query.map, keys, query.start, query.goal, bound);
    result.expanded += attempt.expanded;
    if (attempt.found) {
      result.status = SearchStatus::kFound;
      result.cells = std::move(attempt.cells);
      result.cost = WalkRoute(query.map, result.cells).cost;
    }
    return attempt.found || !attempt.dropped || bound < Keys::kLimit;
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
  result.status = SearchStatus::kNoRoute;
  const Query query{map, start, goal, options.upper_bound};
  const bool settled =
      (options.keys <= KeyWidth::kNarrow && HoldsMap<NarrowKeys>(map) &&
       workspace_->Settle(workspace_->narrow, query, result)) ||
      (options.keys <= KeyWidth::kWide && HoldsMap<WideKeys>(map) &&
       workspace_->Settle(workspace_->wide, query, result));
  if (!settled) {
    workspace_->Settle(workspace_->doubles, query, result);
  }
  return result;
}

std::size_t NativeSearcher::bytes() const {
  return workspace_->narrow.bytes() + workspace_->wide.bytes() +
         workspace_->doubles.bytes();
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
