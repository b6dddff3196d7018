// SPDX-License-Identifier: GPL-3.0-or-later
// Points of one to four dimensions, and hashes of them: Jenkins 2006, "lookup3", of the bits of up to four numbers, and
// the PCG hashes of Jarzynski and Olano 2020, "Hash functions for GPU rendering", of whole ones.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "math/vec.h"

namespace basicrt {

template <int N>
struct Lattice {
  float numbers[N] = {};

  constexpr float operator[](int i) const { return numbers[i]; }
  constexpr float& operator[](int i) { return numbers[i]; }
  [[nodiscard]] constexpr const float* begin() const { return numbers; }
  [[nodiscard]] constexpr const float* end() const { return numbers + N; }
  constexpr float* begin() { return numbers; }
  constexpr float* end() { return numbers + N; }
};

// The first numbers of a vector; w alone in one dimension, and w last in four.
template <int N>
Lattice<N> lattice_point(Vec3f vector, float w) {
  if constexpr (N == 1) return {w};
  Lattice<N> point{};
  for (int i = 0; i < N; ++i) point[i] = i < 3 ? vector[static_cast<std::size_t>(i)] : w;
  return point;
}

template <int N>
Lattice<N> operator+(Lattice<N> a, const Lattice<N>& b) {
  for (int i = 0; i < N; ++i) a[i] += b[i];
  return a;
}
template <int N>
Lattice<N> scaled(Lattice<N> a, float scale) {
  for (float& number : a) number *= scale;
  return a;
}

template <int N>
Lattice<N> minus(Lattice<N> a, const Lattice<N>& b) {
  for (int i = 0; i < N; ++i) a[i] -= b[i];
  return a;
}
template <int N>
float inner(const Lattice<N>& a, const Lattice<N>& b) {
  float sum = 0;
  for (int i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

// Calls visit(cell's offset) for all cells so many steps away or less, the first axis fastest.
template <int N>
void for_each_cell(int reach, auto&& visit) {
  const int width = 2 * reach + 1;
  int count = 1;
  for (int i = 0; i < N; ++i) count *= width;
  for (int index = 0; index < count; ++index) {
    Lattice<N> offset;
    for (int i = 0, rest = index; i < N; ++i, rest /= width) offset[i] = static_cast<float>(rest % width - reach);
    visit(offset);
  }
}

// Of a number without fraction; what an int can't hold becomes the least int.
[[nodiscard]] inline std::int32_t to_whole(float number) {
  const bool fits = number >= -2147483648.0f && number < 2147483648.0f;
  return fits ? static_cast<std::int32_t>(number) : std::numeric_limits<std::int32_t>::min();
}

[[nodiscard]] inline std::uint32_t hash_bits(std::span<const std::uint32_t> key) {
  std::uint32_t a, b, c;
  a = b = c = 0xdeadbeefu + (static_cast<std::uint32_t>(key.size()) << 2) + 13;
  const auto fold = [](std::uint32_t& x, std::uint32_t y, int turn) { x = (x ^ y) - std::rotl(y, turn); };
  const auto stir = [](std::uint32_t& x, std::uint32_t& y, std::uint32_t& z, int turn) {
    x = (x - z) ^ std::rotl(z, turn);
    z += y;
  };
  a += key[0];
  if (key.size() > 1) b += key[1];
  if (key.size() > 2) c += key[2];
  if (key.size() > 3) {
    stir(a, b, c, 4), stir(b, c, a, 6), stir(c, a, b, 8);
    stir(a, b, c, 16), stir(b, c, a, 19), stir(c, a, b, 4);
    a += key[3];
  }
  fold(c, b, 14), fold(a, c, 11), fold(b, a, 25), fold(c, b, 16), fold(a, c, 4), fold(b, a, 14), fold(c, b, 24);
  return c;
}

// In [0, 1], of the numbers' bits.
template <class... Numbers>
[[nodiscard]] float hash_to_unit(Numbers... numbers) {
  const std::array<std::uint32_t, sizeof...(Numbers)> key{std::bit_cast<std::uint32_t>(numbers)...};
  return static_cast<float>(hash_bits(key)) * (1.0f / 4294967295.0f);
}

// Three numbers in [0, 1], as Blender makes colours of points.
[[nodiscard]] inline Vec3f hash_to_color(const Lattice<1>& p) {
  return {hash_to_unit(p[0]), hash_to_unit(p[0], 1.0f), hash_to_unit(p[0], 2.0f)};
}
[[nodiscard]] inline Vec3f hash_to_color(const Lattice<2>& p) {
  return {hash_to_unit(p[0], p[1]), hash_to_unit(p[0], p[1], 1.0f), hash_to_unit(p[0], p[1], 2.0f)};
}
[[nodiscard]] inline Vec3f hash_to_color(const Lattice<3>& p) {
  return {hash_to_unit(p[0], p[1], p[2]), hash_to_unit(p[0], p[1], p[2], 1.0f), hash_to_unit(p[0], p[1], p[2], 2.0f)};
}
[[nodiscard]] inline Vec3f hash_to_color(const Lattice<4>& p) {
  return {hash_to_unit(p[0], p[1], p[2], p[3]), hash_to_unit(p[2], p[0], p[3], p[1]),
          hash_to_unit(p[3], p[2], p[1], p[0])};
}

// As many numbers in [0, 1] as the point has.
[[nodiscard]] inline Lattice<1> hash_to_point(const Lattice<1>& p) { return {hash_to_unit(p[0])}; }
[[nodiscard]] inline Lattice<2> hash_to_point(const Lattice<2>& p) {
  return {hash_to_unit(p[0], p[1]), hash_to_unit(p[0], p[1], 1.0f)};
}
[[nodiscard]] inline Lattice<3> hash_to_point(const Lattice<3>& p) {
  const Vec3f color = hash_to_color(p);
  return {color.x, color.y, color.z};
}
[[nodiscard]] inline Lattice<4> hash_to_point(const Lattice<4>& p) {
  return {hash_to_unit(p[0], p[1], p[2], p[3]), hash_to_unit(p[3], p[0], p[1], p[2]),
          hash_to_unit(p[2], p[3], p[0], p[1]), hash_to_unit(p[1], p[2], p[3], p[0])};
}

// Each number of the key depends on all of them. Shifted with their sign, as Blender does.
template <int N>
[[nodiscard]] std::array<std::uint32_t, N> permuted_congruential(std::array<std::uint32_t, N> key) {
  static_assert(N >= 2 && N <= 4);
  constexpr std::uint32_t factor = 1664525u;
  for (std::uint32_t& number : key) number = number * factor + 1013904223u;
  const auto stir = [&] {
    if constexpr (N == 2) {
      key[0] += key[1] * factor;
      key[1] += key[0] * factor;
    } else {
      key[0] += key[1] * key[N - 1];
      key[1] += key[2] * key[0];
      key[2] += key[0] * key[1];
      if constexpr (N == 4) key[3] += key[1] * key[2];
    }
  };
  stir();
  for (std::uint32_t& number : key) number ^= static_cast<std::uint32_t>(static_cast<std::int32_t>(number) >> 16);
  stir();
  return key;
}

// As many numbers in [0, 1] as a cell has coordinates, which are whole. Far away offsets count only as whole numbers.
template <int N>
[[nodiscard]] Lattice<N> hash_cell(const Lattice<N>& corner, const Lattice<N>& offset = {}) {
  if constexpr (N == 1) {
    return {hash_to_unit(corner[0] + offset[0])};
  } else {
    const auto whole = [](float number) { return static_cast<std::uint32_t>(to_whole(number)); };
    std::array<std::uint32_t, N> key;
    for (int i = 0; i < N; ++i) key[i] = whole(corner[i]) + whole(offset[i]);
    key = permuted_congruential<N>(key);
    Lattice<N> hash;
    for (int i = 0; i < N; ++i) hash[i] = static_cast<float>(key[i] & 0x7fffffffu) * (1.0f / 2147483647.0f);
    return hash;
  }
}

// Three numbers in [0, 1].
template <int N>
[[nodiscard]] Vec3f hash_cell_to_color(const Lattice<N>& corner, const Lattice<N>& offset) {
  if constexpr (N == 1) {
    return hash_to_color(corner + offset);
  } else {
    const auto hash = [&] {
      if constexpr (N == 2)
        return hash_cell(Lattice<3>{corner[0], corner[1], 0}, Lattice<3>{offset[0], offset[1], 0});
      else
        return hash_cell(corner, offset);
    }();
    return {hash[0], hash[1], hash[2]};
  }
}

// Calls function(std::integral_constant<int, N>) for N of 1 to 4.
template <class Function>
auto with_dimensions(int dimensions, Function&& function) {
  switch (dimensions) {
    case 1:
      return function(std::integral_constant<int, 1>{});
    case 2:
      return function(std::integral_constant<int, 2>{});
    case 4:
      return function(std::integral_constant<int, 4>{});
    default:
      return function(std::integral_constant<int, 3>{});
  }
}

}  // namespace basicrt
