// SPDX-License-Identifier: GPL-3.0-or-later
// Pixel filters: formulas at known places, samples against the formulas.
#include "sampling/filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/constants.h"
#include "support/chi_square.h"

namespace basicrt {
namespace {

using test::Rng;

const std::vector<FilterSettings> all_filters = {{FilterKind::box, 0.5f},   {FilterKind::box, 1.5f},
                                                 {FilterKind::tent, 1},     {FilterKind::gaussian, 1.5f},
                                                 {FilterKind::gaussian, 2}, {FilterKind::blackman_harris, 1.5f},
                                                 {FilterKind::mitchell, 2}, {FilterKind::mitchell, 1.0f}};

std::string name(const FilterSettings& settings) {
  return std::string(enum_names<FilterKind>[static_cast<std::size_t>(settings.kind)]) + " of radius " +
         std::to_string(settings.radius);
}

// The integral of transform(filter) over [-radius, x], by the midpoint rule.
template <class Transform>
double integrate_to(const PixelFilter& filter, float radius, double x, Transform transform) {
  const int steps = 4000;
  const double width = (x + radius) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += transform(filter.eval(static_cast<float>(-radius + (i + 0.5) * width))) * width;
  return sum;
}

TEST(PixelFilter, has_the_values_of_its_formula) {
  const PixelFilter box({FilterKind::box, 0.5f}), tent({FilterKind::tent, 2});
  EXPECT_EQ(box.eval(0.49f), 1);
  EXPECT_EQ(box.eval(-0.51f), 0);
  EXPECT_FLOAT_EQ(tent.eval(-0.5f), 0.75f);
  const PixelFilter gaussian({FilterKind::gaussian, 2});
  EXPECT_FLOAT_EQ(gaussian.eval(0.5f), std::exp(-0.5f) - std::exp(-8.0f));
  EXPECT_EQ(gaussian.eval(2.001f), 0);
  const PixelFilter narrow({.kind = FilterKind::gaussian, .radius = 2, .falloff = 8});
  EXPECT_FLOAT_EQ(narrow.eval(0.5f), std::exp(-2.0f) - std::exp(-32.0f));
  const PixelFilter blackman_harris({FilterKind::blackman_harris, 1.5f});
  EXPECT_FLOAT_EQ(blackman_harris.eval(0), 1);  // the coefficients' sum
  EXPECT_NEAR(blackman_harris.eval(1.5f), 0.35875 - 0.48829 + 0.14128 - 0.01168, 1e-7);
  const PixelFilter mitchell({FilterKind::mitchell, 2});
  EXPECT_FLOAT_EQ(mitchell.eval(0), 8.0f / 9);   // (6 - 2B) / 6
  EXPECT_FLOAT_EQ(mitchell.eval(1), 1.0f / 18);  // B / 6
  EXPECT_NEAR(mitchell.eval(2), 0, 1e-6);
  EXPECT_LT(mitchell.eval(1.5f), 0);
}

// Blender's default filter as measured: standard deviation .4155 pixels, width at half height 1.03 pixels.
TEST(PixelFilter, blackman_harris_has_blenders_width) {
  const PixelFilter filter({FilterKind::blackman_harris, 1.5f});
  double mass = 0, second_moment = 0;
  for (double x = -1.5; x < 1.5; x += 1e-4) {
    mass += filter.eval(static_cast<float>(x));
    second_moment += x * x * filter.eval(static_cast<float>(x));
  }
  EXPECT_NEAR(std::sqrt(second_moment / mass), 0.4155, 5e-4);
  EXPECT_GT(filter.eval(0.51f), 0.5f);
  EXPECT_LT(filter.eval(0.52f), 0.5f);
}

// Kolmogorov and Smirnov: the greatest distance of the empirical from the true distribution of |filter|.
TEST(PixelFilter, samples_follow_the_filter) {
  for (const FilterSettings& settings : all_filters) {
    const PixelFilter filter(settings);
    const int count = 100000;
    Rng rng(11);
    std::vector<float> offsets[2];
    for (int i = 0; i < count; ++i) {
      const Vec2f offset = filter.sample(test::next_unit_vec2(rng)).offset;
      offsets[0].push_back(offset.x);
      offsets[1].push_back(offset.y);
    }
    const auto absolute = [](float f) { return std::abs(f); };
    const double total = integrate_to(filter, settings.radius, settings.radius, absolute);
    for (auto& axis : offsets) {
      std::sort(axis.begin(), axis.end());
      double distance = 0;
      for (int i = 0; i < count; i += 500)
        distance = std::max(distance, std::abs(integrate_to(filter, settings.radius, axis[i], absolute) / total -
                                               static_cast<double>(i) / count));
      EXPECT_LT(distance, 1.95 / std::sqrt(count)) << name(settings) << ", seed 11";  // significance 1e-3
    }
  }
}

TEST(PixelFilter, offsets_are_a_continuous_function_of_the_numbers) {
  for (const FilterSettings& settings : all_filters) {
    const PixelFilter filter(settings);
    float previous = filter.sample({0, 0.5f}).offset.x;
    EXPECT_NEAR(previous, -settings.radius, 1e-6f) << name(settings);
    const int steps = 1 << 16;
    for (int i = 1; i <= steps; ++i) {
      const float u = std::min(static_cast<float>(i) / steps, one_minus_epsilon);
      const float offset = filter.sample({u, 0.5f}).offset.x;
      EXPECT_GE(offset, previous) << name(settings);
      // Where a filter goes to zero the tails are drawn out: but no step may cross a twentieth of the support.
      EXPECT_LT(offset - previous, settings.radius / 10) << name(settings) << " at " << u;
      previous = offset;
    }
    EXPECT_LE(previous, settings.radius) << name(settings);
  }
}

// A pixel's value for radiance exp(x + y) is the filter's integral against it, whatever the signs of the samples.
TEST(PixelFilter, means_of_both_signs_reproduce_integrals) {
  for (const FilterSettings& settings : all_filters) {
    const PixelFilter filter(settings);
    double expected = 0, mass = 0;
    for (int i = 0; i < 20000; ++i) {
      const double x = settings.radius * ((i + 0.5) / 10000 - 1);
      expected += std::exp(x) * filter.eval(static_cast<float>(x));
      mass += filter.eval(static_cast<float>(x));
    }
    expected *= expected / (mass * mass);  // along y, too

    Rng rng(5);
    struct Sum {
      double value = 0, square = 0;
      int count = 0;
      [[nodiscard]] double mean() const { return count > 0 ? value / count : 0; }
      [[nodiscard]] double variance() const { return count > 0 ? (square / count - mean() * mean()) / count : 0; }
    } sums[2];
    const int count = 1 << 20;
    for (int i = 0; i < count; ++i) {
      const FilterSample sample = filter.sample(test::next_unit_vec2(rng));
      const double value = std::exp(sample.offset.x + sample.offset.y);
      Sum& sum = sums[sample.is_negative ? 1 : 0];
      sum.value += value;
      sum.square += value * value;
      ++sum.count;
    }
    const double n = filter.negative_mass();
    const double deviation = std::sqrt((1 + n) * (1 + n) * sums[0].variance() + n * n * sums[1].variance());
    EXPECT_NEAR((1 + n) * sums[0].mean() - n * sums[1].mean(), expected, 4 * deviation + 1e-4) << name(settings);
    // As many of each sign as there is mass of it.
    EXPECT_NEAR(static_cast<double>(sums[1].count) / count, n / (1 + 2 * n), 2e-3) << name(settings);
  }
}

TEST(PixelFilter, only_mitchell_has_negative_samples) {
  for (const FilterSettings& settings : all_filters) {
    const PixelFilter filter(settings);
    Rng rng(3);
    bool has_negative = false;
    for (int i = 0; i < 10000; ++i) has_negative |= filter.sample(test::next_unit_vec2(rng)).is_negative;
    EXPECT_EQ(has_negative, settings.kind == FilterKind::mitchell) << name(settings);
    EXPECT_EQ(filter.negative_mass() > 0, has_negative) << name(settings);
  }
}

}  // namespace
}  // namespace basicrt
