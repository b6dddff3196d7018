// SPDX-License-Identifier: GPL-3.0-or-later
// Times follow the shutter's curve.
#include "sampling/shutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace basicrt {
namespace {

// The share of times below `end`, from evenly spread numbers.
double share_below(const Shutter& shutter, float end) {
  constexpr int count = 100000;
  int below = 0;
  for (int i = 0; i < count; ++i) below += shutter.sample((static_cast<float>(i) + 0.5f) / count) < end;
  return static_cast<double>(below) / count;
}

// Of the curve, linear between its numbers, by fine steps.
double integral(const std::vector<float>& curve, double end) {
  constexpr int steps = 100000;
  double sum = 0, whole = 0;
  for (int i = 0; i < steps; ++i) {
    const double time = (i + 0.5) / steps, place = time * static_cast<double>(curve.size() - 1);
    const auto span = std::min(static_cast<std::size_t>(place), curve.size() - 2);
    const double part = place - static_cast<double>(span);
    const double open = double{curve[span]} * (1 - part) + double{curve[span + 1]} * part;
    whole += open;
    if (time < end) sum += open;
  }
  return sum / whole;
}

TEST(Shutter, is_wide_open_without_a_curve) {
  for (const float u : {0.0f, 0.3f, 0.999f}) EXPECT_EQ(Shutter().sample(u), u);
}

TEST(Shutter, a_level_curve_changes_nothing_but_rounding) {
  const Shutter shutter({2, 2, 2, 2, 2});
  for (const float u : {0.0f, 0.3f, 0.55f, 0.999f}) EXPECT_NEAR(shutter.sample(u), u, 1e-6f);
}

TEST(Shutter, times_follow_the_curve) {
  const std::vector<std::vector<float>> curves = {{0, 1}, {1, 0}, {0, 1, 0}, {0, 0, 3, 0.5f, 0, 0}, {1, 5}};
  for (const std::vector<float>& curve : curves)
    for (const float end : {0.1f, 0.3f, 0.5f, 0.62f, 0.9f})
      EXPECT_NEAR(share_below(Shutter(curve), end), integral(curve, end), 1e-4) << curve.size() << " up to " << end;
}

TEST(Shutter, times_rise_with_the_number_and_stay_within_the_shutter) {
  const Shutter shutter({0, 2, 0, 1, 0});
  float last = 0;
  for (int i = 0; i < 1000; ++i) {
    const float time = shutter.sample(static_cast<float>(i) / 1000);
    EXPECT_GE(time, last);
    EXPECT_LE(time, 1);
    last = time;
  }
}

}  // namespace
}  // namespace basicrt
