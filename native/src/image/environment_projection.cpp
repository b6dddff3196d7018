// SPDX-License-Identifier: GPL-3.0-or-later
// Longitudes, latitudes and mirror balls.
#include "image/environment_projection.h"

#include <cmath>

#include "math/constants.h"

namespace basicrt {
namespace {

Vec2f project_equirectangular(Vec3f d) {
  const float longitude = std::atan2(d.y, d.x), latitude = std::atan2(d.z, std::sqrt(d.x * d.x + d.y * d.y));
  return {0.5f - longitude * (inv_pi / 2), latitude * inv_pi + 0.5f};
}

Vec2f project_horizon(Vec3f d) {
  const Vec2f even = project_equirectangular(d);
  const float height = 2 * even.y - 1;
  return {even.x, 0.5f + std::copysign(std::sqrt(std::abs(height)) / 2, height)};
}

// The sphere's normal lies halfway between the direction and the way back to the camera, which looks along y.
Vec2f project_mirror_ball(Vec3f d) {
  const float squared = length_squared(d);
  if (!(squared > 0)) return {0.5f, 0.5f};
  const Vec3f halfway = d * (1 / std::sqrt(squared)) - Vec3f{0, 1, 0};
  const float size = length(halfway);
  if (!(size > 0)) return {0.5f, 0.5f};  // straight behind the ball
  return {(halfway.x / size + 1) / 2, (halfway.z / size + 1) / 2};
}

}  // namespace

Vec2f project_direction(EnvironmentProjection projection, Vec3f direction) {
  switch (projection) {
    case EnvironmentProjection::mirror_ball:
      return project_mirror_ball(direction);
    case EnvironmentProjection::horizon:
      return project_horizon(direction);
    case EnvironmentProjection::equirectangular:
      break;
  }
  return project_equirectangular(direction);
}

Vec3f equirectangular_direction(Vec2f uv) {
  const float longitude = (0.5f - uv.x) * 2 * pi, latitude = (uv.y - 0.5f) * pi, across = std::cos(latitude);
  return {across * std::cos(longitude), across * std::sin(longitude), std::sin(latitude)};
}

}  // namespace basicrt
