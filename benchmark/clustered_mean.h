#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmark/statistics.h"

namespace terra::benchmark {

/// A mean over cases; those of one cluster are drawn together.
class ClusteredMean {
 public:
  /// A case; one without a cluster (empty) is a cluster of its own. `value`
  /// matters only where it counts.
  void Add(const std::string& cluster, bool counts, double value) {
    const std::size_t place = PlaceOf(cluster);
    if (!counts) return;
    clusters_[place].sum += value;
    ++clusters_[place].count;
    ++count_;
  }

  /// Absent where nothing counted.
  std::optional<Estimate> Mean() const {
    if (count_ == 0) return std::nullopt;
    return BootstrapMean(clusters_);
  }

 private:
  std::size_t PlaceOf(const std::string& cluster) {
    if (cluster.empty()) {
      clusters_.emplace_back();
      return clusters_.size() - 1;
    }
    const auto [found, added] = place_of_.emplace(cluster, clusters_.size());
    if (added) clusters_.emplace_back();
    return found->second;
  }

  std::vector<Cluster> clusters_;
  std::unordered_map<std::string, std::size_t> place_of_;
  std::int64_t count_ = 0;
};

}  // namespace terra::benchmark
