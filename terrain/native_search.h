#pragma once

#include <memory>

#include "terrain/map.h"
#include "terrain/search_result.h"
#include "terrain/sweep_search.h"

namespace terra {

/// How paths are found. All ways find the same path.
enum class SearchMethod {
  kAutomatic,  ///< Whichever is expected to be faster.
  kBuckets,    ///< A* with a bucket queue (bucket_search.h).
  kSweep,      ///< Vectors of cells, row by row (sweep_search.h), where narrow
               ///< keys hold the result; else A*.
};

/// The smallest keys (search_keys.h) that a search may add up, narrow ones in
/// sweeps alone; it takes wider ones by itself where these do not hold the
/// result.
enum class KeyWidth { kNarrow, kWide, kRounded };

/// What a native search may be told.
struct NativeSearchOptions {
  /// Cost of a known route between the ends (the baseline's): paths that cannot
  /// be cheaper need not be looked at. A route of exactly this cost is found;
  /// if there is none of this cost or below (up to rounding, 1e-9 of it), the
  /// status is kNoRoute.
  double upper_bound = kImpassable;

  /// For tests and measurements; the defaults are right for everybody else.
  SearchMethod method = SearchMethod::kAutomatic;
  KeyWidth keys = KeyWidth::kNarrow;
  /// Not wider than BestInstructionSet().
  InstructionSet instructions = BestInstructionSet();
};

/// Finds cheapest 8-connected paths on all cells, exactly, one after another in
/// the same memory.
///
/// Under the paper's cost model (corner cutting on) a path's cost is a lower
/// bound of every feasible route. The path depends on the map, the ends and the
/// tie rule (SearchResult::cells) alone: not on the options, on the processor,
/// or on searches before.
///
/// Where CostGrid::holds_units() costs are compared exactly; otherwise each
/// kind of step is rounded once (RoundedKeys), so that paths whose costs differ
/// by less than 1e-12 of them may change places, everywhere in the same way.
///
/// Threads: one search at a time each.
class NativeSearcher {
 public:
  NativeSearcher();
  NativeSearcher(NativeSearcher&&) noexcept;
  NativeSearcher& operator=(NativeSearcher&&) noexcept;
  ~NativeSearcher();

  SearchResult Search(const TerrainMap& map, Cell start, Cell goal,
                      const NativeSearchOptions& options = {});

  /// Memory kept for the next search.
  std::size_t bytes() const;

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// The same with a searcher per thread, which keeps up to 64 MB between calls.
///
/// Threads: reentrant.
SearchResult NativeSearch(const TerrainMap& map, Cell start, Cell goal,
                          const NativeSearchOptions& options = {});

}  // namespace terra
