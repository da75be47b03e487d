#include "benchmark/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "benchmark/integer_random.h"

namespace terra::benchmark {
namespace {

TEST(Wilson, AgreesWithAHandComputedInterval) {
  // 3 of 10, z = 1.959964, z^2 = 3.841459: middle (0.3 + 0.192073) / 1.384146,
  // half width 1.959964 sqrt(0.021 + 0.009604) / 1.384146.
  const Estimate rate = WilsonRate(3, 10);
  EXPECT_DOUBLE_EQ(rate.value, 0.3);
  EXPECT_NEAR(rate.low, 0.1077913, 1e-7);
  EXPECT_NEAR(rate.high, 0.6032219, 1e-7);
}

TEST(Wilson, StaysBetweenZeroAndOne) {
  EXPECT_EQ(WilsonRate(0, 50).low, 0);
  EXPECT_NEAR(WilsonRate(0, 50).high, 3.841459 / 53.841459, 1e-6);
  EXPECT_EQ(WilsonRate(50, 50).high, 1);
  EXPECT_NEAR(WilsonRate(50, 50).low, 50 / 53.841459, 1e-6);
}

TEST(McNemar, IsTwiceTheBinomialTail) {
  // b = 1, c = 5: 2 (C(6,0) + C(6,1)) / 64 = 14 / 64.
  EXPECT_NEAR(McNemarExact(1, 5), 14.0 / 64, 1e-12);
  EXPECT_NEAR(McNemarExact(5, 1), 14.0 / 64, 1e-12);
  EXPECT_NEAR(McNemarExact(0, 10), 2.0 / 1024, 1e-12);
}

TEST(McNemar, WithoutOrWithEvenDisagreementIsOne) {
  EXPECT_EQ(McNemarExact(0, 0), 1);
  EXPECT_EQ(McNemarExact(4, 4), 1);
}

TEST(McNemar, HoldsForThousandsOfPairs) {
  // Normal approximation with continuity correction: (|b-c| - 1) / sqrt(b + c)
  // = 3.146, two-sided p = 0.00165.
  EXPECT_NEAR(McNemarExact(450, 550), 0.00173, 1e-4);
}

TEST(Bootstrap, OfEqualValuesIsAPoint) {
  const std::array<Cluster, 3> clusters = {{{0.5, 1}, {0.5, 1}, {1.0, 2}}};
  const Estimate mean = BootstrapMean(clusters);
  EXPECT_DOUBLE_EQ(mean.value, 0.5);
  EXPECT_DOUBLE_EQ(mean.low, 0.5);
  EXPECT_DOUBLE_EQ(mean.high, 0.5);
}

TEST(Bootstrap, OfTwoValuesSpansThemBoth) {
  // A quarter of the resamples is all zeros, a quarter all ones.
  const std::array<Cluster, 2> clusters = {{{0, 1}, {1, 1}}};
  const Estimate mean = BootstrapMean(clusters);
  EXPECT_DOUBLE_EQ(mean.value, 0.5);
  EXPECT_DOUBLE_EQ(mean.low, 0);
  EXPECT_DOUBLE_EQ(mean.high, 1);
}

TEST(Bootstrap, OnSeveralCoresDrawsTheSameSeriesAsOnOne) {
  std::vector<Cluster> clusters;
  for (int i = 0; i < 1001; ++i) clusters.push_back({0.1 * i * i, 1});
  IntegerRandom random(kBootstrapSeed);
  std::vector<double> means;
  for (int i = 0; i < NumResamples(1001); ++i) {
    double sum = 0;
    for (int k = 0; k < 1001; ++k) {
      sum += clusters[static_cast<std::size_t>(random.In(0, 1000))].sum;
    }
    means.push_back(sum / 1001);
  }
  std::sort(means.begin(), means.end());
  const Estimate mean = BootstrapMean(clusters);
  // The quantiles lie between the 249th and 250th of 9,999 steps.
  EXPECT_DOUBLE_EQ(mean.low, means[249] + 0.975 * (means[250] - means[249]));
  EXPECT_DOUBLE_EQ(mean.high,
                   means[9749] + 0.025 * (means[9750] - means[9749]));
}

TEST(Bootstrap, TermsOfSingleCasesAreClustersOfOne) {
  std::vector<Cluster> clusters;
  std::vector<double> terms;
  for (int i = 0; i < 50; ++i) {
    const bool counts = i % 3 != 0;
    clusters.push_back(counts ? Cluster{0.01 * i * i, 1} : Cluster{});
    terms.push_back(counts ? 0.01 * i * i : kNoTerm);
  }
  const Estimate of_clusters = BootstrapMean(clusters);
  const Estimate of_terms = BootstrapCaseMean(terms);
  EXPECT_EQ(of_terms.value, of_clusters.value);
  EXPECT_EQ(of_terms.low, of_clusters.low);
  EXPECT_EQ(of_terms.high, of_clusters.high);
}

TEST(Bootstrap, OfVeryManyClustersDrawsFewerResamples) {
  EXPECT_EQ(NumResamples(1), 10'000);
  EXPECT_EQ(NumResamples(100'000), 10'000);
  EXPECT_EQ(NumResamples(100'001), 1'000);
  // Half of the cases 1: the mean of n has a standard error of 0.5 / sqrt(n).
  std::vector<Cluster> clusters(200'000, Cluster{0, 1});
  for (std::size_t i = 0; i < clusters.size(); i += 2) clusters[i].sum = 1;
  const double half = 1.96 * 0.5 / std::sqrt(200'000.0);
  const Estimate mean = BootstrapMean(clusters);
  EXPECT_DOUBLE_EQ(mean.value, 0.5);
  EXPECT_NEAR(mean.low, 0.5 - half, 0.2 * half);
  EXPECT_NEAR(mean.high, 0.5 + half, 0.2 * half);
}

// Of five clusters one stands out, so the number of times it is drawn is
// binomial (5, 1/5): at most 2 times with chance 0.942, at most 3 times with
// 0.993. The 97.5 % quantile is 3 times, the 2.5 % quantile 0 times (0.328).
TEST(Bootstrap, EndsAtTheQuantilesOfTheBinomialDistribution) {
  const Estimate one = BootstrapMean(
      std::array<Cluster, 5>{{{0, 1}, {0, 1}, {5, 1}, {0, 1}, {0, 1}}});
  EXPECT_DOUBLE_EQ(one.value, 1);
  EXPECT_DOUBLE_EQ(one.low, 0);
  EXPECT_DOUBLE_EQ(one.high, 3);
  const Estimate four = BootstrapMean(
      std::array<Cluster, 5>{{{5, 1}, {5, 1}, {0, 1}, {5, 1}, {5, 1}}});
  EXPECT_DOUBLE_EQ(four.value, 4);
  EXPECT_DOUBLE_EQ(four.low, 2);
  EXPECT_DOUBLE_EQ(four.high, 5);
}

TEST(Bootstrap, WeighsClustersByTheirTerms) {
  // The cluster that stands out has 3 terms of 1, the others one of 0: drawn 3
  // times of 5 the mean is 9 / (9 + 2).
  const Estimate mean = BootstrapMean(
      std::array<Cluster, 5>{{{3, 3}, {0, 1}, {0, 1}, {0, 1}, {0, 1}}});
  EXPECT_DOUBLE_EQ(mean.value, 3.0 / 7);
  EXPECT_DOUBLE_EQ(mean.low, 0);
  EXPECT_DOUBLE_EQ(mean.high, 9.0 / 11);
}

TEST(Bootstrap, LeavesOutResamplesWithoutATerm) {
  // One cluster of two has terms: all resamples that draw it agree.
  const Estimate mean =
      BootstrapMean(std::array<Cluster, 2>{{{0.5, 1}, {0, 0}}});
  EXPECT_DOUBLE_EQ(mean.low, 0.5);
  EXPECT_DOUBLE_EQ(mean.high, 0.5);
}

TEST(Bootstrap, OfManyValuesComesNearTheNormalInterval) {
  std::vector<Cluster> clusters;
  for (int i = 0; i < 400; ++i) clusters.push_back({i % 2 == 0 ? 0.0 : 1.0, 1});
  const Estimate mean = BootstrapMean(clusters);
  const double half = 1.96 * 0.5 / 20;
  EXPECT_NEAR(mean.low, 0.5 - half, 0.004);
  EXPECT_NEAR(mean.high, 0.5 + half, 0.004);
}

TEST(Bootstrap, DrawsCasesOfOneClusterTogether) {
  // 40 cases in 4 clusters that agree within: far wider than 40 single ones.
  std::vector<Cluster> together;
  std::vector<Cluster> apart;
  for (int k = 0; k < 4; ++k) {
    together.push_back({k * 10.0, 10});
    for (int i = 0; i < 10; ++i) apart.push_back({k * 1.0, 1});
  }
  const Estimate wide = BootstrapMean(together);
  const Estimate narrow = BootstrapMean(apart);
  EXPECT_DOUBLE_EQ(wide.value, narrow.value);
  EXPECT_GT(wide.high - wide.low, 2 * (narrow.high - narrow.low));
}

TEST(NearestRank, IsTheSmallestValueThatCoversTheShare) {
  std::vector<double> twenty;
  for (int i = 1; i <= 20; ++i) twenty.push_back(21 - i);
  EXPECT_EQ(NearestRank(twenty, 95), 19);
  EXPECT_EQ(NearestRank(twenty, 100), 20);
  EXPECT_EQ(NearestRank(twenty, 5), 1);
  EXPECT_EQ(NearestRank({7}, 95), 7);
  EXPECT_EQ(NearestRank({1, 2, 3}, 50), 2);
}

TEST(Median, OfAnEvenNumberIsTheMiddle) {
  EXPECT_EQ(Median({4, 1, 3}), 3);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
}

TEST(Statistics, OfNothingAreACallersBug) {
  EXPECT_THROW(WilsonRate(0, 0), std::logic_error);
  EXPECT_THROW(BootstrapMean({}), std::logic_error);
  EXPECT_THROW(NearestRank({}, 95), std::logic_error);
}

}  // namespace
}  // namespace terra::benchmark
