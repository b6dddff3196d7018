// SPDX-License-Identifier: GPL-3.0-or-later
// One direction, or a cone of directions with the radiance irradiance / (pi sin^2(angle / 2)).
#include "light/sun.h"

#include "light/solid_angle.h"
#include "math/frame.h"
#include "math/warp.h"

namespace basicrt {
namespace {

// Narrower than what unit vectors of floats can tell apart.
constexpr float smallest_angle = 1e-6f;

float cone_of(const SunLight& light) { return one_minus_cos(std::min(light.angle, pi) / 2); }

Color radiance_of(const SunLight& light) {
  const float cone = cone_of(light);
  const float sin_squared = cone * (2 - cone);
  return light.irradiance / (pi * sin_squared);
}

// 1 - cos of the angle between two directions, of any length.
float one_minus_cos_between(Vec3f a, Vec3f b) {
  const Vec3d unit_a = normalize(Vec3d(a)), unit_b = normalize(Vec3d(b));
  return float(length_squared(unit_a - unit_b) / 2);
}

}  // namespace

bool is_delta_lamp(const SunLight& light) { return light.angle < smallest_angle; }

std::optional<LightSample> sample_lamp(const SunLight& light, Vec3f, Vec2f u) {
  const Vec3f towards = -normalize(light.direction);
  if (is_delta_lamp(light)) return LightSample{.wi = towards, .radiance = light.irradiance, .pdf = 1, .is_delta = true};
  const float cone = cone_of(light);
  return LightSample{.wi = normalize(make_frame(towards).to_world(sample_cone(u, cone))),
                     .radiance = radiance_of(light),
                     .pdf = pdf_cone(cone)};
}

std::optional<LightHit> intersect_lamp(const SunLight& light, const Ray& ray) {
  if (is_delta_lamp(light) || ray.t_max < infinity) return std::nullopt;
  const float cone = cone_of(light);
  if (one_minus_cos_between(ray.direction, -light.direction) >= cone) return std::nullopt;
  return LightHit{.t = infinity, .radiance = radiance_of(light), .pdf = pdf_cone(cone)};
}

// Rays start on a disc outside the scene, as wide as the scene and perpendicular to their direction.
EmissionSample sample_lamp_emission(const SunLight& light, Vec2f u_position, Vec2f u_direction, Vec3f scene_center,
                                    float scene_radius) {
  Vec3f direction = normalize(light.direction);
  float pdf_direction = 1;
  Color radiance = light.irradiance;
  if (!is_delta_lamp(light)) {
    const float cone = cone_of(light);
    direction = normalize(make_frame(direction).to_world(sample_cone(u_direction, cone)));
    pdf_direction = pdf_cone(cone);
    radiance = radiance_of(light);
  }
  const Vec2f on_disk = sample_disk(u_position) * scene_radius;
  const Vec3f start{on_disk.x, on_disk.y, -scene_radius};
  const float pdf_position = 1 / (pi * scene_radius * scene_radius);
  return {.ray = {.origin = scene_center + make_frame(direction).to_world(start), .direction = direction},
          .normal = direction,
          .weight = radiance / (pdf_position * pdf_direction),
          .pdf_position = pdf_position,
          .pdf_direction = pdf_direction};
}

EmissionPdf lamp_emission_pdf(const SunLight& light, Vec3f, Vec3f direction, float scene_radius) {
  const float pdf_position = 1 / (pi * scene_radius * scene_radius);
  if (is_delta_lamp(light)) return {pdf_position, 1};
  const float cone = cone_of(light);
  const bool is_inside = one_minus_cos_between(direction, light.direction) < cone;
  return {pdf_position, is_inside ? pdf_cone(cone) : 0};
}

DistantBounds lamp_bounds(const SunLight& light) {
  const float radius = is_delta_lamp(light) ? 0 : std::min(light.angle, pi) / 2;
  return {.towards = -normalize(light.direction),
          .cos_radius = std::cos(radius),
          .sin_radius = std::sin(radius),
          .irradiance = luminance(light.irradiance)};
}

// What falls on a disc as wide as the scene.
float lamp_power(const SunLight& light, float scene_radius) {
  return pi * scene_radius * scene_radius * luminance(light.irradiance);
}

}  // namespace basicrt
