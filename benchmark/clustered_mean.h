#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmark/statistics.h"

namespace terra::benchmark {

/// A mean over cases; those of one cluster are drawn together. Keeps 8 bytes of
/// a case without a cluster, nothing of one with.
class ClusteredMean {
 public:
  /// A case; one without a cluster (empty) is a cluster of its own. `value`
  /// matters only where it counts.
  void Add(const std::string& cluster, bool counts, double value) {
    count_ += counts ? 1 : 0;
    if (cluster.empty()) {
      singles_.push_back(counts ? value : kNoTerm);
      return;
    }
    Cluster& of_case = clusters_[PlaceOf(cluster)];
    if (!counts) return;
    of_case.sum += value;
    ++of_case.count;
  }

  /// Absent where nothing counted.
  std::optional<Estimate> Mean() const {
    if (count_ == 0) return std::nullopt;
    if (clusters_.empty()) return BootstrapCaseMean(singles_);
    std::vector<Cluster> all = clusters_;
    for (const double term : singles_) all.push_back(ClusterOf(term));
    return BootstrapMean(all);
  }

 private:
  std::size_t PlaceOf(const std::string& cluster) {
    const auto [found, added] = place_of_.emplace(cluster, clusters_.size());
    if (added) clusters_.emplace_back();
    return found->second;
  }

  std::vector<double> singles_;
  std::vector<Cluster> clusters_;
  std::unordered_map<std::string, std::size_t> place_of_;
  std::int64_t count_ = 0;
};

}  // namespace terra::benchmark
