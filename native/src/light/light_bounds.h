// SPDX-License-Identifier: GPL-3.0-or-later
// What is known of a light, or of many together, before looking closely: where it is, whither it shines, how strongly.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "light/lit_point.h"
#include "math/bounds.h"

namespace basicrt {

// Angles are kept by their cosines. As made: a point that shines everywhere alike.
struct LightBounds {
  Bounds3f box = {};          // all that shines
  Vec3f axis{0, 0, 1};        // unit length
  float cos_normals = -1;     // the light's normals are within this angle of the axis,
  float cos_emission = 0;     // and it shines within this angle of its normals,
  bool is_two_sided = false;  // or of their opposites
  bool is_solid = false;      // a lamp that rays can run into
  // None of its points is lower along the axis; known of flat lights.
  float lowest = -std::numeric_limits<float>::infinity();
  float intensity = 0;  // W / sr along a normal, of the luminance
};

// A light infinitely far away.
struct DistantBounds {
  Vec3f towards;  // unit length
  float cos_radius = 1, sin_radius = 0;
  float irradiance = 0;  // of the luminance, on a surface that faces it
};

// Of a light all of whose points lie in a plane across its axis.
[[nodiscard]] float height_along(Vec3f axis, Vec3d point);

// Holds all of them (at least one).
[[nodiscard]] LightBounds merge(std::span<const LightBounds> lights);

// Bounds are computed in floats: a cosine must be this far below zero before nothing can arrive.
inline constexpr float cosine_slack = 1e-3f;
// What just may arrive counts as much as this, so that nothing that does arrive goes unsampled.
inline constexpr float least_cosine = 0.01f;

// How much the light can matter to a point, as an irradiance. Zero only where nothing arrives.
[[nodiscard]] inline float importance(const DistantBounds& light, const LitPoint& point) {
  if (!point.has_normal()) return light.irradiance;
  const float cosine = std::clamp(dot(point.normal, light.towards), -1.0f, 1.0f);
  float greatest = 1;  // over the disc
  if (cosine < light.cos_radius)
    greatest = cosine * light.cos_radius + std::sqrt(1 - cosine * cosine) * light.sin_radius;
  return greatest < -cosine_slack ? 0 : light.irradiance * std::max(greatest, least_cosine);
}

}  // namespace basicrt
