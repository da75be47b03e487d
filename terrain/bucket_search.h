#pragma once

#include <cstdint>
#include <vector>

#include "terrain/bucket_queue.h"
#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/search_attempt.h"
#include "terrain/search_keys.h"

namespace terra {

/// A* on all cells with a bucket queue and canonical pruning.
///
/// Keeps its memory between searches; nothing is cleared, cells labelled by an
/// earlier search are told by its number.
/// Threads: one search at a time.
/// Source: A*: Hart, Nilsson, Raphael 1968. Buckets: see BucketQueue. Pruning:
///         canonical orderings (Sturtevant, Rabin 2016; Harabor, Grastien 2011)
///         inside blocks of one terrain; the proof is in the source file.
template <typename Keys>
class BucketSearch {
 public:
  using Key = typename Keys::Key;

  /// Finds a path of the smallest key below `bound` (at most Keys::kLimit).
  /// Pre: both ends passable.
  SearchAttempt Run(const TerrainMap& map, const Keys& keys, Cell start,
                    Cell goal, Key bound);

  std::size_t bytes() const { return labels_.capacity() * sizeof(Label); }

 private:
  struct Label {
    Key key;               // Of the best path found to the cell.
    std::uint32_t search;  // The search that found it.
  };
  // 13 bits each for x and y, 4 for the direction of arrival.
  struct Entry {
    Key key;
    std::uint32_t x : 13, y : 13, arrival : 4;
  };

  void Prepare(std::size_t num_cells);

  std::vector<Label> labels_;
  std::uint32_t search_ = 0;
  BucketQueue<Key, Entry> queue_;
};

extern template class BucketSearch<NarrowKeys>;
extern template class BucketSearch<WideKeys>;
extern template class BucketSearch<DoubleKeys>;

}  // namespace terra
