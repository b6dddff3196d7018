// SPDX-License-Identifier: GPL-3.0-or-later
// Colours over the surface's uv coordinates.
#pragma once

#include <string_view>
#include <tuple>
#include <variant>

#include "base/describe.h"
#include "image/image.h"
#include "math/color.h"

namespace basicrt {

struct ConstantTexture {
  Color color{1.0f};
  static constexpr std::string_view kind = "constant";
  static constexpr auto fields() { return std::tuple{field("color", &ConstantTexture::color, "scene-linear")}; }
};

// color0 where the cells' indices add up to an even number.
struct CheckerboardTexture {
  Color color0{0.0f}, color1{1.0f};
  Vec2f scale{1, 1}, delta{0, 0};  // cells are of size one in uv * scale + delta
  static constexpr std::string_view kind = "checkerboard";
  static constexpr auto fields() {
    return std::tuple{field("color0", &CheckerboardTexture::color0, "scene-linear"),
                      field("color1", &CheckerboardTexture::color1, "scene-linear"),
                      field("scale", &CheckerboardTexture::scale, "multiplies uv"),
                      field("delta", &CheckerboardTexture::delta, "added to uv after scaling")};
  }
};

// Bilinear, repeated.
struct ImageTexture {
  Image image;
  static constexpr std::string_view kind = "image";
  static constexpr auto fields() { return std::tuple{}; }
};

using Texture = std::variant<ConstantTexture, CheckerboardTexture, ImageTexture>;

[[nodiscard]] Color eval_texture(const Texture& texture, Vec2f uv);

}  // namespace basicrt
