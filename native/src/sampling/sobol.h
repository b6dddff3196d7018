// SPDX-License-Identifier: GPL-3.0-or-later
// The first three dimensions of Sobol's sequence, Owen-scrambled.
#pragma once

#include <array>
#include <cstdint>

#include "math/hash.h"
#include "math/vec.h"
#include "sampling/owen_scramble.h"

namespace basicrt {

// The matrix of Sobol's second dimension is Pascal's triangle modulo two; this is its product with `index`, lowest
// digit first (Ahmed 2024, "An implementation algorithm of 2D Sobol sequence fast, elegant, and compact").
constexpr std::uint32_t pascal_product(std::uint32_t index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

// Products of the matrix of Sobol's third dimension with each byte of an index, lowest digit first. Its direction numbers
// come of the primitive polynomial x^2 + x + 1 and of 1 and 3 (Bratley and Fox 1988, "Algorithm 659").
constexpr auto third_products = [] {
  std::array<std::uint32_t, 32> directions{1u << 31, 3u << 30};
  for (std::size_t i = 2; i < 32; ++i) directions[i] = directions[i - 1] ^ directions[i - 2] ^ directions[i - 2] >> 2;
  std::array<std::array<std::uint32_t, 256>, 4> products{};
  for (std::size_t byte = 0; byte < 4; ++byte)
    for (std::size_t value = 0; value < 256; ++value)
      for (std::size_t bit = 0; bit < 8; ++bit)
        if (value >> bit & 1) products[byte][value] ^= reverse_bits(directions[8 * byte + bit]);
  return products;
}();
constexpr std::uint32_t third_product(std::uint32_t index) {
  return third_products[0][index & 0xff] ^ third_products[1][index >> 8 & 0xff] ^
         third_products[2][index >> 16 & 0xff] ^ third_products[3][index >> 24];
}

// The index-th number of van der Corput's sequence, Owen-scrambled: each aligned block of 2^n has one number in each
// interval of length 2^-n.
constexpr float sobol_1d(std::uint32_t index, std::uint32_t seed) {
  return to_unit_float(reverse_bits(scramble_upwards(index, seed)));
}

// The index-th point of Sobol's sequence, Owen-scrambled: each aligned block of 2^n has one point in each elementary
// interval of area 2^-n, that is, in each rectangle of a grid of 2^k by 2^(n - k) over the unit square.
constexpr Vec2f sobol_2d(std::uint32_t index, std::uint32_t seed_x, std::uint32_t seed_y) {
  const std::uint64_t x = scramble_upwards(index, seed_x), y = scramble_upwards(pascal_product(index), seed_y);
  const std::uint64_t digits = reverse_bits(y << 32 | x);
  return {to_unit_float(static_cast<std::uint32_t>(digits >> 32)), to_unit_float(static_cast<std::uint32_t>(digits))};
}

// The third number of that point. In each aligned block of 2^n points, those whose third number lies in a given interval
// are themselves spread evenly.
constexpr float sobol_third(std::uint32_t index, std::uint32_t seed) {
  return to_unit_float(reverse_bits(scramble_upwards(third_product(index), seed)));
}

}  // namespace basicrt
