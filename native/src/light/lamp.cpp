// SPDX-License-Identifier: GPL-3.0-or-later
// Hands each lamp to its kind: a new one needs an overload of each function that is called here.
#include "light/lamp.h"

#include "base/overloaded.h"

namespace basicrt {
namespace {

// Black light is none; and where a lamp is so near or far that a number leaves the range of floats, it is lost.
bool is_usable(Color radiance, float pdf) {
  return pdf > 0 && pdf < infinity && is_finite(radiance) && !is_black(radiance);
}

}  // namespace

Lamp::Lamp(const Light& light)
    : kind(std::visit(Overloaded{[](const SpotLight& spot) -> decltype(kind) { return SpotLamp(spot); },
                                 [](const AreaLight& area) -> decltype(kind) { return AreaLamp(area); },
                                 [](const auto& other) -> decltype(kind) { return other; }},
                      light)) {
  std::visit(
      [&](const auto& lamp) {
        const auto add = [&](bool is_visible, RayKind rays) { visibility |= is_visible ? rays : 0u; };
        add(lamp.is_camera_visible, ray_camera);
        add(lamp.is_diffuse_visible, ray_diffuse);
        add(lamp.is_glossy_visible, ray_glossy);
        add(lamp.is_transmission_visible, ray_transmission);
        add(lamp.is_volume_visible, ray_volume);
        is_varying = lamp.material.is_valid();
        lit_sets = lamp.lit_sets;
        blocker_sets = lamp.blocker_sets;
      },
      light);
}

bool is_delta(const Lamp& lamp) {
  return std::visit([](const auto& of_kind) { return is_delta_lamp(of_kind); }, lamp.kind);
}

std::optional<LightSample> sample_light(const Lamp& lamp, Vec3f position, Vec2f u) {
  std::optional<LightSample> sample = std::visit(
      [&](const auto& of_kind) {
        std::optional<LightSample> made = sample_lamp(of_kind, position, u);
        if (!made) return made;
        made->casts_shadows = of_kind.casts_shadows;
        made->max_bounces = of_kind.max_bounces;
        made->light_group = of_kind.light_group;
        return made;
      },
      lamp.kind);
  if (!sample || !is_usable(sample->radiance, sample->pdf)) return std::nullopt;
  sample->kinds = lamp.visibility;
  sample->shadow_kind = lamp.shadow_kind;
  return sample;
}

std::optional<LightHit> intersect_light(const Lamp& lamp, const Ray& ray) {
  std::optional<LightHit> hit = std::visit(
      [&](const auto& of_kind) {
        std::optional<LightHit> met = intersect_lamp(of_kind, ray);
        if (met) met->light_group = of_kind.light_group;
        return met;
      },
      lamp.kind);
  // As for instances: a lamp is seen when any of the ray's kinds sees it.
  if (hit && !(is_usable(hit->radiance, hit->pdf) && (lamp.visibility & ray.kinds) != 0)) hit.reset();
  return hit;
}

float light_pdf(const Lamp& lamp, Vec3f position, Vec3f wi) {
  const std::optional<LightHit> hit = intersect_light(lamp, {.origin = position, .direction = wi});
  return hit ? hit->pdf : 0;
}

std::optional<EmissionSample> sample_emission(const Lamp& lamp, Vec2f u_position, Vec2f u_direction, Vec3f scene_center,
                                              float scene_radius) {
  const EmissionSample sample = std::visit(
      [&](const auto& of_kind) {
        return sample_lamp_emission(of_kind, u_position, u_direction, scene_center, scene_radius);
      },
      lamp.kind);
  if (!is_usable(sample.weight, sample.pdf_position * sample.pdf_direction)) return std::nullopt;
  return sample;
}

EmissionPdf emission_pdf(const Lamp& lamp, Vec3f position, Vec3f direction, float scene_radius) {
  return std::visit([&](const auto& of_kind) { return lamp_emission_pdf(of_kind, position, direction, scene_radius); },
                    lamp.kind);
}

std::variant<LightBounds, DistantBounds> light_bounds(const Lamp& lamp) {
  using Bounds = std::variant<LightBounds, DistantBounds>;
  Bounds bounds = std::visit([](const auto& of_kind) -> Bounds { return lamp_bounds(of_kind); }, lamp.kind);
  std::visit(Overloaded{[&](LightBounds& near) { near.intensity *= lamp.estimate; },
                        [&](DistantBounds& distant) { distant.irradiance *= lamp.estimate; }},
             bounds);
  return bounds;
}

float power_estimate(const Lamp& lamp, float scene_radius) {
  return lamp.estimate * std::visit([&](const auto& of_kind) { return lamp_power(of_kind, scene_radius); }, lamp.kind);
}

}  // namespace basicrt
