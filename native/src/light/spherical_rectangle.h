// SPDX-License-Identifier: GPL-3.0-or-later
// The directions in which a rectangle is seen, sampled uniformly over solid angle.
#pragma once

#include "math/vec.h"

namespace basicrt {

// Ureña, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles". The rectangle is
// [min.x, max.x] x [min.y, max.y] at the given height over the eye, in coordinates around the eye.
class SphericalRectangle {
 public:
  SphericalRectangle(Vec2d min, Vec2d max, double height);

  // Good to about 1e-15 steradians, whatever the shape.
  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  // A point on the rectangle, in the same coordinates.
  [[nodiscard]] Vec2d sample(Vec2f u) const;

 private:
  Vec2d min_, max_;
  double height_;
  double b0_, b1_;  // z of the normals of the planes through the eye and the edges y = min.y and y = max.y
  // The two inner angles at x = min.x together, as a point on the unit circle.
  double inner_cos_, inner_sin_;
  double solid_angle_;
};

}  // namespace basicrt
