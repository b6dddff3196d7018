// SPDX-License-Identifier: GPL-3.0-or-later
// The discrete distribution against its weights.
#include "math/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace basicrt {
namespace {

TEST(DiscreteDistribution, probabilities_are_the_weights_shares) {
  const DiscreteDistribution d({1, 0, 3, 4});
  EXPECT_EQ(d.total(), 8);
  EXPECT_DOUBLE_EQ(d.probability(0), 1.0 / 8);
  EXPECT_EQ(d.probability(1), 0);
  EXPECT_DOUBLE_EQ(d.probability(2), 3.0 / 8);
  EXPECT_DOUBLE_EQ(d.probability(3), 4.0 / 8);
}

TEST(DiscreteDistribution, evenly_spread_numbers_choose_by_weight_and_leave_evenly_spread_remainders) {
  const DiscreteDistribution d({0, 2, 0.5, 0, 5.5, 0});
  constexpr int n = 1 << 16;
  std::vector<int> counts(d.size());
  std::vector<double> remainders(d.size());
  for (int i = 0; i < n; ++i) {
    const auto choice = d.choose(static_cast<float>(i) / n);
    ASSERT_GT(choice.probability, 0);
    ASSERT_TRUE(choice.remainder >= 0 && choice.remainder < 1);
    ++counts[choice.index];
    remainders[choice.index] += choice.remainder;
  }
  for (std::uint32_t i = 0; i < d.size(); ++i) {
    EXPECT_NEAR(double(counts[i]) / n, d.probability(i), 2.0 / n);
    if (counts[i] == 0) continue;
    EXPECT_NEAR(remainders[i] / counts[i], 0.5, 1e-3);
  }
}

TEST(DiscreteDistribution, never_chooses_an_entry_without_weight) {
  const DiscreteDistribution d({0, 1, 0, 1, 0, 0});
  for (const float u : {0.0f, 0.25f, 0.49999997f, 0.5f, 0.75f, one_minus_epsilon})
    EXPECT_GT(d.probability(d.choose(u).index), 0) << u;
  EXPECT_EQ(d.choose(0).index, 1u);
  EXPECT_EQ(d.choose(one_minus_epsilon).index, 3u);
}

TEST(DiscreteDistribution, probabilities_of_a_million_random_weights_sum_to_one) {
  constexpr unsigned seed = 3;
  std::mt19937 rng(seed);
  std::vector<double> weights(1000000);
  std::uniform_real_distribution<double> exponent(-6, 0);
  for (double& weight : weights) weight = std::pow(10.0, exponent(rng));
  const DiscreteDistribution d(weights);
  double sum = 0, worst = 0;
  for (std::uint32_t i = 0; i < d.size(); ++i) {
    sum += d.probability(i);
    worst = std::max(worst, std::abs(d.probability(i) * d.total() / weights[i] - 1));
  }
  EXPECT_NEAR(sum, 1, 1e-12) << "seed " << seed;
  EXPECT_LT(worst, 1e-3) << "seed " << seed;
}

TEST(DiscreteDistribution, without_any_weight_has_no_total) {
  EXPECT_EQ(DiscreteDistribution().total(), 0);
  EXPECT_EQ(DiscreteDistribution({0, 0}).total(), 0);
}

TEST(DiscreteDistribution, of_one_entry_hands_the_number_back) {
  const auto choice = DiscreteDistribution({7}).choose(0.3f);
  EXPECT_EQ(choice.index, 0u);
  EXPECT_EQ(choice.probability, 1);
  EXPECT_EQ(choice.remainder, 0.3f);
}

}  // namespace
}  // namespace basicrt
