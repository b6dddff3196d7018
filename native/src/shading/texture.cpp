// SPDX-License-Identifier: GPL-3.0-or-later
// Looks textures up.
#include "shading/texture.h"

#include <algorithm>
#include <cmath>

#include "base/overloaded.h"

namespace basicrt {
namespace {

Color eval_checkerboard(const CheckerboardTexture& texture, Vec2f uv) {
  const Vec2f cell = uv * texture.scale + texture.delta;
  const float half = (std::floor(cell.x) + std::floor(cell.y)) / 2;
  return half == std::floor(half) ? texture.color0 : texture.color1;
}

// One or two channels are a grey (and its alpha), three or four a colour (and its alpha).
Color texel(const Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return image.channels >= 3 ? Color{p[0], p[1], p[2]} : Color(p[0]);
}

// A texture coordinate as two neighbouring texels and how far it is from the first to the second. Texel centres lie
// at half-integers.
struct TexelPair {
  int first, second;
  float fraction;
};

TexelPair find_texels(float coordinate, int size) {
  const float place = (coordinate - std::floor(coordinate)) * static_cast<float>(size) - 0.5f;
  const float first = std::floor(place);
  const int index = std::min(static_cast<int>(first), size - 1);
  return {index < 0 ? size - 1 : index, index + 1 < size ? index + 1 : 0, place - first};
}

Color eval_image(const Image& image, Vec2f uv) {
  if (image.pixels.empty()) return Color(0.0f);
  const TexelPair x = find_texels(uv.x, image.width), y = find_texels(uv.y, image.height);
  const Color lower = lerp(texel(image, x.first, y.first), texel(image, x.second, y.first), x.fraction);
  const Color upper = lerp(texel(image, x.first, y.second), texel(image, x.second, y.second), x.fraction);
  return lerp(lower, upper, y.fraction);
}

}  // namespace

Color eval_texture(const Texture& texture, Vec2f uv) {
  return std::visit(Overloaded{[](const ConstantTexture& t) { return t.color; },
                               [&](const CheckerboardTexture& t) { return eval_checkerboard(t, uv); },
                               [&](const ImageTexture& t) { return eval_image(t.image, uv); }},
                    texture);
}

}  // namespace basicrt
