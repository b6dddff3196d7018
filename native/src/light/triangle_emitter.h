// SPDX-License-Identifier: GPL-3.0-or-later
// One triangle that shines, sampled towards a position: by solid angle where it is seen large, else by area.
#pragma once

#include <optional>

#include "math/vec.h"

namespace basicrt {

// World space.
struct EmitterTriangle {
  Vec3d p0, p1, p2;

  [[nodiscard]] Vec3d cross_product() const { return cross(p1 - p0, p2 - p0); }
  [[nodiscard]] double area() const { return length(cross_product()) / 2; }
};

struct TrianglePlace {
  Vec3d offset;    // from the position
  double pdf = 0;  // over solid angle
};
// Nothing where the position is in the triangle's plane, as near as can be told.
[[nodiscard]] std::optional<TrianglePlace> sample_triangle_emitter(const EmitterTriangle& triangle, Vec3d position,
                                                                   Vec2f u);
// The density of that for a place on the triangle.
[[nodiscard]] double pdf_triangle_emitter(const EmitterTriangle& triangle, Vec3d position, Vec3d offset);

}  // namespace basicrt
