// SPDX-License-Identifier: GPL-3.0-or-later
// A world that is a graph of nodes becomes a picture.
#pragma once

#include "bsdf/bsdf.h"
#include "image/image.h"

namespace basicrt {

struct EnvironmentDrawing {
  int width = 1024, height = 512;
  bool is_camera_ray = true;  // what the camera sees, or what light that has scattered does
};

// What a material that emits looks like in each direction, equirectangular: its programs run at points a metre away.
[[nodiscard]] Image draw_environment(const Material& material, const Table<Texture>& textures,
                                     const EnvironmentDrawing& drawing, int threads);

}  // namespace basicrt
