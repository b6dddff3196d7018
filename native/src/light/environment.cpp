// SPDX-License-Identifier: GPL-3.0-or-later
// From directions to places in pictures.
#include "light/environment.h"

#include <algorithm>
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

Color eval_layer(const EnvironmentLayer& layer, Vec3f direction) {
  if (layer.image.is_empty()) return layer.radiance;
  Vec2f uv = project_direction(layer.projection, layer.to_image.point(direction));
  if (layer.projection == EnvironmentProjection::horizon) {  // one pole doesn't shine into the other
    const float edge = 0.5f / static_cast<float>(layer.image.height);
    uv.y = std::clamp(uv.y, edge, 1 - edge);
  }
  const ImageLookup lookup{.interpolation = layer.interpolation, .extension = ImageExtension::repeat};
  return layer.radiance * max(eval_image(layer.image, lookup, uv).color, Color(0.0f));
}

Color eval_environment(const Environment& environment, Vec3f direction, bool is_camera_ray) {
  const EnvironmentRays unseen = is_camera_ray ? EnvironmentRays::scattered : EnvironmentRays::camera;
  Color sum = environment.radiance;
  for (const EnvironmentLayer& layer : environment.layers)
    if (layer.seen_by != unseen) sum += eval_layer(layer, direction);
  return sum;
}

}  // namespace basicrt
