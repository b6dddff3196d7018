// SPDX-License-Identifier: GPL-3.0-or-later
// Owen-scrambled Sobol points: the definition of the sequence, stratification, uniformity, convergence.
#include "sampling/sobol.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/chi_square.h"

namespace basicrt {
namespace {

using test::Rng;

std::uint32_t next_seed(Rng& rng) { return static_cast<std::uint32_t>(rng() >> 32); }

// Sobol's second dimension by its direction numbers: each is the one before, xored with itself halved.
std::uint32_t second_dimension(std::uint32_t index) {
  std::uint32_t sum = 0;
  for (std::uint32_t direction = 1u << 31; index != 0; index >>= 1, direction ^= direction >> 1)
    if (index & 1) sum ^= direction;
  return sum;
}

TEST(Sobol, second_dimension_is_pascals_triangle) {
  Rng rng(1);
  for (int i = 0; i < 10000; ++i) {
    const std::uint32_t index = i < 5000 ? static_cast<std::uint32_t>(i) : next_seed(rng);
    ASSERT_EQ(reverse_bits(pascal_product(index)), second_dimension(index)) << index;
  }
}

// By the definition: direction numbers m of the polynomial x^2 + x + 1, m_k = 2 m_(k-1) ^ 4 m_(k-2) ^ m_(k-2), from 1 and 3.
TEST(Sobol, third_dimension_is_that_of_its_polynomial) {
  std::array<std::uint64_t, 32> m{1, 3};
  for (std::size_t k = 2; k < 32; ++k) m[k] = (2 * m[k - 1]) ^ (4 * m[k - 2]) ^ m[k - 2];
  Rng rng(7);
  for (int i = 0; i < 10000; ++i) {
    const std::uint32_t index = i < 5000 ? static_cast<std::uint32_t>(i) : next_seed(rng);
    std::uint32_t sum = 0;
    for (std::size_t bit = 0; bit < 32; ++bit)
      if (index >> bit & 1) sum ^= static_cast<std::uint32_t>(m[bit] << (31 - bit));
    ASSERT_EQ(reverse_bits(third_product(index)), sum) << index;
  }
}

// What a choice between a few things leaves of the points for each of them: one in each of half as many rectangles, or
// two.
TEST(Sobol, points_of_one_choice_are_spread_evenly) {
  Rng rng(8);
  for (int round = 0; round < 20; ++round) {
    const std::uint32_t seed_x = next_seed(rng), seed_y = next_seed(rng), seed_third = next_seed(rng);
    constexpr int count = 256;
    for (const int choices : {2, 4}) {
      for (int k = 0; k <= 5; ++k) {
        const int columns = 1 << k, rows = count / choices / 2 / columns;
        if (rows == 0) continue;
        std::vector<int> hits(count / 2);
        for (std::uint32_t i = 0; i < count; ++i) {
          const Vec2f p = sobol_2d(i, seed_x, seed_y);
          const auto chosen = static_cast<int>(sobol_third(i, seed_third) * static_cast<float>(choices));
          ++hits[(chosen * rows + static_cast<int>(p.y * static_cast<float>(rows))) * columns +
                 static_cast<int>(p.x * static_cast<float>(columns))];
        }
        for (const int hit : hits) ASSERT_EQ(hit, 2) << choices << " choices, " << columns << " x " << rows;
      }
    }
  }
}

TEST(Sobol, reversing_bits_twice_changes_nothing) {
  EXPECT_EQ(reverse_bits(std::uint32_t{1}), 0x80000000u);
  EXPECT_EQ(reverse_bits(std::uint64_t{0xd}), 0xb000000000000000u);
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t bits = rng();
    EXPECT_EQ(reverse_bits(reverse_bits(bits)), bits);
    EXPECT_EQ(reverse_bits(reverse_bits(static_cast<std::uint32_t>(bits))), static_cast<std::uint32_t>(bits));
  }
}

// The defining property of a nested scramble: two numbers part at the same digit before and after.
TEST(Sobol, scrambles_keep_the_first_differing_bit) {
  Rng rng(3);
  for (int i = 0; i < 10000; ++i) {
    const std::uint32_t seed = next_seed(rng), a = next_seed(rng), b = a ^ (next_seed(rng) >> (rng() & 31));
    if (a == b) continue;
    const std::uint32_t before = a ^ b, after = owen_scramble(a, seed) ^ owen_scramble(b, seed);
    EXPECT_EQ(std::countl_zero(before), std::countl_zero(after));
  }
}

// After the digit at which two numbers part, what was flipped of one says nothing of what was flipped of the other:
// for each pair of digits, over many seeds, half of the numbers agree.
TEST(Sobol, scrambles_forget_below_the_first_differing_bit) {
  Rng rng(4);
  constexpr int rounds = 20000;
  for (int parting = 0; parting < 24; ++parting) {
    std::array<int, 32> agreements{};
    for (int i = 0; i < rounds; ++i) {
      const std::uint32_t seed = next_seed(rng), a = static_cast<std::uint32_t>(i) << 16,
                          b = a ^ (0x80000000u >> parting);
      const std::uint32_t flips = owen_scramble(a, seed) ^ a ^ owen_scramble(b, seed) ^ b;
      for (int digit = 0; digit < 32; ++digit) agreements[digit] += (flips >> (31 - digit) & 1) == 0;
    }
    for (int digit = 0; digit < 32; ++digit) {
      if (digit <= parting) {
        EXPECT_EQ(agreements[digit], rounds) << "digit " << digit << " of numbers that part at " << parting;
      } else {
        EXPECT_NEAR(agreements[digit], rounds / 2, 0.06 * rounds)
            << "digit " << digit << " of numbers that part at " << parting;
      }
    }
  }
}

// Every aligned block of 2^n points has one in each of the 2^n rectangles of every grid with 2^n cells.
TEST(Sobol, aligned_blocks_have_a_point_in_every_elementary_interval) {
  Rng rng(5);
  for (int round = 0; round < 20; ++round) {
    const std::uint32_t seed_x = next_seed(rng), seed_y = next_seed(rng), block = next_seed(rng) & 7;
    for (int n = 0; n <= 10; ++n) {
      const std::uint32_t count = 1u << n;
      for (int k = 0; k <= n; ++k) {
        const int columns = 1 << k, rows = 1 << (n - k);
        std::vector<int> hits(count);
        for (std::uint32_t i = 0; i < count; ++i) {
          const Vec2f p = sobol_2d(block * count + i, seed_x, seed_y);
          ++hits[static_cast<int>(p.y * static_cast<float>(rows)) * columns +
                 static_cast<int>(p.x * static_cast<float>(columns))];
        }
        for (const int hit : hits) ASSERT_EQ(hit, 1) << columns << " x " << rows << ", block " << block;
      }
    }
  }
}

TEST(Sobol, numbers_of_one_dimension_are_the_first_of_two) {
  Rng rng(6);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const std::uint32_t seed = next_seed(rng);
    EXPECT_EQ(sobol_1d(i, seed), sobol_2d(i, seed, 0).x);
  }
}

