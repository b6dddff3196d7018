// SPDX-License-Identifier: GPL-3.0-or-later
// Textures as numbers, for programs: of offsets and normals some are negative.
#pragma once

#include "shading/texture.h"

namespace basicrt {

// As eval_texture(), which gives colours: with the negative numbers that an image of floats has.
[[nodiscard]] Rgba eval_texture_values(const Texture& texture, Vec2f uv);

}  // namespace basicrt
