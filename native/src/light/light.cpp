// SPDX-License-Identifier: GPL-3.0-or-later
// Hands each lamp to its kind: a new one needs an overload of each function that is called here.
#include "light/light.h"

#include "light/area.h"
#include "light/point.h"
#include "light/spot.h"
#include "light/sun.h"

namespace basicrt {
namespace {

// As for instances: a lamp is seen when any of the ray's kinds sees it.
bool is_visible(const Light& light, std::uint32_t ray_kinds) {
  const bool by_camera = std::visit([](const auto& lamp) { return lamp.is_camera_visible; }, light);
  return by_camera || (ray_kinds & ~ray_camera) != 0;
}

// Black light is none; and where a lamp is so near or far that a number leaves the range of floats, it is lost.
bool is_usable(Color radiance, float pdf) {
  return pdf > 0 && pdf < infinity && is_finite(radiance) && !is_black(radiance);
}

}  // namespace

bool is_delta(const Light& light) {
  return std::visit([](const auto& lamp) { return is_delta_lamp(lamp); }, light);
}

std::optional<LightSample> sample_light(const Light& light, Vec3f position, Vec2f u) {
  std::optional<LightSample> sample =
      std::visit([&](const auto& lamp) { return sample_lamp(lamp, position, u); }, light);
  if (sample && !is_usable(sample->radiance, sample->pdf)) sample.reset();
  return sample;
}

std::optional<LightHit> intersect_light(const Light& light, const Ray& ray) {
  if (!is_visible(light, ray.kinds)) return std::nullopt;
  std::optional<LightHit> hit = std::visit([&](const auto& lamp) { return intersect_lamp(lamp, ray); }, light);
  if (hit && !is_usable(hit->radiance, hit->pdf)) hit.reset();
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

float power_estimate(const Light& light, float scene_radius) {
  return std::visit([&](const auto& lamp) { return lamp_power(lamp, scene_radius); }, light);
}

}  // namespace basicrt
