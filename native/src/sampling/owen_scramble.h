// SPDX-License-Identifier: GPL-3.0-or-later
// Owen's nested uniform scrambling by a hash: no tables, so that each pixel and dimension can have its own.
#pragma once

#include <cstdint>

namespace basicrt {

constexpr std::uint64_t reverse_bits(std::uint64_t x) {
  x = ((x >> 1) & 0x5555555555555555u) | ((x & 0x5555555555555555u) << 1);
  x = ((x >> 2) & 0x3333333333333333u) | ((x & 0x3333333333333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0f0f0f0f0fu) | ((x & 0x0f0f0f0f0f0f0f0fu) << 4);
  return __builtin_bswap64(x);
}
constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// Flips each bit or not, as a hash of the bits below it and the seed says: a permutation that takes numbers with the
// same n lowest bits to numbers with the same n lowest bits. Laine and Karras 2011, "Stratified sampling for
// stochastic transparency", with the better mixing constants of Vegdahl 2021, "Building a better LK hash".
constexpr std::uint32_t scramble_upwards(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  return x ^ (x * 0x53a22864u);
}

// The same from the other end: flips each bit by the bits above it. On the binary digits of a fraction in [0, 1) that is
// Owen 1995, "Randomly permuted (t,m,s)-nets and (t,s)-sequences"; on an index, a shuffle in which every aligned block
// of 2^n numbers becomes another one (Burley 2020, "Practical hash-based Owen scrambling").
constexpr std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
  return reverse_bits(scramble_upwards(reverse_bits(x), seed));
}

}  // namespace basicrt
