// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp that shines in every direction alike.
#pragma once

#include <optional>

#include "light/light.h"
#include "light/light_bounds.h"

namespace basicrt {

[[nodiscard]] bool is_delta_lamp(const PointLight& light);
[[nodiscard]] std::optional<LightSample> sample_lamp(const PointLight& light, Vec3f position, Vec2f u);
[[nodiscard]] std::optional<LightHit> intersect_lamp(const PointLight& light, const Ray& ray);
[[nodiscard]] EmissionSample sample_lamp_emission(const PointLight& light, Vec2f u_position, Vec2f u_direction,
                                                  Vec3f scene_center, float scene_radius);
[[nodiscard]] EmissionPdf lamp_emission_pdf(const PointLight& light, Vec3f position, Vec3f direction,
                                            float scene_radius);
[[nodiscard]] LightBounds lamp_bounds(const PointLight& light);
[[nodiscard]] float lamp_power(const PointLight& light, float scene_radius);

}  // namespace basicrt
