// SPDX-License-Identifier: GPL-3.0-or-later
// Sums that no order changes, and ranges of samples that add up.
#include "film/exact_sum.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "film/film.h"

namespace basicrt {
namespace {

TEST(ExactSum, small_numbers_survive_large_ones) {
  ExactSum sum;
  for (const float value : {0x1p40f, 0x1p-40f, -0x1p40f}) sum.add(value);
  EXPECT_EQ(sum.to_float(), 0x1p-40f);
}

TEST(ExactSum, negative_sums_come_back) {
  ExactSum sum;
  for (const float value : {0.1f, -0.35f, -7.0f}) sum.add(value);
  EXPECT_EQ(sum.to_float(), static_cast<float>(double{0.1f} - double{0.35f} - 7));
  EXPECT_EQ(ExactSum::from_words(sum.words().data()).to_float(), sum.to_float());
}

TEST(ExactSum, infinity_and_what_is_no_number_are_cut) {
  for (const float value : {INFINITY, std::nanf("")}) {
    ExactSum sum;
    sum.add(value);
    EXPECT_EQ(sum.to_float(), 0x1p42f);
  }
}

TEST(ExactSum, the_order_does_not_matter) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-30, 30), mantissa(-1, 1);
  std::vector<float> values(1000);
  for (float& value : values) value = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
  ExactSum forwards, first, second;
  for (const float value : values) forwards.add(value);
  for (std::size_t i = values.size(); i-- > 0;) (i % 3 == 0 ? first : second).add(values[i]);
  second.add(first);
  EXPECT_EQ(second.words(), forwards.words());
}

// Samples as wild as any, with hits from the 5th on.
PixelSample sample_of(int i) {
  std::mt19937 random(static_cast<unsigned>(i));
  std::uniform_real_distribution<float> value(0, 1);
  const float scale = std::ldexp(1.0f, i % 40 - 20);
  return {.radiance = Color(value(random), value(random), value(random)) * scale,
          .alpha = value(random),
          .has_hit = i >= 5,
          .depth = static_cast<float>(i),
          .normal = {value(random), 0, 1}};
}

TEST(TileAccumulator, ranges_of_samples_add_up_to_all_of_them) {
  constexpr int samples = 400;
  PassLayout layout;
  for (const Pass pass : {Pass::depth, Pass::normal, Pass::position, Pass::emission}) layout.enable(pass);
  const auto make = [&](int from, int to) {
    TileAccumulator accumulator({0, 0, 1, 1}, layout, {.negative_mass = 0.1f, .samples = samples});
    for (int i = from; i < to; ++i) {
      const float x = static_cast<float>(i);
      const std::array values = {x, 1.0f, 2.0f, x / 3, x / 7, x / 11};
      accumulator.add(0, 0, sample_of(i), i % 5 == 0, values);
    }
    return accumulator;
  };
  const std::vector<float> expected = make(0, samples).finish().values;
  for (const std::vector<int>& ends :
       {std::vector<int>{0, 400}, {0, 64, 400}, {0, 192, 256, 400}, {0, 64, 128, 192, 256, 320, 384, 400}}) {
    TileAccumulator merged({0, 0, 1, 1}, layout, {.negative_mass = 0.1f, .samples = samples});
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) merged.add_words(make(ends[i], ends[i + 1]).take_words());
    EXPECT_EQ(merged.finish().values, expected) << ends.size();
  }
}

}  // namespace
}  // namespace basicrt
