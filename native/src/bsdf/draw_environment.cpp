// SPDX-License-Identifier: GPL-3.0-or-later
// A pixel is what its middle shows.
#include "bsdf/draw_environment.h"

#include <utility>
#include <vector>

#include "base/parallel_for.h"
#include "image/environment_projection.h"
#include "math/ray.h"
#include "shading/program.h"

namespace basicrt {

Image draw_environment(const Material& material, const Table<Texture>& textures, const EnvironmentDrawing& drawing,
                       int threads) {
  const Material compiled = compile(material, textures);
  ShadingContext context;
  context.ray_kinds = drawing.is_camera_ray ? ray_camera : ray_diffuse;
  const auto width = static_cast<std::size_t>(drawing.width), height = static_cast<std::size_t>(drawing.height);
  std::vector<float> pixels(width * height * 3);
  parallel_for(height, threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < width; ++column) {
      const Vec2f uv{(static_cast<float>(column) + 0.5f) / static_cast<float>(width),
                     (static_cast<float>(row) + 0.5f) / static_cast<float>(height)};
      SurfacePoint point;
      point.position = equirectangular_direction(uv);
      point.geometric_normal = point.shading_normal = -point.position;
      const Color color = shade(compiled, textures, point, -point.position, context).emission;
      for (std::size_t i = 0; i < 3; ++i) pixels[(row * width + column) * 3 + i] = color[i];
    }
  });
  return {.width = drawing.width, .height = drawing.height, .channels = 3, .pixels = std::move(pixels), .path = {}};
}

}  // namespace basicrt
