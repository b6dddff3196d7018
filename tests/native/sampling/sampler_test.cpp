// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of paths: uniform, spread evenly over a pixel's samples, unrelated between draws and between pixels.
#include "sampling/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "support/chi_square.h"

namespace basicrt {
namespace {

constexpr std::uint64_t seed = 20261122;
constexpr std::array kinds = {SamplerKind::sobol, SamplerKind::independent};

std::string name(SamplerKind kind) { return std::string(enum_names<SamplerKind>[static_cast<std::size_t>(kind)]); }

// The n-th pair (counted from 0) of a pixel's sample.
Vec2f pair_of(SamplerKind kind, Vec2i pixel, std::uint32_t sample, int n, std::uint64_t with_seed = seed) {
  Sampler sampler = Sampler(kind, pixel, with_seed).at_sample(sample);
  for (int i = 0; i < n; ++i) (void)sampler.next_2d();
  return sampler.next_2d();
}

int cell_of(float u, int cells) { return static_cast<int>(u * static_cast<float>(cells)); }

// Chi-square of counts that should all be alike.
double uniform_p_value(const std::vector<int>& counts) {
  double total = 0, statistic = 0;
  for (const int count : counts) total += count;
  const double expected = total / static_cast<double>(counts.size());
  for (const int count : counts) statistic += (count - expected) * (count - expected) / expected;
  return test::upper_gamma_q(static_cast<double>(counts.size() - 1) / 2, statistic / 2);
}

TEST(Sampler, the_same_coordinates_give_the_same_numbers) {
  for (const SamplerKind kind : kinds) {
    Sampler a = Sampler(kind, {3, 4}, seed).at_sample(5), b = a;
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(a.next_1d(), b.next_1d());
      EXPECT_EQ(a.next_2d(), b.next_2d());
    }
    for (int n = 0; n < 4; ++n) {
      const Vec2f p = pair_of(kind, {3, 4}, 5, n);
      EXPECT_NE(p, pair_of(kind, {4, 3}, 5, n));
      EXPECT_NE(p, pair_of(kind, {3, 4}, 6, n));
      EXPECT_NE(p, pair_of(kind, {3, 4}, 5, n + 1));
      EXPECT_NE(p, pair_of(kind, {3, 4}, 5, n, seed + 1));
    }
  }
}

TEST(Sampler, every_draw_is_stratified_over_each_power_of_two_of_samples) {
  for (int pixel = 0; pixel < 10; ++pixel) {
    for (int draw = 0; draw < 12; ++draw) {
      for (int n = 0; n <= 8; ++n) {
        const int count = 1 << n;
        std::vector<int> numbers(count);
        std::vector<std::vector<int>> pairs(n + 1, std::vector<int>(count));
        for (int i = 0; i < count; ++i) {
          Sampler before = Sampler(SamplerKind::sobol, {pixel, 7}, seed).at_sample(static_cast<std::uint32_t>(i));
          for (int skipped = 0; skipped < draw; ++skipped) (void)before.next_1d();
          Sampler after = before;
          ++numbers[cell_of(before.next_1d(), count)];
          const Vec2f p = after.next_2d();
          for (int k = 0; k <= n; ++k) ++pairs[k][(cell_of(p.y, count >> k) << k) + cell_of(p.x, 1 << k)];
        }
        EXPECT_EQ(numbers, std::vector<int>(count, 1)) << count << " samples, draw " << draw;
        for (const auto& grid : pairs)
          ASSERT_EQ(grid, std::vector<int>(count, 1)) << count << " samples, draw " << draw;
      }
    }
  }
}

TEST(Sampler, pairs_that_come_with_a_choice_are_spread_evenly_for_each) {
  constexpr int count = 64, per_choice = count / 2;
  for (int pixel = 0; pixel < 10; ++pixel) {
    for (int draw = 0; draw < 12; ++draw) {
      std::vector<int> choices(count), pairs(count), cells_of_choice(per_choice);
      for (int i = 0; i < count; ++i) {
        Sampler sampler = Sampler(SamplerKind::sobol, {pixel, 7}, seed).at_sample(static_cast<std::uint32_t>(i));
        for (int skipped = 0; skipped < draw; ++skipped) (void)sampler.next_1d();
        const auto [choice, u] = sampler.next_choice();
        ++choices[cell_of(choice, count)];
        ++pairs[8 * cell_of(u.y, 8) + cell_of(u.x, 8)];
        ++cells_of_choice[(cell_of(choice, 2) * 4 + cell_of(u.y, 4)) * 4 + cell_of(u.x, 4)];
      }
      EXPECT_EQ(choices, std::vector<int>(count, 1)) << "draw " << draw;
      EXPECT_EQ(pairs, std::vector<int>(count, 1)) << "draw " << draw;
      ASSERT_EQ(cells_of_choice, std::vector<int>(per_choice, 2)) << "draw " << draw;
    }
  }
}

// Over pixels, where nothing is spread: the three numbers' cells, 8 x 8 x 8, are met alike.
TEST(Sampler, choices_and_pairs_are_unrelated_over_pixels) {
  for (const SamplerKind kind : kinds) {
    for (const std::uint32_t sample : {0u, 17u}) {
      std::vector<int> counts(512);
      for (int i = 0; i < 256 * 256; ++i) {
        Sampler sampler = Sampler(kind, {i & 255, i >> 8}, seed).at_sample(sample);
        (void)sampler.next_2d();
        const auto [choice, u] = sampler.next_choice();
        ++counts[64 * cell_of(choice, 8) + 8 * cell_of(u.y, 8) + cell_of(u.x, 8)];
      }
      EXPECT_GT(uniform_p_value(counts), test::sidak_threshold(4)) << name(kind) << ", sample " << sample;
    }
  }
}

TEST(Sampler, pairs_are_uniform_over_pixels) {
  for (const SamplerKind kind : kinds) {
    for (const int n : {0, 1, 5}) {
      for (const std::uint32_t sample : {0u, 1u, 17u}) {
        std::vector<int> counts(256);
        for (int i = 0; i < 256 * 256; ++i) {
          const Vec2f p = pair_of(kind, {i & 255, i >> 8}, sample, n);
          ++counts[16 * cell_of(p.y, 16) + cell_of(p.x, 16)];
        }
        EXPECT_GT(uniform_p_value(counts), test::sidak_threshold(18))
            << name(kind) << ", pair " << n << " of " << sample;
      }
    }
  }
}

// Counts in the cells of four dimensions, 4 x 4 x 4 x 4, are alike where the pairs have nothing to do with each other.
// One sample of each pixel, for the samples of one pixel are not independent.
void expect_unrelated(const std::function<std::array<Vec2f, 2>(int)>& pairs_of, const std::string& what) {
  std::vector<int> counts(256);
  for (int i = 0; i < 256 * 256; ++i) {
    const auto [p, q] = pairs_of(i);
    ++counts[64 * cell_of(p.x, 4) + 16 * cell_of(p.y, 4) + 4 * cell_of(q.x, 4) + cell_of(q.y, 4)];
  }
  EXPECT_GT(uniform_p_value(counts), test::sidak_threshold(30)) << what;
}

TEST(Sampler, neighbouring_pixels_and_other_seeds_are_unrelated) {
  for (const SamplerKind kind : kinds) {
    for (const std::uint32_t sample : {0u, 3u}) {
      const auto at = [&](int i) { return Vec2i{2 * (i & 255), 2 * (i >> 8)}; };
      const auto pair = [&](Vec2i pixel, std::uint64_t with_seed) {
        return pair_of(kind, pixel, sample, 0, with_seed);
      };
      expect_unrelated([&](int i) { return std::array{pair(at(i), seed), pair(at(i) + Vec2i{1, 0}, seed)}; },
                       name(kind));
      expect_unrelated([&](int i) { return std::array{pair(at(i), seed), pair(at(i) + Vec2i{0, 1}, seed)}; },
                       name(kind));
      expect_unrelated([&](int i) { return std::array{pair(at(i), seed), pair(at(i), seed + 1)}; }, name(kind));
    }
  }
}

// Over many pixels, a pixel's samples are in any two draws together as often in each of the cells.
TEST(Sampler, draws_are_unrelated) {
  for (const SamplerKind kind : kinds)
    for (const std::array<int, 2> draws : {std::array{0, 1}, {0, 2}, {1, 2}, {3, 8}})
      for (const std::uint32_t sample : {0u, 3u})
        expect_unrelated(
            [&](int i) {
              const Vec2i pixel{i & 255, i >> 8};
              return std::array{pair_of(kind, pixel, sample, draws[0]), pair_of(kind, pixel, sample, draws[1])};
            },
            name(kind) + ", pairs " + std::to_string(draws[0]) + " and " + std::to_string(draws[1]));
}

// Two draws go through their sequences in different orders: over a pixel's 64 samples the correlation of one with the
// other is about that of 64 random points, however evenly each is spread by itself. (A little more: shuffled by blocks,
// the samples 2i and 2i + 1 always differ in the first digit of both, so that only half of those are by chance.)
TEST(Sampler, orders_of_draws_are_unrelated_within_a_pixel) {
  constexpr int pixels = 4000, samples = 64;
  for (const std::array<int, 2> draws : {std::array{0, 1}, {1, 2}, {2, 7}}) {
    double sum = 0, square = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      double correlation = 0;  // of coordinates of variance 1/12
      for (std::uint32_t i = 0; i < samples; ++i) {
        const float x = pair_of(SamplerKind::sobol, {pixel, 1}, i, draws[0]).x;
        const float y = pair_of(SamplerKind::sobol, {pixel, 1}, i, draws[1]).x;
        correlation += 12 * (x - 0.5) * (y - 0.5) / samples;
      }
      sum += correlation;
      square += correlation * correlation;
    }
    const double deviation = std::sqrt(1.0 / samples), seen = std::sqrt(square / pixels);
    EXPECT_NEAR(sum / pixels, 0, 4 * seen / std::sqrt(pixels));
    EXPECT_GT(seen, 0.9 * deviation);
    EXPECT_LT(seen, 1.4 * deviation);
  }
}

