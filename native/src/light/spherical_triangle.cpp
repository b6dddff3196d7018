// SPDX-License-Identifier: GPL-3.0-or-later
// Names follow the paper.
#include "light/spherical_triangle.h"

#include <algorithm>

namespace basicrt {
namespace {

// The part of x that is perpendicular to y, made unit.
Vec3d perpendicular_part(Vec3d x, Vec3d y) { return normalize(x - y * dot(x, y)); }

Vec3d turn(Vec3d from, Vec3d perpendicular, double cosine) {
  return from * cosine + perpendicular * std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
}

}  // namespace

SphericalTriangle::SphericalTriangle(Vec3d a, Vec3d b, Vec3d c) : a_(normalize(a)), b_(normalize(b)), c_(normalize(c)) {
  const double volume = std::abs(dot(a_, cross(b_, c_)));
  solid_angle_ = 2 * std::atan2(volume, 1 + dot(a_, b_) + dot(b_, c_) + dot(c_, a_));
}

Vec3d SphericalTriangle::sample(Vec2f u) const {
  // The inner angle alpha at a, by its sine and cosine: they are all that is needed of it.
  const double cos_c = dot(a_, b_);
  const double opposite = std::abs(dot(a_, cross(b_, c_))), adjacent = dot(b_, c_) - cos_c * dot(a_, c_);
  const double hypotenuse = std::sqrt(opposite * opposite + adjacent * adjacent);
  const double sin_alpha = opposite / hypotenuse, cos_alpha = adjacent / hypotenuse;
  // A triangle a b c' with the share u.x of the area, its corner c' on the edge from a to c: s and t are the sine and
  // cosine of that area less alpha.
  const double area = u.x * solid_angle_, sin_area = std::sin(area), cos_area = std::cos(area);
  const double s = sin_area * cos_alpha - cos_area * sin_alpha, t = cos_area * cos_alpha + sin_area * sin_alpha;
  const double p = t - cos_alpha, v = s + sin_alpha * cos_c;
  const double q = ((v * t - p * s) * cos_alpha - v) / ((v * s + p * t) * sin_alpha);
  const Vec3d c_prime = turn(a_, perpendicular_part(c_, a_), std::clamp(q, -1.0, 1.0));
  // A point on the arc from b to c'.
  const double z = 1 - u.y * (1 - dot(c_prime, b_));
  return turn(b_, perpendicular_part(c_prime, b_), z);
}

}  // namespace basicrt
