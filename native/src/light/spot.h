// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp that shines into a cone.
#pragma once

#include "light/light.h"

namespace basicrt {

[[nodiscard]] bool is_delta_lamp(const SpotLight& light);
[[nodiscard]] std::optional<LightSample> sample_lamp(const SpotLight& light, Vec3f position, Vec2f u);
[[nodiscard]] std::optional<LightHit> intersect_lamp(const SpotLight& light, const Ray& ray);
[[nodiscard]] EmissionSample sample_lamp_emission(const SpotLight& light, Vec2f u_position, Vec2f u_direction,
                                                  Vec3f scene_center, float scene_radius);
[[nodiscard]] EmissionPdf lamp_emission_pdf(const SpotLight& light, Vec3f position, Vec3f direction,
                                            float scene_radius);
[[nodiscard]] LightBounds lamp_bounds(const SpotLight& light);
[[nodiscard]] float lamp_power(const SpotLight& light, float scene_radius);

}  // namespace basicrt
