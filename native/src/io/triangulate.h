// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons into triangles. (tinyobjloader can, but fills in concave ones that touch the origin.)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vec.h"

namespace basicrt {

// Triples of corners, two fewer than the polygon has, wound as it is. It may be concave, should be flat and not cross
// itself; otherwise some triangles overlap.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec3f> polygon);

}  // namespace basicrt
