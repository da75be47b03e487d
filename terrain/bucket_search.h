#pragma once

#include <cstdint>
#include <vector>

#include "terrain/bucket_queue.h"
#include "terrain/cell.h"
#include "terrain/map.h"
#include "terrain/search_attempt.h"
#include "terrain/search_keys.h"
#include "terrain/search_labels.h"

namespace terra {

/// A* on all cells with a bucket queue and canonical pruning.
///
/// Keeps its memory between searches (search_labels.h).
/// Threads: one search at a time.
/// Source: A*: Hart, Nilsson, Raphael 1968. Buckets: see BucketQueue. Pruning:
///         canonical orderings (Sturtevant, Rabin 2016; Harabor, Grastien 2011)
///         inside blocks of one terrain; the proof is in the source file.
template <typename Keys>
class BucketSearch {
 public:
  using Key = typename Keys::Key;

  /// Finds the path (SearchResult::cells) of the smallest key below `bound` (at
  /// most Keys::kLimit), whatever the bound.
  /// Pre: both ends passable.
  SearchAttempt Run(const TerrainMap& map, const Keys& keys, Cell start,
                    Cell goal, Key bound);

  std::size_t bytes() const { return labels_.bytes(); }

 private:
  // A label in the queue. Packed by hand, as compilers write bit-fields one by
  // one and then wait for what they wrote: 13 bits each for x and y, then the
  // step of arrival.
  struct Entry {
    Entry(Key label_key, int cell_x, int cell_y, std::size_t step)
        : key(label_key),
          packed(static_cast<std::uint32_t>(cell_x) |
                 static_cast<std::uint32_t>(cell_y) << 13 |
                 static_cast<std::uint32_t>(step) << 26) {}
    int x() const { return static_cast<int>(packed & 0x1fff); }
    int y() const { return static_cast<int>(packed >> 13 & 0x1fff); }
    std::size_t arrival() const { return packed >> 26; }

    Key key;
    std::uint32_t packed;
  };

  struct Task;

  void Push(std::size_t index, Key total, const Entry& entry);
  void LeaveOut(const Task& task, Cell cell, Key total);
  void Expand(Task& task, const Entry& entry, std::size_t index);
  CellPath ReadPath(const TerrainMap& map, const Task& task, Cell start,
                    Key mark);

  SearchLabels<Key> labels_;
  BucketQueue<Key, Entry> queue_;
  std::vector<Cell> as_good_;  // Left out with the bound as their total.
};

extern template class BucketSearch<WideKeys>;
extern template class BucketSearch<RoundedKeys>;

}  // namespace terra
