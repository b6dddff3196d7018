// SPDX-License-Identifier: GPL-3.0-or-later
// Colours over the surface's uv coordinates.
#pragma once

#include <string_view>
#include <variant>

#include "base/describe.h"
#include "image/image_lookup.h"
#include "math/color.h"
#include "math/transform.h"

namespace basicrt {

struct ConstantTexture {
  Color color{1.0f};
  static constexpr std::string_view kind = "constant";
  static constexpr auto fields() { return fields_of(field("color", &ConstantTexture::color, "scene-linear")); }
};

// color0 where the cells' indices add up to an even number.
struct CheckerboardTexture {
  Color color0{0.0f}, color1{1.0f};
  Vec2f scale{1, 1}, delta{0, 0};  // cells are of size one in uv * scale + delta
  static constexpr std::string_view kind = "checkerboard";
  static constexpr auto fields() {
    return fields_of(field("color0", &CheckerboardTexture::color0, "scene-linear"),
                     field("color1", &CheckerboardTexture::color1, "scene-linear"),
                     field("scale", &CheckerboardTexture::scale, "multiplies uv"),
                     field("delta", &CheckerboardTexture::delta, "added to uv after scaling"));
  }
};

struct ImageTexture {
  Image image;
  ImageInterpolation interpolation = ImageInterpolation::linear;
  ImageExtension extension = ImageExtension::repeat;
  Transform uv_to_image;             // of (u, v, 0); may flatten
  bool is_divided_by_alpha = false;  // where the image's colour is multiplied by its alpha
  static constexpr std::string_view kind = "image";
  static constexpr auto fields() {
    return fields_of(field("interpolation", &ImageTexture::interpolation, "between pixels: linear, closest or cubic"),
                     field("extension", &ImageTexture::extension, "beyond the edges: repeat, extend, clip or mirror"),
                     field("uv_transform", &ImageTexture::uv_to_image, "of (u, v, 0), before the image is looked up"),
                     field("divide_by_alpha", &ImageTexture::is_divided_by_alpha,
                           "divides the colour by alpha, where the image's is multiplied by it"));
  }
};

using Texture = std::variant<ConstantTexture, CheckerboardTexture, ImageTexture>;

// Colours are at least 0; only images have an alpha.
[[nodiscard]] Rgba eval_texture(const Texture& texture, Vec2f uv);

}  // namespace basicrt
