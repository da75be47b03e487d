#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstdint>
#include <vector>

namespace terra {

/// A priority queue for keys that never fall below the last one taken out and
/// never lie more than a known span above it. Entries of one bucket (a range of
/// keys) come out last in, first out, so a search must accept that a key is
/// improved after it was taken.
///
/// Source: Dial 1969 (CACM 12:11), with buckets wider than one key as in
///         Denardo and Fox 1979 (Operations Research 27:1).
template <std::unsigned_integral Key, typename Entry>
class BucketQueue {
 public:
  /// Empties the queue. Every key pushed is at least `first`, and at most
  /// `span` above the last one popped. Buckets are as wide as the power of two
  /// below `width`, or wider where the span would need too many of them.
  void Reset(Key first, Key width, Key span) {
    for (std::vector<Entry>& bucket : buckets_) {
      bucket.clear();
    }
    first_ = first;
    width = std::max(width, span / static_cast<Key>(kMaxBuckets / 4));
    shift_ = static_cast<int>(std::bit_width(width)) - 1;
    width = Key{1} << shift_;
    const auto needed = static_cast<std::size_t>(span / width) + 3;
    if (buckets_.size() < needed) {
      buckets_.resize(std::bit_ceil(needed));
    }
    current_ = 0;
    size_ = 0;
  }

  bool empty() const { return size_ == 0; }

  /// No entry left is below this.
  Key floor() const { return first_ + (static_cast<Key>(current_) << shift_); }

  void Push(Key key, const Entry& entry) {
    const std::uint64_t bucket = std::uint64_t{key - first_} >> shift_;
    buckets_[bucket & (buckets_.size() - 1)].push_back(entry);
    ++size_;
  }

  /// Takes an entry of the lowest bucket. Pre: not empty.
  Entry Pop() {
    std::vector<Entry>* bucket = &buckets_[current_ & (buckets_.size() - 1)];
    while (bucket->empty()) {
      ++current_;
      bucket = &buckets_[current_ & (buckets_.size() - 1)];
    }
    const Entry entry = bucket->back();
    bucket->pop_back();
    --size_;
    return entry;
  }

 private:
  static constexpr std::size_t kMaxBuckets = 1 << 16;

  std::vector<std::vector<Entry>> buckets_;
  Key first_{};
  int shift_ = 0;  // A bucket is 2^shift wide.
  std::uint64_t current_ = 0;
  std::size_t size_ = 0;
};

}  // namespace terra
