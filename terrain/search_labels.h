#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace terra {

/// The keys of the best paths found to the cells of a map, kept between
/// searches without clearing.
///
/// Each search starts its keys at an origin of its own, below the origin of the
/// search before it. Stale labels need no marker: they exceed every key that
/// this search can produce. A key has kKeyBits bits; the bits above them count
/// the searches down. After 255 searches the labels are cleared. Threads: one
/// search at a time.
template <std::unsigned_integral Key>
class SearchLabels {
 public:
  static constexpr int kKeyBits = std::numeric_limits<Key>::digits - 8;

  /// Forgets all labels. Returns the search's origin: the key of its start.
  Key Begin(std::size_t num_cells) {
    if (labels_.size() < num_cells || origin_ == 0) {
      labels_.assign(num_cells, kNone);
      origin_ = kNone << kKeyBits;
    }
    origin_ -= Key{1} << kKeyBits;
    return origin_;
  }

  /// Above every key of this search where it has not labelled the cell.
  Key At(std::size_t index) const { return labels_[index]; }
  void Set(std::size_t index, Key key) { labels_[index] = key; }

  /// Has the label brought from memory while other work is done.
  void Prefetch(std::size_t index) const {
    __builtin_prefetch(labels_.data() + index);
  }

  std::size_t bytes() const { return labels_.capacity() * sizeof(Key); }

 private:
  static constexpr Key kNone = std::numeric_limits<Key>::max();

  std::vector<Key> labels_;
  Key origin_ = 0;
};

}  // namespace terra
