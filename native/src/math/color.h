// SPDX-License-Identifier: GPL-3.0-or-later
// Scene-linear Rec.709 colour.
#pragma once

#include "math/vec.h"

namespace basicrt {

using Color = Vec3f;

constexpr float luminance(Color c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
constexpr float average(Color c) { return (c.x + c.y + c.z) * (1.0f / 3.0f); }
constexpr bool is_black(Color c) { return c.x == 0 && c.y == 0 && c.z == 0; }

}  // namespace basicrt
