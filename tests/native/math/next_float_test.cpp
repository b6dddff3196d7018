// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbouring floats against the standard library's.
#include "math/next_float.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace basicrt {
namespace {

TEST(NextFloat, agrees_with_the_standard_library) {
  std::mt19937 rng(5);
  std::vector<float> values{0.0f, -0.0f, 1.0f, -1.0f, infinity, -infinity};
  for (const float edge :
       {std::numeric_limits<float>::max(), std::numeric_limits<float>::min(), std::numeric_limits<float>::denorm_min()})
    values.insert(values.end(), {edge, -edge});
  for (int i = 0; i < 100000; ++i) values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(rng())));
  for (const float x : values) {
    if (std::isnan(x)) {
      EXPECT_TRUE(std::isnan(next_float_up(x)));
      continue;
    }
    EXPECT_EQ(next_float_up(x), std::nextafter(x, infinity)) << x;
    EXPECT_EQ(next_float_down(x), std::nextafter(x, -infinity)) << x;
  }
}

}  // namespace
}  // namespace basicrt
