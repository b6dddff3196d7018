// SPDX-License-Identifier: GPL-3.0-or-later
// Packed numbers behave as the same operations on one number, NaNs and signed zeros included.
#include "math/simd.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace basicrt {
namespace {

const std::vector<float> interesting{0.0f,
                                     -0.0f,
                                     1.5f,
                                     -2.25f,
                                     std::numeric_limits<float>::denorm_min(),
                                     std::numeric_limits<float>::max(),
                                     std::numeric_limits<float>::infinity(),
                                     -std::numeric_limits<float>::infinity(),
                                     std::numeric_limits<float>::quiet_NaN()};

// Bits equal, or both not a number.
void expect_same(float a, float b) {
  if (std::isnan(a) && std::isnan(b)) return;
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b)) << a << " " << b;
}

float lane(Float4 packed, int index) {
  alignas(16) float values[4];
  packed.store(values);
  return values[index];
}

TEST(Simd, four_floats_compute_as_one_does) {
  for (const float x : interesting)
    for (const float y : interesting) {
      const Float4 a = Float4::of(1, x, 2, x), b = Float4::of(3, y, 4, y);
      for (const int i : {1, 3}) {
        expect_same(lane(a + b, i), x + y);
        expect_same(lane(a - b, i), x - y);
        expect_same(lane(a * b, i), x * y);
        expect_same(lane(a / b, i), x / y);
        expect_same(lane(max(a, b), i), x > y ? x : y);
        expect_same(lane(min(a, b), i), x < y ? x : y);
        expect_same(lane(abs(a), i), std::fabs(x));
        expect_same(lane(copysign(a, b), i), std::copysign(x, y));
        expect_same(lane(select(a <= b, a, b), i), x <= y ? x : y);
        EXPECT_EQ((a < b).bits() >> i & 1, x < y);
        EXPECT_EQ((a <= b).bits() >> i & 1, x <= y);
        EXPECT_EQ((a == b).bits() >> i & 1, x == y);
      }
      EXPECT_EQ(((a <= b) & (b <= a)).bits(), (a <= b).bits() & (b <= a).bits());
      EXPECT_EQ(((a <= b) | (b <= a)).bits(), (a <= b).bits() | (b <= a).bits());
    }
}

TEST(Simd, lanes_keep_their_places) {
  const Float4 a = Float4::of(1, -2, 3, -0.0f);
  EXPECT_EQ(a.sign_bits(), 0b1010);
  EXPECT_EQ((Float4::all(2) <= a).bits(), 0b0100);
  EXPECT_EQ(lane(a.broadcast<1>(), 3), -2);
  EXPECT_EQ(lane(a.broadcast<2>(), 0), 3);
  alignas(16) const float values[4] = {5, 6, 7, 8};
  EXPECT_EQ(lane(Float4::load(values), 2), 7);
}

TEST(Simd, three_vectors_are_transposed) {
  Float4 a = Float4::of(1, 2, 3, 4), b = Float4::of(5, 6, 7, 8), c = Float4::of(9, 10, 11, 12);
  transpose(a, b, c);
  const float expected[3][3] = {{1, 5, 9}, {2, 6, 10}, {3, 7, 11}};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(lane(a, i), expected[0][i]);
    EXPECT_EQ(lane(b, i), expected[1][i]);
    EXPECT_EQ(lane(c, i), expected[2][i]);
  }
}

TEST(Simd, four_integers_compute_as_one_does) {
  alignas(16) const std::int32_t values[4] = {7, -7, 1 << 20, -(1 << 20)};
  alignas(16) std::int32_t sum[4], quotient[4], truncated[4];
  const Int4 a = Int4::load(values);
  (a + Int4::all(3)).store(sum);
  a.shifted_right<2>().store(quotient);
  (Float4::from(a) * Float4::all(0.3f)).truncated().store(truncated);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(sum[i], values[i] + 3);
    EXPECT_EQ(quotient[i], static_cast<std::int32_t>(std::floor(values[i] / 4.0)));
    EXPECT_EQ(truncated[i], static_cast<std::int32_t>(static_cast<float>(values[i]) * 0.3f));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.first_three()[i], static_cast<std::uint32_t>(values[i]));
  }
}

TEST(Simd, two_doubles_compute_as_one_does) {
  const float pair[2] = {3.5f, -0.25f};
  const Double2 a = Double2::from_floats(pair), b = Double2::all(0.1);
  alignas(16) double sum[2], difference[2], product[2], quotient[2];
  (a + b).store(sum);
  (a - b).store(difference);
  (a * b).store(product);
  (a / b).store(quotient);
  for (int i = 0; i < 2; ++i) {
    const double x = double{pair[i]};
    EXPECT_EQ(sum[i], x + 0.1);
    EXPECT_EQ(difference[i], x - 0.1);
    EXPECT_EQ(product[i], x * 0.1);
    EXPECT_EQ(quotient[i], x / 0.1);
  }
  EXPECT_EQ((b <= a).bits(), 0b01);
  EXPECT_EQ(((b <= a) & (a <= a)).bits(), 0b01);
  EXPECT_EQ((Double2::all(std::numeric_limits<double>::quiet_NaN()) <= a).bits(), 0);
}

}  // namespace
}  // namespace basicrt
