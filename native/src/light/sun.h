// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp so far away that its light arrives from the same directions everywhere.
#pragma once

#include <optional>

#include "light/light.h"
#include "light/light_bounds.h"

namespace basicrt {

[[nodiscard]] bool is_delta_lamp(const SunLight& light);
[[nodiscard]] std::optional<LightSample> sample_lamp(const SunLight& light, Vec3f position, Vec2f u);
[[nodiscard]] std::optional<LightHit> intersect_lamp(const SunLight& light, const Ray& ray);
[[nodiscard]] EmissionSample sample_lamp_emission(const SunLight& light, Vec2f u_position, Vec2f u_direction,
                                                  Vec3f scene_center, float scene_radius);
[[nodiscard]] EmissionPdf lamp_emission_pdf(const SunLight& light, Vec3f position, Vec3f direction, float scene_radius);
[[nodiscard]] DistantBounds lamp_bounds(const SunLight& light);
[[nodiscard]] float lamp_power(const SunLight& light, float scene_radius);

}  // namespace basicrt
