// SPDX-License-Identifier: GPL-3.0-or-later
// Hands each lamp to its kind: a new one needs an overload of each function that is called here.
#include "light/light.h"

#include "light/area.h"
#include "light/point.h"
#include "light/spot.h"
#include "light/sun.h"

namespace basicrt {
namespace {

// Black light is none; and where a lamp is so near or far that a number leaves the range of floats, it is lost.
bool is_usable(Color radiance, float pdf) {
  return pdf > 0 && pdf < infinity && is_finite(radiance) && !is_black(radiance);
}

}  // namespace

std::uint32_t visibility(const Light& light) {
  return std::visit(
      [](const auto& lamp) {
        std::uint32_t kinds = 0;
        const auto add = [&](bool is_visible, RayKind kind) { kinds |= is_visible ? kind : 0u; };
        add(lamp.is_camera_visible, ray_camera);
        add(lamp.is_diffuse_visible, ray_diffuse);
        add(lamp.is_glossy_visible, ray_glossy);
        add(lamp.is_transmission_visible, ray_transmission);
        add(lamp.is_volume_visible, ray_volume);
        return kinds;
      },
      light);
}

bool is_delta(const Light& light) {
  return std::visit([](const auto& lamp) { return is_delta_lamp(lamp); }, light);
}

std::optional<LightSample> sample_light(const Light& light, Vec3f position, Vec2f u) {
  std::optional<LightSample> sample = std::visit(
      [&](const auto& lamp) {
        std::optional<LightSample> made = sample_lamp(lamp, position, u);
        if (!made) return made;
        made->casts_shadows = lamp.casts_shadows;
        made->max_bounces = lamp.max_bounces;
        made->light_group = lamp.light_group;
        return made;
      },
      light);
  if (!sample || !is_usable(sample->radiance, sample->pdf)) return std::nullopt;
  sample->kinds = visibility(light);
  return sample;
}

std::optional<LightHit> intersect_light(const Light& light, const Ray& ray) {
  std::optional<LightHit> hit = std::visit(
      [&](const auto& lamp) {
        std::optional<LightHit> met = intersect_lamp(lamp, ray);
        if (met) met->light_group = lamp.light_group;
        return met;
      },
      light);
  // As for instances: a lamp is seen when any of the ray's kinds sees it.
  if (hit && !(is_usable(hit->radiance, hit->pdf) && (visibility(light) & ray.kinds) != 0)) hit.reset();
  return hit;
}

float light_pdf(const Light& light, Vec3f position, Vec3f wi) {
  const std::optional<LightHit> hit = intersect_light(light, {.origin = position, .direction = wi});
  return hit ? hit->pdf : 0;
}

std::optional<EmissionSample> sample_emission(const Light& light, Vec2f u_position, Vec2f u_direction,
                                              Vec3f scene_center, float scene_radius) {
  const EmissionSample sample = std::visit(
      [&](const auto& lamp) { return sample_lamp_emission(lamp, u_position, u_direction, scene_center, scene_radius); },
      light);
  if (!is_usable(sample.weight, sample.pdf_position * sample.pdf_direction)) return std::nullopt;
  return sample;
}

EmissionPdf emission_pdf(const Light& light, Vec3f position, Vec3f direction, float scene_radius) {
  return std::visit([&](const auto& lamp) { return lamp_emission_pdf(lamp, position, direction, scene_radius); },
                    light);
}

std::variant<LightBounds, DistantBounds> light_bounds(const Light& light) {
  return std::visit([](const auto& lamp) -> std::variant<LightBounds, DistantBounds> { return lamp_bounds(lamp); },
                    light);
}

float power_estimate(const Light& light, float scene_radius) {
  return std::visit([&](const auto& lamp) { return lamp_power(lamp, scene_radius); }, light);
}

}  // namespace basicrt
