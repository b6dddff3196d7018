// SPDX-License-Identifier: GPL-3.0-or-later
// A point lamp of which each direction keeps a share, by its angle to the axis in the lamp's local frame.
#include "light/spot.h"

#include "light/ball.h"
#include "light/solid_angle.h"
#include "math/warp.h"

namespace basicrt {
namespace {

Ball ball_of(const SpotLamp& light) { return {light.to_world.column(3), light.radius, light.is_soft}; }

Color radiance_of(const SpotLamp& light) { return light.intensity / (pi * light.radius * light.radius); }

// 1 - cos of the angle between a direction in local space and -z.
float one_minus_cos_to_axis(Vec3d local) {
  const double sideways = local.x * local.x + local.y * local.y;
  const double local_length = std::sqrt(sideways + local.z * local.z);
  if (local.z > 0) return float(1 + local.z / local_length);
  return float(sideways / (local_length * (local_length - local.z)));
}

// The share of the intensity that is left where 1 - cos of the angle to the axis is `x`.
float share_at(const SpotLamp& light, float x) {
  if (x >= light.cone) return 0;
  const float fading = light.cone * light.blend;
  const float t = fading > 0 ? std::min(1.0f, (light.cone - x) / fading) : 1;
  return t * t * (3 - 2 * t);
}

float share_towards(const SpotLamp& light, Vec3f direction) {
  return share_at(light, one_minus_cos_to_axis(light.to_local.vector(Vec3d(direction))));
}

float direction_pdf(const SpotLamp& light, Vec3f direction) {
  const Vec3d local = light.to_local.vector(Vec3d(direction));
  if (one_minus_cos_to_axis(local) >= light.cone) return 0;
  return pdf_cone(light.cone) * float(solid_angle_ratio(TransformD(light.to_world), normalize(local)));
}

}  // namespace

SpotLamp::SpotLamp(const SpotLight& light)
    : SpotLight(light),
      to_local(inverse(TransformD(light.to_world))),
      cone(one_minus_cos(std::min(light.angle, 2 * pi) / 2)) {}

bool is_delta_lamp(const SpotLamp& light) { return light.radius < smallest_ball_radius; }

std::optional<LightSample> sample_lamp(const SpotLamp& light, Vec3f position, Vec2f u) {
  if (is_delta_lamp(light)) {
    const Vec3d to_light = Vec3d(light.to_world.column(3)) - Vec3d(position);
    const double distance = length(to_light);
    if (!(distance > 0)) return std::nullopt;
    const Vec3f wi(to_light / distance);
    return LightSample{.wi = wi,
                       .distance = float(distance),
                       .radiance = light.intensity * (share_towards(light, -wi) / float(distance * distance)),
                       .pdf = 1,
                       .is_delta = true};
  }
  const std::optional<BallSample> sample = sample_ball(ball_of(light), position, u);
  if (!sample) return std::nullopt;
  return LightSample{.wi = sample->wi,
                     .distance = sample->distance,
                     .radiance = radiance_of(light) * share_towards(light, -sample->wi),
                     .pdf = sample->pdf};
}

std::optional<LightHit> intersect_lamp(const SpotLamp& light, const Ray& ray) {
  if (is_delta_lamp(light)) return std::nullopt;
  const std::optional<BallHit> hit = intersect_ball(ball_of(light), ray);
  if (!hit) return std::nullopt;
  return LightHit{.t = hit->t, .radiance = radiance_of(light) * share_towards(light, -ray.direction), .pdf = hit->pdf};
}

// As for a point lamp, a soft one starts its paths as a sphere.
EmissionSample sample_lamp_emission(const SpotLamp& light, Vec2f u_position, Vec2f u_direction, Vec3f, float) {
  const Vec3d in_cone(sample_cone(u_direction, light.cone));
  const Vec3d local{in_cone.x, in_cone.y, -in_cone.z};
  const Vec3f direction(normalize(TransformD(light.to_world).vector(local)));
  const float pdf_direction = pdf_cone(light.cone) * float(solid_angle_ratio(TransformD(light.to_world), local));
  const Color weight = light.intensity * (share_at(light, one_minus_cos_to_axis(local)) / pdf_direction);
  if (is_delta_lamp(light))
    return {.ray = {.origin = light.to_world.column(3), .direction = direction},
            .normal = direction,
            .weight = weight,
            .pdf_position = 1,
            .pdf_direction = pdf_direction};
  const BallPoint point = sample_ball_point(ball_of(light), direction, u_position);
  return {.ray = {.origin = point.position, .direction = direction},
          .normal = point.normal,
          .weight = weight,
          .pdf_position = ball_position_pdf(ball_of(light), point.position, direction),
          .pdf_direction = pdf_direction};
}

EmissionPdf lamp_emission_pdf(const SpotLamp& light, Vec3f position, Vec3f direction, float) {
  return {is_delta_lamp(light) ? 1 : ball_position_pdf(ball_of(light), position, direction),
          direction_pdf(light, direction)};
}

float beam_share(const SpotLamp& light, Vec3f position) {
  return share_towards(light, position - light.to_world.column(3));
}

// The cone as if everything in it were a normal. A transform that isn't a similarity may widen it: then nothing is said.
LightBounds lamp_bounds(const SpotLamp& light) {
  const TransformD to_world(light.to_world);
  const Vec3d x = to_world.column(0), y = to_world.column(1), z = to_world.column(2);
  const double scale = length_squared(z), slack = 1e-5 * scale;
  const bool is_similarity = std::abs(length_squared(x) - scale) <= slack &&
                             std::abs(length_squared(y) - scale) <= slack && std::abs(dot(x, y)) <= slack &&
                             std::abs(dot(x, z)) <= slack && std::abs(dot(y, z)) <= slack;
  return {.box = box_of(ball_of(light)),
          .axis = Vec3f(-normalize(z)),
          .cos_normals = is_similarity ? 1 - light.cone : -1,
          .cos_emission = 1,
          .is_solid = !is_delta_lamp(light),
          .intensity = luminance(light.intensity)};
}

// Exact where the scale is the same along every axis: the integral of the share over the cone.
float lamp_power(const SpotLamp& light, float) {
  const float solid_angle = 2 * pi * light.cone * (1 - light.blend / 2);
  const float squeezed = solid_angle / float(solid_angle_ratio(TransformD(light.to_world), {0, 0, -1}));
  return std::min(squeezed, 4 * pi) * luminance(light.intensity);
}

}  // namespace basicrt
