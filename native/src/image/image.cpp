// SPDX-License-Identifier: GPL-3.0-or-later
// The sRGB transfer curve.
#include "image/image.h"

#include <cmath>

namespace basicrt {

float srgb_to_linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace basicrt
