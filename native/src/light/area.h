// SPDX-License-Identifier: GPL-3.0-or-later
// A rectangle or ellipse that shines to one side.
#pragma once

#include <optional>

#include "light/light.h"
#include "light/light_bounds.h"

namespace basicrt {

// With its place in the world, in double precision.
struct AreaLamp : AreaLight {
  explicit AreaLamp(const AreaLight& light);

  Vec3d center, edge_x, edge_y;
  Vec3d normal;          // of the side that shines, unit length
  Vec3d dual_x, dual_y;  // their products with a place on the plate are its coordinates along the edges, in edges
  Vec3d axis_x, axis_y;  // along the edges, unit length
  double width, depth;   // the edges' lengths
  double area;
  bool is_rectangle;  // with right angles: it is sampled by solid angle
  bool has_full_spread;
  double half_spread;                    // radians
  double tan_half_spread, spread_scale;  // where the spread isn't full
};

[[nodiscard]] bool is_delta_lamp(const AreaLamp& light);
[[nodiscard]] std::optional<LightSample> sample_lamp(const AreaLamp& light, Vec3f position, Vec2f u);
[[nodiscard]] std::optional<LightHit> intersect_lamp(const AreaLamp& light, const Ray& ray);
[[nodiscard]] EmissionSample sample_lamp_emission(const AreaLamp& light, Vec2f u_position, Vec2f u_direction,
                                                  Vec3f scene_center, float scene_radius);
[[nodiscard]] EmissionPdf lamp_emission_pdf(const AreaLamp& light, Vec3f position, Vec3f direction, float scene_radius);
[[nodiscard]] LightBounds lamp_bounds(const AreaLamp& light);
[[nodiscard]] float lamp_power(const AreaLamp& light, float scene_radius);

}  // namespace basicrt
