// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp that shines into a cone.
#pragma once

#include <optional>

#include "light/light.h"
#include "light/light_bounds.h"

namespace basicrt {

struct SpotLamp : SpotLight {
  explicit SpotLamp(const SpotLight& light);

  TransformD to_local;
  float cone;  // 1 - cos of half its angle
};

[[nodiscard]] bool is_delta_lamp(const SpotLamp& light);
[[nodiscard]] std::optional<LightSample> sample_lamp(const SpotLamp& light, Vec3f position, Vec2f u);
[[nodiscard]] std::optional<LightHit> intersect_lamp(const SpotLamp& light, const Ray& ray);
[[nodiscard]] EmissionSample sample_lamp_emission(const SpotLamp& light, Vec2f u_position, Vec2f u_direction,
                                                  Vec3f scene_center, float scene_radius);
[[nodiscard]] EmissionPdf lamp_emission_pdf(const SpotLamp& light, Vec3f position, Vec3f direction, float scene_radius);
// What is left of its intensity towards a place.
[[nodiscard]] float beam_share(const SpotLamp& light, Vec3f position);
[[nodiscard]] LightBounds lamp_bounds(const SpotLamp& light);
[[nodiscard]] float lamp_power(const SpotLamp& light, float scene_radius);

}  // namespace basicrt
