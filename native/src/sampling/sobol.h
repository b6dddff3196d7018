// SPDX-License-Identifier: GPL-3.0-or-later
// The first two dimensions of Sobol's sequence, Owen-scrambled.
#pragma once

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

}  // namespace basicrt
