// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in memory: one to four channels of floats or of bytes, row 0 at the bottom.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/describe.h"
#include "base/shared_array.h"
#include "math/color.h"

namespace basicrt {

// How bytes stand for scene-linear colour.
enum class ByteEncoding : std::uint8_t { linear, srgb };
template <>
inline constexpr std::array enum_names<ByteEncoding> = std::to_array<std::string_view>({"linear", "srgb"});

// One or two channels are a grey and its alpha, three or four a colour and its alpha. Copies share their pixels.
struct Image {
  int width = 0, height = 0, channels = 0;
  SharedArray<float> pixels;  // height x width x channels, scene-linear
  std::string path;           // the file it was read from, or empty
  // Instead of `pixels`: 255 is 1. Alpha is never encoded.
  SharedArray<std::uint8_t> bytes{};
  ByteEncoding encoding = ByteEncoding::srgb;

  [[nodiscard]] bool is_empty() const { return pixels.empty() && bytes.empty(); }
  [[nodiscard]] bool has_alpha() const { return channels == 2 || channels == 4; }
  [[nodiscard]] bool has_same_pixels(const Image& other) const {
    return pixels.is_same(other.pixels) && bytes.is_same(other.bytes) && width == other.width &&
           encoding == other.encoding;
  }
  // Of floats.
  [[nodiscard]] const float* pixel(int x, int y) const { return pixels.data() + offset(x, y); }
  [[nodiscard]] std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

// Scene-linear colour and opacity.
struct Rgba {
  Color color{0.0f};
  float alpha = 1;
};

// One pixel's colour, decoded.
[[nodiscard]] Color pixel_color(const Image& image, int x, int y);
[[nodiscard]] Color average_color(const Image& image);

// The sRGB curve (IEC 61966-2-1), exact, for values in [0, 1] and continued linearly below.
[[nodiscard]] float srgb_to_linear(float encoded);

}  // namespace basicrt
