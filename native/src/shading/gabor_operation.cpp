// SPDX-License-Identifier: GPL-3.0-or-later
// Blender's Gabor texture: waves as phasors (Tricard et al. 2019, "Procedural phasor noise"), as many in each cell, with
// random signs (Tavernier et al. 2019, "Making Gabor noise fast and normalized").
#include "shading/gabor_operation.h"

#include <algorithm>
#include <cmath>

#include "math/constants.h"
#include "shading/evaluator.h"
#include "shading/lattice.h"

namespace basicrt {
namespace {

constexpr int waves_per_cell = 8;

// Where all waves go, but for what is random: an angle, or inclination and azimuth.
struct Heading {
  float inclination, azimuth, spread;
  Lattice<3> direction;  // as unit vector, without spread
};

Lattice<2> way_of(const Heading& heading, const Lattice<3>& seed) {
  const float turn = (hash_to_unit(seed[0], seed[1], seed[2]) - 0.5f) * pi;
  const float angle = heading.azimuth + turn * heading.spread;
  return {std::cos(angle), std::sin(angle)};
}

Lattice<3> way_of(const Heading& heading, const Lattice<4>& seed) {
  if (heading.spread == 0) return heading.direction;
  const float inclination =
      heading.inclination + hash_to_unit(seed[0], seed[1], seed[2], seed[3]) * pi * heading.spread;
  const float azimuth = heading.azimuth + hash_to_unit(seed[2], seed[0], seed[3], seed[1]) * pi * heading.spread;
  return {std::sin(inclination) * std::cos(azimuth), std::sin(inclination) * std::sin(azimuth), std::cos(inclination)};
}

Lattice<2> place_of(const Lattice<3>& seed) {
  return {hash_to_unit(seed[0], seed[1], seed[2]), hash_to_unit(seed[2], seed[0], seed[1])};
}

Lattice<3> place_of(const Lattice<4>& seed) {
  const Vec3f place = hash_to_color(seed);
  return {place.x, place.y, place.z};
}

float sign_of(const Lattice<3>& seed) { return hash_to_unit(seed[0], seed[1], seed[2]) < 0.5f ? -1.0f : 1.0f; }
float sign_of(const Lattice<4>& seed) { return hash_to_unit(seed[0], seed[1], seed[2], seed[3]) < 0.5f ? -1.0f : 1.0f; }

// A wave that fades out at distance 1: cosine and sine.
template <int N>
Vec2f wave(const Lattice<N>& place, const Lattice<N>& way, float frequency, float squared_distance) {
  const float envelope = std::exp(-pi * squared_distance) * (0.5f + 0.5f * std::cos(pi * squared_distance));
  const float angle = 2 * pi * inner<N>(place, scaled<N>(way, frequency));
  return Vec2f{std::cos(angle), std::sin(angle)} * envelope;
}

template <int N>
Vec2f sum_of_waves(const Lattice<N>& p, float frequency, const Heading& heading) {
  Lattice<N> corner, local;
  for (int i = 0; i < N; ++i) corner[i] = std::floor(p[i]), local[i] = p[i] - corner[i];
  Vec2f sum;
  for_each_cell<N>(1, [&](const Lattice<N>& offset) {
    const Lattice<N> cell = corner + offset, in_cell = minus<N>(local, offset);
    for (int k = 0; k < waves_per_cell; ++k) {
      const auto seed = [&](int which) {
        Lattice<N + 1> made;
        for (int i = 0; i < N; ++i) made[i] = cell[i];
        made[N] = static_cast<float>(k * 3 + which);
        return made;
      };
      const Lattice<N> place = minus<N>(in_cell, place_of(seed(1)));
      const float squared_distance = inner<N>(place, place);
      if (squared_distance >= 1) continue;
      sum = sum + wave<N>(place, way_of(heading, seed(0)), frequency, squared_distance) * sign_of(seed(2));
    }
  });
  return sum;
}

}  // namespace

Vec3f eval(const GaborOperation& node, const Evaluator& in) {
  const Vec3f p = in(node.vector) * in(node.scale);
  const float frequency = std::max(in(node.frequency), 0.001f);
  Heading heading{.inclination = 0,
                  .azimuth = in(node.angle),
                  .spread = 1 - std::clamp(in(node.anisotropy), 0.0f, 1.0f),
                  .direction = {}};
  // Of the sum, of half of the signs, by the integral of a wave's square.
  float deviation = std::sqrt(waves_per_cell * 0.5f * 0.25f);
  Vec2f sum;
  if (node.dimensions == 2) {
    sum = sum_of_waves<2>({p.x, p.y}, frequency, heading);
  } else {
    const Vec3f given = in(node.direction);
    const Vec3f direction = length(given) > 0 ? given / length(given) : Vec3f(0.0f);
    heading.direction = {direction.x, direction.y, direction.z};
    heading.inclination = std::acos(std::clamp(direction.z, -1.0f, 1.0f));
    heading.azimuth = std::atan2(direction.y, direction.x);
    deviation = std::sqrt(waves_per_cell * 0.5f / (4 * std::sqrt(2.0f)));
    sum = sum_of_waves<3>({p.x, p.y, p.z}, frequency, heading);
  }
  const float most = 6 * deviation;
  switch (node.output) {
    case GaborOutput::phase:
      return Vec3f((std::atan2(sum.y, sum.x) + pi) / (2 * pi));
    case GaborOutput::intensity:
      return Vec3f(std::sqrt(sum.x * sum.x + sum.y * sum.y) / most);
    default:
      return Vec3f(sum.y / most * 0.5f + 0.5f);
  }
}

}  // namespace basicrt
