// SPDX-License-Identifier: GPL-3.0-or-later
// A point, or a ball of radiance intensity / (pi radius^2).
#include "light/point.h"

#include "light/ball.h"
#include "math/warp.h"

namespace basicrt {
namespace {

Ball ball_of(const PointLight& light) { return {light.position, light.radius, light.is_soft}; }

Color radiance_of(const PointLight& light) { return light.intensity / (pi * light.radius * light.radius); }

}  // namespace

bool is_delta_lamp(const PointLight& light) { return light.radius < smallest_ball_radius; }

std::optional<LightSample> sample_lamp(const PointLight& light, Vec3f position, Vec2f u) {
  if (is_delta_lamp(light)) {
    const Vec3d to_light = Vec3d(light.position) - Vec3d(position);
    const double distance = length(to_light);
    if (!(distance > 0)) return std::nullopt;
    return LightSample{.wi = Vec3f(to_light / distance),
                       .distance = float(distance),
                       .radiance = light.intensity * float(1 / (distance * distance)),
                       .pdf = 1,
                       .is_delta = true};
  }
  const std::optional<BallSample> sample = sample_ball(ball_of(light), position, u);
  if (!sample) return std::nullopt;
  return LightSample{
      .wi = sample->wi, .distance = sample->distance, .radiance = radiance_of(light), .pdf = sample->pdf};
}

std::optional<LightHit> intersect_lamp(const PointLight& light, const Ray& ray) {
  if (is_delta_lamp(light)) return std::nullopt;
  const std::optional<BallHit> hit = intersect_ball(ball_of(light), ray);
  if (!hit) return std::nullopt;
  return LightHit{.t = hit->t, .radiance = radiance_of(light), .pdf = hit->pdf};
}

// A soft lamp starts its paths as the sphere that it stands for: both shine alike on what is far away.
EmissionSample sample_lamp_emission(const PointLight& light, Vec2f u_position, Vec2f u_direction, Vec3f, float) {
  const Vec3f direction = sample_sphere(u_direction);
  const Color weight = light.intensity / pdf_sphere;
  if (is_delta_lamp(light))
    return {.ray = {.origin = light.position, .direction = direction},
            .normal = direction,
            .weight = weight,
            .pdf_position = 1,
            .pdf_direction = pdf_sphere};
  const BallPoint point = sample_ball_point(ball_of(light), direction, u_position);
  return {.ray = {.origin = point.position, .direction = direction},
          .normal = point.normal,
          .weight = weight,
          .pdf_position = ball_position_pdf(ball_of(light), point.position, direction),
          .pdf_direction = pdf_sphere};
}

EmissionPdf lamp_emission_pdf(const PointLight& light, Vec3f position, Vec3f direction, float) {
  return {is_delta_lamp(light) ? 1 : ball_position_pdf(ball_of(light), position, direction), pdf_sphere};
}

LightBounds lamp_bounds(const PointLight& light) {
  return {.box = box_of(ball_of(light)), .is_solid = !is_delta_lamp(light), .intensity = luminance(light.intensity)};
}

float lamp_power(const PointLight& light, float) { return 4 * pi * luminance(light.intensity); }

}  // namespace basicrt
