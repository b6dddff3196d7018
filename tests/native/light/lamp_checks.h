// SPDX-License-Identifier: GPL-3.0-or-later
// What the tests of lamps share: random transforms, and irradiance and power by sampling.
#pragma once

#include <cmath>
#include <cstdint>

#include "light/lamp.h"
#include "support/chi_square.h"

namespace basicrt::test {

// Calls visit(u) for the centres of n x n cells of the unit square, jittered.
template <class Visitor>
void for_each_stratum(int n, Rng& rng, Visitor&& visit) {
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec2f jitter = next_unit_vec2(rng);
      visit(Vec2f{(static_cast<float>(x) + jitter.x) / static_cast<float>(n),
                  (static_cast<float>(y) + jitter.y) / static_cast<float>(n)});
    }
}

// On a surface at `position` that faces `normal`, in the first channel, from n x n samples.
inline double sampled_irradiance(const Light& light, Vec3f position, Vec3f normal, int n = 256) {
  Rng rng(7);
  double sum = 0;
  for_each_stratum(n, rng, [&](Vec2f u) {
    if (const auto sample = sample_light(light, position, u))
      sum += double(sample->radiance.x) * std::max(0.0f, dot(sample->wi, normal)) / sample->pdf;
  });
  return sum / (double(n) * n);
}

// Watts that leave the lamp, in the first channel, from n emission samples.
inline double sampled_power(const Light& light, Vec3f scene_center, float scene_radius, int n = 200000) {
  Rng rng(11);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const Vec2f u_position = next_unit_vec2(rng), u_direction = next_unit_vec2(rng);
    if (const auto sample = sample_emission(light, u_position, u_direction, scene_center, scene_radius))
      sum += sample->weight.x;
  }
  return sum / n;
}

// Watts on the square [-1, 1]^2 in the plane z = 0, from above: by paths that start at the lamp,
inline double watts_by_emission(const Light& light, int n = 400000) {
  Rng rng(12);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const Vec2f u_position = next_unit_vec2(rng), u_direction = next_unit_vec2(rng);
    const auto sample = sample_emission(light, u_position, u_direction, Vec3f(0), 2);
    if (!sample || sample->ray.direction.z >= 0) continue;
    const Vec3f place = sample->ray.at(-sample->ray.origin.z / sample->ray.direction.z);
    if (std::abs(place.x) < 1 && std::abs(place.y) < 1) sum += sample->weight.x;
  }
  return sum / n;
}
// and by samples from the square towards the lamp.
inline double watts_by_sampling(const Light& light, int n = 400000) {
  Rng rng(13);
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const Vec2f u = next_unit_vec2(rng);
    const auto sample = sample_light(light, {2 * u.x - 1, 2 * u.y - 1, 0}, next_unit_vec2(rng));
    if (sample) sum += 4.0 * sample->radiance.x * std::max(0.0f, sample->wi.z) / sample->pdf;
  }
  return sum / n;
}

inline Transform translation(Vec3f t) { return Transform({{{1, 0, 0, t.x}, {0, 1, 0, t.y}, {0, 0, 1, t.z}}}); }
inline Transform scaling(Vec3f s) { return Transform({{{s.x, 0, 0, 0}, {0, s.y, 0, 0}, {0, 0, s.z, 0}}}); }
inline Vec3f random_direction(Rng& rng) { return to_direction(Vec2d(next_unit_vec2(rng))); }
// A rotation: x and y axes become two random perpendicular directions.
inline Transform random_rotation(Rng& rng) {
  const Vec3d x = normalize(Vec3d(random_direction(rng)));
  const Vec3d y = normalize(cross(Vec3d(random_direction(rng)), x)), z = cross(x, y);
  return Transform(TransformD({{{x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}}}));
}

}  // namespace basicrt::test
