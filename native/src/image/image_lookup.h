// SPDX-License-Identifier: GPL-3.0-or-later
// The value of a picture between its pixels and beyond its edges.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "image/image.h"
#include "math/vec.h"

namespace basicrt {

// Cubic is the uniform cubic B-spline: smooth, and not through the pixels' own values.
enum class ImageInterpolation : std::uint8_t { linear, closest, cubic };
template <>
inline constexpr std::array enum_names<ImageInterpolation> =
    std::to_array<std::string_view>({"linear", "closest", "cubic"});

// What lies beyond the edges: the picture again, its outermost pixels, nothing (black, alpha 0), or its mirror image.
enum class ImageExtension : std::uint8_t { repeat, extend, clip, mirror };
template <>
inline constexpr std::array enum_names<ImageExtension> =
    std::to_array<std::string_view>({"repeat", "extend", "clip", "mirror"});

struct ImageLookup {
  ImageInterpolation interpolation = ImageInterpolation::linear;
  ImageExtension extension = ImageExtension::repeat;
  bool is_divided_by_alpha = false;  // the colour, where the picture's is multiplied by alpha
};

// (0, 0) is the lower left corner, (1, 1) the upper right one; pixels' centres lie halfway between their edges. As
// in Blender, bytes are interpolated as they are and decoded afterwards. Alpha is 1 where the picture has none.
[[nodiscard]] Rgba eval_image(const Image& image, const ImageLookup& lookup, Vec2f uv);

}  // namespace basicrt
