// SPDX-License-Identifier: GPL-3.0-or-later
// Each kind's normals and uv coordinates.
#include "light/lamp_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "light/ball.h"

namespace basicrt {
namespace {

// Of a ray that ends nowhere: finite, as materials compute with it.
constexpr float endless = std::numeric_limits<float>::max();

struct Place {
  Vec3f position, normal;
  Vec2f uv;
};

Vec3d to_local(const Transform& object_to_world, Vec3f direction) {
  return inverse(TransformD(object_to_world)).vector(Vec3d(direction));
}

// Longitude and latitude.
Vec2f uv_around(Vec3d direction) {
  const double size = length(direction);
  if (!(size > 0)) return {};
  const bool is_pole = direction.x == 0 && direction.y == 0;
  const double across = is_pole ? 0 : 0.5 - std::atan2(direction.x, direction.y) / (2 * std::numbers::pi);
  const double up = 1 - std::acos(std::clamp(direction.z / size, -1.0, 1.0)) / std::numbers::pi;
  return {float(across), float(up)};
}

Vec3f normal_of(Vec3f center, float radius, bool is_soft, Vec3f seen, Vec3f wi) {
  const Vec3d outwards = Vec3d(seen) - Vec3d(center);
  const bool is_round = radius >= smallest_ball_radius && !is_soft && length_squared(outwards) > 0;
  return is_round ? Vec3f(normalize(outwards)) : -wi;
}

Place place_on(const PointLight& light, Vec3f seen, Vec3f wi) {
  const Vec3f normal = normal_of(light.position, light.radius, light.is_soft, seen, wi);
  return {seen, normal, uv_around(to_local(light.object_to_world, normal))};
}

Place place_on(const SpotLamp& light, Vec3f seen, Vec3f wi) {
  const Vec3d local = light.to_local.vector(Vec3d(-wi));
  const double scale = 0.5 / (std::tan(double(light.angle) / 2) * -local.z);
  return {seen, normal_of(light.to_world.column(3), light.radius, light.is_soft, seen, wi),
          Vec2f{float(0.5 + local.x * scale), float(0.5 + local.y * scale)}};
}

Place place_on(const SunLight& light, Vec3f /*seen*/, Vec3f wi) {
  Vec2f uv{0.5f, 0.5f};
  if (light.angle > 0) {
    // On the disc of radius 1/2, equal areas for equal solid angles.
    const Vec3d local = to_local(light.object_to_world, wi);
    const Vec3d middle = normalize(Vec3d(light.direction));
    const double scale = 0.5 / (std::sin(double(light.angle) / 4) * length(Vec3d(wi) - middle));
    uv = {float(0.5 + local.x * scale), float(0.5 + local.y * scale)};
  }
  return {-wi, -wi, uv};
}

Place place_on(const AreaLamp& light, Vec3f seen, Vec3f /*wi*/) {
  const Vec3d from_center = Vec3d(seen) - light.center;
  return {seen, Vec3f(light.normal),
          Vec2f{float(0.5 + dot(from_center, light.dual_x)), float(0.5 + dot(from_center, light.dual_y))}};
}

}  // namespace

SurfacePoint lamp_point(const Lamp& lamp, Vec3f position, Vec3f wi, float distance, float time) {
  const Vec3f seen = distance < infinity ? position + wi * distance : Vec3f(0.0f);
  const Place place = std::visit([&](const auto& of_kind) { return place_on(of_kind, seen, wi); }, lamp.kind);
  SurfacePoint point;
  point.position = place.position;
  point.geometric_normal = point.shading_normal = place.normal;
  point.uv = place.uv;
  point.barycentrics = {place.uv.y, 1 - place.uv.x - place.uv.y};  // so that Parametric is uv
  point.t = std::min(distance, endless);
  point.time = time;
  point.primitive = Hit::none;
  point.is_backfacing = dot(place.normal, wi) > 0;
  return point;
}

}  // namespace basicrt
