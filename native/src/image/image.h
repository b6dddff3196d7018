// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in memory: floats with one to four channels, row 0 at the bottom.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace basicrt {

struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;  // height x width x channels, scene-linear
  std::string path;           // the file it was read from, or empty

  [[nodiscard]] const float* pixel(int x, int y) const {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

// The sRGB curve (IEC 61966-2-1), exact, for values in [0, 1] and continued linearly below.
[[nodiscard]] float srgb_to_linear(float encoded);

}  // namespace basicrt