// Each single point, over all scrambles, is uniform over the square.
TEST(Sobol, points_are_uniform_over_scrambles) {
  for (const std::uint32_t index : {0u, 1u, 5u, 31u, 1000u}) {
    const auto result = test::chi_square_square(
        [&](Rng& rng) { return std::optional(Vec2d(sobol_2d(index, next_seed(rng), next_seed(rng)))); },
        [](Vec2d) { return 1.0; }, {.seed = 7 + index});
    EXPECT_GT(result.p_value, test::sidak_threshold(5)) << "index " << index << ": " << result.describe();
  }
}

// Variance of the mean of `count` points of a smooth function whose integral is 1, over many scrambles.
template <class PointOf>
double variance_of_mean(std::uint32_t count, PointOf point_of) {
  Rng rng(8);
  constexpr int rounds = 400;
  double sum = 0;
  for (int round = 0; round < rounds; ++round) {
    const std::uint32_t seed_x = next_seed(rng), seed_y = next_seed(rng);
    double mean = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec2d p(point_of(i, seed_x, seed_y, rng));
      mean += std::numbers::pi * std::numbers::pi / 4 * std::sin(std::numbers::pi * p.x) *
              std::sin(std::numbers::pi * p.y) / count;
    }
    sum += (mean - 1) * (mean - 1) / rounds;
  }
  return sum;
}

// Owen 1997, "Scrambled net variance for integrals of smooth functions": N^-3 (log N), against 1/N of random points.
TEST(Sobol, variance_falls_nearly_with_the_cube_of_the_number_of_points) {
  const auto sobol = [](std::uint32_t i, std::uint32_t x, std::uint32_t y, Rng&) { return sobol_2d(i, x, y); };
  const auto random = [](std::uint32_t, std::uint32_t, std::uint32_t, Rng& rng) { return test::next_unit_vec2(rng); };
  const double at_16 = variance_of_mean(16, sobol), at_1024 = variance_of_mean(1024, sobol);
  EXPECT_GT(std::log2(at_16 / at_1024) / 6, 2.5);
  EXPECT_NEAR(std::log2(variance_of_mean(16, random) / variance_of_mean(1024, random)) / 6, 1, 0.1);
  EXPECT_LT(at_16, variance_of_mean(16, random) / 5);
  EXPECT_LT(at_1024, variance_of_mean(1024, random) / 5000);
}

}  // namespace
}  // namespace basicrt
