#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace terra::benchmark {

/// A figure with its 95 % interval.
struct Estimate {
  double value = 0;
  double low = 0;
  double high = 0;
};

/// A rate with the Wilson score interval (Wilson 1927). Pre: 0 <= hits <= n,
/// n > 0.
Estimate WilsonRate(std::int64_t hits, std::int64_t n);

/// Terms of a mean that belong together: cases of one sequence, or one case.
struct Cluster {
  double sum = 0;
  std::int64_t count = 0;
};

/// A case without a term, in a list of terms.
inline constexpr double kNoTerm = std::numeric_limits<double>::quiet_NaN();

/// The cluster of one case with this term, or kNoTerm.
inline Cluster ClusterOf(double term) {
  return std::isnan(term) ? Cluster{} : Cluster{term, 1};
}

/// How many resamples are drawn of so many clusters: 10,000; of more than
/// 100,000 clusters 1,000 (docs/decisions.md, 19).
constexpr int NumResamples(std::size_t clusters) {
  return clusters > 100'000 ? 1'000 : 10'000;
}
inline constexpr std::uint64_t kBootstrapSeed = 20'260'101;

/// A mean (all sums over all counts) with the percentile bootstrap interval
/// over clusters (Efron 1979). Deterministic. Resamples without a term are left
/// out. Takes all cores. Pre: at least one count > 0.
Estimate BootstrapMean(std::span<const Cluster> clusters);
/// The same of clusters that are single cases; kNoTerm where one has none.
Estimate BootstrapCaseMean(std::span<const double> terms);

/// Exact two-sided McNemar test (McNemar 1947): the chance, with a fair coin,
/// of a split at least as uneven as b to c.
double McNemarExact(std::int64_t b, std::int64_t c);

/// Nearest-rank percentile (the smallest value with at least that share at or
/// below it). Pre: not empty, 0 < percent <= 100.
double NearestRank(std::vector<double> values, double percent);

/// The usual median. Pre: not empty.
double Median(std::vector<double> values);

}  // namespace terra::benchmark