// A smooth function of the first pair and, less, of the second: what a pixel with a soft light is.
TEST(Sampler, sobol_converges_faster_than_independent_samples) {
  const auto error_of = [&](SamplerKind kind, std::uint32_t samples) {
    double square = 0;
    constexpr int pixels = 500;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      double mean = 0;
      for (std::uint32_t i = 0; i < samples; ++i) {
        Sampler sampler = Sampler(kind, {pixel, 0}, seed).at_sample(i);
        const Vec2d p(sampler.next_2d()), q(sampler.next_2d());
        mean += (std::exp(p.x + p.y) + std::cos(q.x) * q.y) / samples;
      }
      const double expected = std::pow(std::exp(1.0) - 1, 2) + std::sin(1.0) / 2;
      square += (mean - expected) * (mean - expected) / pixels;
    }
    return square;
  };
  const double sobol = error_of(SamplerKind::sobol, 16), sobol_later = error_of(SamplerKind::sobol, 256);
  const double plain = error_of(SamplerKind::independent, 16), plain_later = error_of(SamplerKind::independent, 256);
  SCOPED_TRACE("sobol " + std::to_string(sobol) + ", independent " + std::to_string(plain));
  EXPECT_LT(sobol, plain / 10);
  EXPECT_GT(std::log2(sobol / sobol_later) / 4, 2.5);
  EXPECT_NEAR(std::log2(plain / plain_later) / 4, 1, 0.15);
}

}  // namespace
}  // namespace basicrt
