// SPDX-License-Identifier: GPL-3.0-or-later
// The sRGB transfer curve, and pixels through it.
#include "image/image.h"

#include <cmath>

#include "math/vec.h"

namespace basicrt {
namespace {

struct ByteTable {
  std::array<float, 256> linear, srgb;

  ByteTable() {
    for (std::size_t i = 0; i < 256; ++i) {
      linear[i] = static_cast<float>(i) / 255;
      srgb[i] = srgb_to_linear(linear[i]);
    }
  }
};

const std::array<float, 256>& decoded_bytes(ByteEncoding encoding) {
  static const ByteTable table;
  return encoding == ByteEncoding::srgb ? table.srgb : table.linear;
}

template <class Decode, class Sample>
Color decode_pixel(const Sample* p, int channels, Decode&& decode) {
  return channels >= 3 ? Color{decode(p[0]), decode(p[1]), decode(p[2])} : Color(decode(p[0]));
}

}  // namespace

Color pixel_color(const Image& image, int x, int y) {
  const std::size_t offset = image.offset(x, y);
  if (image.bytes.empty())
    return decode_pixel(image.pixels.data() + offset, image.channels, [](float value) { return value; });
  const std::array<float, 256>& decoded = decoded_bytes(image.encoding);
  return decode_pixel(image.bytes.data() + offset, image.channels, [&](std::uint8_t byte) { return decoded[byte]; });
}

Color average_color(const Image& image) {
  Vec3d sum(0.0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += Vec3d(pixel_color(image, x, y));
  return Color(sum / (double(image.width) * image.height));
}

float srgb_to_linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace basicrt
