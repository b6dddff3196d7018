// SPDX-License-Identifier: GPL-3.0-or-later
// What arrives from layers.
#include "light/environment.h"

#include <algorithm>

namespace basicrt {

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
