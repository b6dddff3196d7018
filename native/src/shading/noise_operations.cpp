// SPDX-License-Identifier: GPL-3.0-or-later
// Blender's Noise and White Noise textures; the kinds of noise are Musgrave's.
#include "shading/noise_operations.h"

#include <algorithm>

#include "shading/evaluator.h"
#include "shading/noise.h"

namespace basicrt {
namespace {

struct NoiseParameters {
  NoiseKind kind;
  Octaves octaves;
  float offset, gain;
  bool is_normalized;
};

template <int N>
float multifractal(Lattice<N> p, const Octaves& octaves) {
  float value = 1, power = 1;
  for (int i = 0; i <= octaves.count(); ++i) {
    value *= power * signed_noise(p) + 1;
    power *= octaves.roughness;
    p = scaled(p, octaves.lacunarity);
  }
  return octaves.remainder() != 0 ? value * (octaves.remainder() * power * signed_noise(p) + 1) : value;
}

template <int N>
float hetero_terrain(Lattice<N> p, const Octaves& octaves, float offset) {
  float power = octaves.roughness, value = offset + signed_noise(p);
  p = scaled(p, octaves.lacunarity);
  for (int i = 1; i <= octaves.count(); ++i) {
    value += (signed_noise(p) + offset) * power * value;
    power *= octaves.roughness;
    p = scaled(p, octaves.lacunarity);
  }
  if (octaves.remainder() != 0) value += octaves.remainder() * ((signed_noise(p) + offset) * power * value);
  return value;
}

template <int N>
float hybrid_multifractal(Lattice<N> p, const Octaves& octaves, float offset, float gain) {
  constexpr float least_weight = 0.001f;
  float power = 1, value = 0, weight = 1;
  for (int i = 0; weight > least_weight && i <= octaves.count(); ++i) {
    weight = std::min(weight, 1.0f);
    const float signal = (signed_noise(p) + offset) * power;
    power *= octaves.roughness;
    value += weight * signal;
    weight *= gain * signal;
    p = scaled(p, octaves.lacunarity);
  }
  if (octaves.remainder() != 0 && weight > least_weight)
    value += octaves.remainder() * std::min(weight, 1.0f) * ((signed_noise(p) + offset) * power);
  return value;
}

template <int N>
float ridged_multifractal(Lattice<N> p, const Octaves& octaves, float offset, float gain) {
  const auto ridge = [&] {
    const float distance = offset - std::abs(signed_noise(p));
    return distance * distance;
  };
  float power = octaves.roughness, signal = ridge(), value = signal;
  for (int i = 1; i <= octaves.count(); ++i) {
    p = scaled(p, octaves.lacunarity);
    const float weight = std::clamp(signal * gain, 0.0f, 1.0f);
    signal = ridge() * weight;
    value += signal * power;
    power *= octaves.roughness;
  }
  return value;
}

template <int N>
float noise(const Lattice<N>& p, const NoiseParameters& of) {
  switch (of.kind) {
    case NoiseKind::multifractal:
      return multifractal(p, of.octaves);
    case NoiseKind::fbm:
      return fractal_noise(p, of.octaves, of.is_normalized);
    case NoiseKind::hybrid_multifractal:
      return hybrid_multifractal(p, of.octaves, of.offset, of.gain);
    case NoiseKind::ridged_multifractal:
      return ridged_multifractal(p, of.octaves, of.offset, of.gain);
    case NoiseKind::hetero_terrain:
      return hetero_terrain(p, of.octaves, of.offset);
  }
  return 0;
}

// Far enough from p that the noise there has nothing to do with p's.
template <int N>
Lattice<N> moved(Lattice<N> p, float seed) {
  for (int i = 0; i < N; ++i)
    p[i] += 100 + 100 * (N == 1 ? hash_to_unit(seed) : hash_to_unit(seed, static_cast<float>(i)));
  return p;
}

template <int N>
Vec3f noise_texture(Lattice<N> p, float distortion, const NoiseParameters& of, bool gives_color) {
  if (distortion != 0) {
    const Lattice<N> undistorted = p;
    for (int i = 0; i < N; ++i) p[i] += signed_noise(moved(undistorted, static_cast<float>(i))) * distortion;
  }
  const float value = noise(p, of);
  if (!gives_color) return Vec3f(value);
  return {value, noise(moved(p, N), of), noise(moved(p, N + 1), of)};
}

template <int N>
float white(const Lattice<N>& p) {
  return hash_to_color(p).x;
}

}  // namespace

Vec3f eval(const NoiseOperation& node, const Evaluator& in) {
  const float scale = in(node.scale);
  const Octaves octaves{std::clamp(in(node.detail), 0.0f, 15.0f), std::max(in(node.roughness), 0.0f),
                        in(node.lacunarity)};
  const NoiseParameters parameters{node.noise, octaves, in(node.offset), in(node.gain), node.is_normalized};
  return with_dimensions(node.dimensions, [&]<int N>(std::integral_constant<int, N>) {
    const Lattice<N> point = lattice_point<N>(in(node.vector) * scale, in(node.w) * scale);
    return noise_texture<N>(point, in(node.distortion), parameters, node.gives_color);
  });
}

Vec3f eval(const WhiteNoiseOperation& node, const Evaluator& in) {
  return with_dimensions(node.dimensions, [&]<int N>(std::integral_constant<int, N>) {
    const Lattice<N> point = lattice_point<N>(in(node.vector), in(node.w));
    return node.gives_color ? hash_to_color(point) : Vec3f(white<N>(point));
  });
}

}  // namespace basicrt
