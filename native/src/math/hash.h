// SPDX-License-Identifier: GPL-3.0-or-later
// Integer hashes: the source of all randomness, so that a sample is a pure function of its coordinates.
#pragma once

#include <cstdint>

#include "math/constants.h"

namespace basicrt {

// The finaliser of SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators").
constexpr std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}
constexpr std::uint64_t hash(std::uint64_t a, std::uint64_t b) { return hash(hash(a) ^ b); }

// In [0, 1), from the upper 24 bits: every value is exactly a float, and none is 1.
constexpr float to_unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

}  // namespace basicrt
