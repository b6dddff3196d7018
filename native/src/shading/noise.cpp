// SPDX-License-Identifier: GPL-3.0-or-later
// Gradient noise of one to four dimensions, with the gradients and scales that Blender's has.
#include "shading/noise.h"

namespace basicrt {
namespace {

float fade(float t) { return t * t * t * (t * (t * 6 - 15) + 10); }
float negate_if(float value, std::uint32_t condition) { return condition ? -value : value; }

float gradient(std::uint32_t hash, const Lattice<1>& p) {
  return negate_if(1 + static_cast<float>(hash & 7), hash & 8) * p[0];
}
float gradient(std::uint32_t hash, const Lattice<2>& p) {
  const bool is_first = (hash & 7) < 4;
  return negate_if(is_first ? p[0] : p[1], hash & 1) + negate_if(2 * (is_first ? p[1] : p[0]), hash & 2);
}
float gradient(std::uint32_t hash, const Lattice<3>& p) {
  const std::uint32_t h = hash & 15;
  const float u = h < 8 ? p[0] : p[1], v = h < 4 ? p[1] : h == 12 || h == 14 ? p[0] : p[2];
  return negate_if(u, h & 1) + negate_if(v, h & 2);
}
float gradient(std::uint32_t hash, const Lattice<4>& p) {
  const std::uint32_t h = hash & 31;
  const float u = h < 24 ? p[0] : p[1], v = h < 16 ? p[1] : p[2], s = h < 8 ? p[2] : p[3];
  return negate_if(u, h & 1) + negate_if(v, h & 2) + negate_if(s, h & 4);
}

template <int N>
float perlin(const Lattice<N>& p) {
  std::array<std::uint32_t, N> cell;
  Lattice<N> inside, weight;
  for (int i = 0; i < N; ++i) {
    const float floor = std::floor(p[i]);
    cell[i] = static_cast<std::uint32_t>(to_whole(floor));
    inside[i] = p[i] - floor;
    weight[i] = fade(inside[i]);
  }
  std::array<float, 1 << N> corners;
  for (unsigned corner = 0; corner < corners.size(); ++corner) {
    std::array<std::uint32_t, N> key = cell;
    Lattice<N> offset = inside;
    for (int i = 0; i < N; ++i) {
      key[i] += (corner >> i) & 1u;
      offset[i] -= static_cast<float>((corner >> i) & 1u);
    }
    corners[corner] = gradient(hash_bits(key), offset);
  }
  for (int i = 0; i < N; ++i)
    for (unsigned k = 0; k < corners.size() >> (i + 1); ++k)
      corners[k] = lerp(corners[2 * k], corners[2 * k + 1], weight[i]);
  return corners[0];
}

template <int N>
float scaled_noise(Lattice<N> p, float scale) {
  // Far away all numbers are whole, where noise is 0: they repeat, moved by a half.
  for (float& number : p) {
    const float correction = std::abs(number) >= 1000000 ? 0.5f : 0;
    number = std::fmod(number, 100000.0f) + correction;
  }
  const float noise = perlin(p) * scale;
  return std::isfinite(noise) ? noise : 0;
}

}  // namespace

float signed_noise(Lattice<1> p) { return scaled_noise(p, 0.25f); }
float signed_noise(Lattice<2> p) { return scaled_noise(p, 0.6616f); }
float signed_noise(Lattice<3> p) { return scaled_noise(p, 0.9820f); }
float signed_noise(Lattice<4> p) { return scaled_noise(p, 0.8344f); }

}  // namespace basicrt
