// SPDX-License-Identifier: GPL-3.0-or-later
// Gradient noise (Perlin 2002, "Improving noise") and what is made of its octaves (Ebert et al. 2003, "Texturing and
// modeling", chapter 16).
#pragma once

#include <algorithm>

#include "shading/lattice.h"

namespace basicrt {

// About [-1, 1].
[[nodiscard]] float signed_noise(Lattice<1> p);
[[nodiscard]] float signed_noise(Lattice<2> p);
[[nodiscard]] float signed_noise(Lattice<3> p);
[[nodiscard]] float signed_noise(Lattice<4> p);

struct Octaves {
  float detail, roughness, lacunarity;

  [[nodiscard]] int count() const { return static_cast<int>(detail); }
  [[nodiscard]] float remainder() const { return detail - std::floor(detail); }
};

// Fractional Brownian motion; in [0, 1] where it is normalized.
template <int N>
[[nodiscard]] float fractal_noise(const Lattice<N>& p, const Octaves& octaves, bool is_normalized) {
  float frequency = 1, amplitude = 1, largest = 0, sum = 0;
  for (int i = 0; i <= octaves.count(); ++i) {
    sum += signed_noise(scaled(p, frequency)) * amplitude;
    largest += amplitude;
    amplitude *= octaves.roughness;
    frequency *= octaves.lacunarity;
  }
  const auto finish = [&](float value, float most) { return is_normalized ? 0.5f * value / most + 0.5f : value; };
  const float remainder = octaves.remainder(), value = finish(sum, largest);
  if (remainder == 0) return value;
  const float next = sum + signed_noise(scaled(p, frequency)) * amplitude;
  return lerp(value, finish(next, largest + amplitude), remainder);
}

}  // namespace basicrt
