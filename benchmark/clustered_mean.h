#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmark/statistics.h"

namespace terra::benchmark {

/// A mean over cases; those of one cluster are drawn together. Keeps 8 bytes of
/// a sampled case without a cluster, nothing of others. The mean is of all, its
/// interval of what was sampled, and so a little wider.
class ClusteredMean {
 public:
  /// A case; one without a cluster (empty) is a cluster of its own. `value`
  /// matters only where it counts.
  void Add(const std::string& cluster, bool counts, double value,
           bool sampled = true) {
    sum_ += counts ? value : 0;
    count_ += counts ? 1 : 0;
    if (cluster.empty()) {
      if (sampled) singles_.push_back(counts ? value : kNoTerm);
      all_sampled_ = all_sampled_ && sampled;
      return;
    }
    Cluster& of_case = clusters_[PlaceOf(cluster)];
    if (!counts) return;
    of_case.sum += value;
    ++of_case.count;
  }

  /// Absent where nothing counted, or nothing of the sample.
  std::optional<Estimate> Mean() const {
    std::optional<Estimate> mean = SampleMean();
    if (mean && !all_sampled_) mean->value = sum_ / static_cast<double>(count_);
    return mean;
  }

 private:
  std::optional<Estimate> SampleMean() const {
    std::vector<Cluster> all = clusters_;
    if (!all.empty()) {
      for (const double term : singles_) all.push_back(ClusterOf(term));
    }
    const bool any =
        std::any_of(all.begin(), all.end(),
                    [](const Cluster& c) {
                      return c.count > 0;
                    }) ||
        std::any_of(singles_.begin(), singles_.end(), [](double term) {
          return !std::isnan(term);
        });
    if (!any) return std::nullopt;
    return all.empty() ? BootstrapCaseMean(singles_) : BootstrapMean(all);
  }

  std::size_t PlaceOf(const std::string& cluster) {
    const auto [found, added] = place_of_.emplace(cluster, clusters_.size());
    if (added) clusters_.emplace_back();
    return found->second;
  }

  std::vector<double> singles_;
  std::vector<Cluster> clusters_;
  std::unordered_map<std::string, std::size_t> place_of_;
  double sum_ = 0;
  std::int64_t count_ = 0;
  bool all_sampled_ = true;
};

}  // namespace terra::benchmark
