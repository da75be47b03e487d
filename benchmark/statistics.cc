#include "benchmark/statistics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "benchmark/integer_random.h"
#include "benchmark/parallel.h"
#include "terrain/require.h"

namespace terra::benchmark {
namespace {

constexpr double kZ95 = 1.959963984540054;  // Normal quantile of 0.975.

// The interval between the 2.5 % and 97.5 % quantiles, by linear interpolation.
std::pair<double, double> CentralInterval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    const double part = place - static_cast<double>(below);
    return values[below] + part * (values[above] - values[below]);
  };
  return {at(0.025), at(0.975)};
}

// Sums up what a mean is made of.
struct Total {
  double sum = 0;
  std::int64_t count = 0;

  void Add(const Cluster& cluster) {
    sum += cluster.sum;
    count += cluster.count;
  }
  // Without a branch: it would be mispredicted in every other draw.
  void Add(double term) {
    const bool has = !std::isnan(term);
    sum += has ? term : 0;
    count += static_cast<std::int64_t>(has);
  }
  double Mean() const { return sum / static_cast<double>(count); }
};

// The mean of the i-th resample; not a number where it has no term. Resamples
// follow each other in one series of random numbers.
template <typename Unit>  // Cluster, or the term of a single case.
double ResampledMean(std::span<const Unit> units, std::int64_t i) {
  IntegerRandom random(kBootstrapSeed);
  random.Skip(static_cast<std::uint64_t>(i) * units.size());
  const auto last = static_cast<int>(units.size()) - 1;
  Total total;
  for (int k = 0; k <= last; ++k) {
    total.Add(units[static_cast<std::size_t>(random.In(0, last))]);
  }
  if (total.count == 0) return kNoTerm;
  return total.Mean();
}

template <typename Unit>
Estimate Bootstrap(std::span<const Unit> units) {
  Total total;
  for (const Unit& unit : units) total.Add(unit);
  TERRA_REQUIRE(total.count > 0);
  // Small samples are not worth a thread.
  constexpr std::size_t kManyUnits = 1000;
  const int resamples = NumResamples(units.size());
  std::vector<double> means(static_cast<std::size_t>(resamples));
  ParallelFor(resamples, units.size() < kManyUnits ? 1 : 0,
              [&](std::int64_t i) {
                means[static_cast<std::size_t>(i)] = ResampledMean(units, i);
              });
  std::erase_if(means, [](double mean) {
    return std::isnan(mean);
  });
  const auto [low, high] = CentralInterval(std::move(means));
  return {total.Mean(), low, high};
}

}  // namespace

Estimate WilsonRate(std::int64_t hits, std::int64_t n) {
  TERRA_REQUIRE(0 <= hits && hits <= n && n > 0);
  const auto total = static_cast<double>(n);
  const double p = static_cast<double>(hits) / total;
  const double z2 = kZ95 * kZ95;
  const double scale = 1 + z2 / total;
  const double middle = (p + z2 / (2 * total)) / scale;
  const double half =
      kZ95 * std::sqrt(p * (1 - p) / total + z2 / (4 * total * total)) / scale;
  // At 0 and n the bound is exactly 0 or 1, but for rounding.
  return {p, hits == 0 ? 0 : middle - half, hits == n ? 1 : middle + half};
}

Estimate BootstrapMean(std::span<const Cluster> clusters) {
  return Bootstrap(clusters);
}

Estimate BootstrapCaseMean(std::span<const double> terms) {
  return Bootstrap(terms);
}

double McNemarExact(std::int64_t b, std::int64_t c) {
  TERRA_REQUIRE(b >= 0 && c >= 0);
  const auto n = static_cast<double>(b + c);
  double tail = 0;
  for (std::int64_t i = 0; i <= std::min(b, c); ++i) {
    const auto k = static_cast<double>(i);
    tail += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) -
                     std::lgamma(n - k + 1) - n * std::log(2.0));
  }
  return std::min(1.0, 2 * tail);
}

double NearestRank(std::vector<double> values, double percent) {
  TERRA_REQUIRE(!values.empty() && percent > 0 && percent <= 100);
  const auto n = static_cast<double>(values.size());
  // A hair off, so that 95 % of 20 is rank 19 whatever the rounding.
  const auto rank =
      static_cast<std::size_t>(std::ceil(percent / 100 * n - 1e-9));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(
                                          std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double Median(std::vector<double> values) {
  TERRA_REQUIRE(!values.empty());
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half]
                                : (values[half - 1] + values[half]) / 2;
}

}  // namespace terra::benchmark
