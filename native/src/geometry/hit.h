// SPDX-License-Identifier: GPL-3.0-or-later
// Where a ray met a surface, as small as the tracer needs it.
#pragma once

#include <cstdint>

#include "math/constants.h"

namespace basicrt {

// On a triangle the point is (1 - u - v) p0 + u p1 + v p2; on a curve u is along the segment and v across a ribbon, from
// -1 to 1; on spheres and points both are 0, for what it takes to find coordinates there most hits never need.
struct Hit {
  static constexpr std::uint32_t none = ~0u;

  float t = infinity;  // along the ray as it was given
  std::uint32_t instance = none;
  std::uint32_t primitive = none;
  float u = 0, v = 0;

  [[nodiscard]] bool is_hit() const { return instance != none; }
};

}  // namespace basicrt
