// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps made ready: sampled towards a point and from themselves. They do not block rays.
#pragma once

#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>

#include "light/area.h"
#include "light/light.h"
#include "light/light_bounds.h"
#include "light/link_sets.h"
#include "light/point.h"
#include "light/spot.h"
#include "light/sun.h"

namespace basicrt {

// A lamp with what sampling needs of it, worked out once. What its material makes of its light is not its own business.
struct Lamp {
  Lamp(const Light& light);  // NOLINT(google-explicit-constructor): the same lamp
  template <class Described>
    requires std::is_constructible_v<Light, const Described&>
  Lamp(const Described& light) : Lamp(Light(light)) {}  // NOLINT(google-explicit-constructor)

  std::variant<PointLight, SpotLamp, SunLight, AreaLamp> kind;
  std::uint32_t visibility = 0;  // RayKind bits of the rays that see it
  bool is_varying = false;       // it has a material
  LinkSets lit_sets;             // of receivers
  LinkSets blocker_sets;
  std::uint32_t shadow_kind = ray_shadow;  // RayKind bits of the rays that find out what dims its light
  float estimate = 1;                      // what that multiplies its light by, about: for power and bounds
};

// Light from a single place or direction: rays never run into it.
[[nodiscard]] bool is_delta(const Lamp& lamp);
// Nothing where no light arrives.
[[nodiscard]] std::optional<LightSample> sample_light(const Lamp& lamp, Vec3f position, Vec2f u);
[[nodiscard]] std::optional<LightHit> intersect_light(const Lamp& lamp, const Ray& ray);
[[nodiscard]] float light_pdf(const Lamp& lamp, Vec3f position, Vec3f wi);
// `scene_center` and `scene_radius` say where a sun's rays must pass.
[[nodiscard]] std::optional<EmissionSample> sample_emission(const Lamp& lamp, Vec2f u_position, Vec2f u_direction,
                                                            Vec3f scene_center, float scene_radius);
// For a ray that leaves the lamp at `position` along `direction`.
[[nodiscard]] EmissionPdf emission_pdf(const Lamp& lamp, Vec3f position, Vec3f direction, float scene_radius);
// What lights are chosen by.
[[nodiscard]] std::variant<LightBounds, DistantBounds> light_bounds(const Lamp& lamp);
// Watts, all directions together.
[[nodiscard]] float power_estimate(const Lamp& lamp, float scene_radius);

}  // namespace basicrt
