// SPDX-License-Identifier: GPL-3.0-or-later
// Looks textures up.
#include "shading/texture.h"

#include <cmath>

#include "base/overloaded.h"
#include "shading/texture_values.h"

namespace basicrt {
namespace {

Color eval_checkerboard(const CheckerboardTexture& texture, Vec2f uv) {
  const Vec2f cell = uv * texture.scale + texture.delta;
  const float half = (std::floor(cell.x) + std::floor(cell.y)) / 2;
  return half == std::floor(half) ? texture.color0 : texture.color1;
}

Rgba eval_image_texture(const ImageTexture& texture, Vec2f uv) {
  if (texture.image.is_empty()) return {};
  const Vec3f place = texture.uv_to_image.point(Vec3f{uv.x, uv.y, 0});
  return eval_image(texture.image, {texture.interpolation, texture.extension, texture.is_divided_by_alpha},
                    {place.x, place.y});
}

}  // namespace

Rgba eval_texture(const Texture& texture, Vec2f uv) {
  Rgba value = eval_texture_values(texture, uv);
  value.color = max(value.color, Color(0.0f));
  return value;
}

Rgba eval_texture_values(const Texture& texture, Vec2f uv) {
  return std::visit(Overloaded{[](const ConstantTexture& t) { return Rgba{t.color}; },
                               [&](const CheckerboardTexture& t) { return Rgba{eval_checkerboard(t, uv)}; },
                               [&](const ImageTexture& t) { return eval_image_texture(t, uv); }},
                    texture);
}

}  // namespace basicrt
