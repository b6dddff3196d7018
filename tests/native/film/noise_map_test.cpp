// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive sampling's decisions.
#include "film/noise_map.h"

#include <gtest/gtest.h>

namespace basicrt {
namespace {

// Ten samples that are 0 or 2 in r + g + b by turns: the mean is 1, the standard error 1 / 3.
void add_noise(NoiseMap& noise, int x, int y) {
  for (int i = 0; i < 10; ++i) noise.add(x, y, i % 2 ? Color(1, 1, 0) : Color(0.0f));
}

TEST(NoiseMap, closes_blocks_whose_pixels_are_all_below_the_threshold) {
  NoiseMap noise(8, 4, 0.1f);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x)
      for (int i = 0; i < 10; ++i)
        if (x != 5 || y != 3) noise.add(x, y, Color(1.0f));
  add_noise(noise, 5, 3);
  EXPECT_EQ(noise.update(10), 16);
  EXPECT_FALSE(noise.is_open(3, 0));
  EXPECT_TRUE(noise.is_open(4, 0));
  EXPECT_TRUE(noise.has_open());
}

TEST(NoiseMap, an_error_is_the_standard_error_over_the_root_of_the_mean) {
  for (const auto& [threshold, is_open] : {std::pair(0.33f, true), std::pair(0.34f, false)}) {
    NoiseMap noise(1, 1, threshold);
    add_noise(noise, 0, 0);
    noise.update(10);
    EXPECT_EQ(noise.is_open(0, 0), is_open) << threshold;
  }
}

TEST(NoiseMap, black_has_no_noise_and_what_is_closed_stays_so) {
  NoiseMap noise(5, 5, 0.1f);
  for (int i = 0; i < 4; ++i)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 5; ++x) noise.add(x, y, Color(0.0f));
  EXPECT_EQ(noise.update(4), 25);
  EXPECT_FALSE(noise.has_open());
  EXPECT_EQ(noise.update(8), 0);
}

}  // namespace
}  // namespace basicrt
