// SPDX-License-Identifier: GPL-3.0-or-later
// The directions in which a triangle is seen, sampled uniformly over solid angle.
#pragma once

#include "math/vec.h"

namespace basicrt {

// Arvo 1995, "Stratified Sampling of Spherical Triangles".
class SphericalTriangle {
 public:
  // Corners relative to the eye, none of them at it.
  SphericalTriangle(Vec3d a, Vec3d b, Vec3d c);

  // Van Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle"; at most 2 pi.
  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  // A direction of unit length. Not for triangles that fill hardly anything or all of a hemisphere.
  [[nodiscard]] Vec3d sample(Vec2f u) const;

 private:
  Vec3d a_, b_, c_;  // unit vectors
  double solid_angle_;
};

}  // namespace basicrt
