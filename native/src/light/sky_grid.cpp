// SPDX-License-Identifier: GPL-3.0-or-later
// One half of each row is computed, and mirrored.
#include "light/sky_grid.h"

#include <cmath>
#include <vector>

#include "base/parallel_for.h"
#include "math/constants.h"

namespace basicrt {

float azimuth_of(const SkyGrid& grid, int column) {
  return (0.5f - (float(column) + grid.place.column) / float(grid.width)) * 2 * pi;
}

Image draw_sky_grid(const SkyGrid& grid, const std::function<Color(SkyPlace)>& color_of, int threads) {
  std::vector<float> pixels(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height) * 3);
  parallel_for(static_cast<std::size_t>(grid.height), threads, [&](std::size_t row) {
    const float v = (float(row) + grid.place.row) / float(grid.height), from_horizon = 2 * v - 1;
    const float elevation = std::copysign(from_horizon * from_horizon * (pi / 2), from_horizon);
    float* line = pixels.data() + row * static_cast<std::size_t>(grid.width) * 3;
    for (int x = 0; 2 * x < grid.width; ++x) {
      const Color color = color_of({.elevation = elevation, .azimuth = azimuth_of(grid, x), .column = x});
      for (const int column : {x, grid.width - 1 - x}) {
        float* pixel = line + std::ptrdiff_t{column} * 3;
        pixel[0] = color.x, pixel[1] = color.y, pixel[2] = color.z;
      }
    }
  });
  return {.width = grid.width, .height = grid.height, .channels = 3, .pixels = std::move(pixels), .path = {}};
}

// IEC 61966-2-1.
Color color_from_xyz(Vec3f xyz) {
  return {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
          -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
          0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
}

}  // namespace basicrt
