// SPDX-License-Identifier: GPL-3.0-or-later
// Names follow the paper; angles are kept as points on the unit circle for as long as they are only added.
#include "light/spherical_rectangle.h"

#include <algorithm>
#include <numbers>

namespace basicrt {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

struct UnitComplex {
  double cos, sin;
};
UnitComplex operator*(UnitComplex a, UnitComplex b) {
  return {a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}
// In [0, 2 pi).
double angle_of(UnitComplex a) {
  const double angle = std::atan2(a.sin, a.cos);
  return angle < 0 ? angle + two_pi : angle;
}

// The plane through the eye and an edge at `offset`: of its unit normal, the component along the rectangle's normal,
// and one minus its square.
struct EdgePlane {
  double nz, rest;
};
EdgePlane make_edge_plane(double offset, double height) {
  const double squared = offset * offset + height * height;
  return {offset / std::sqrt(squared), height * height / squared};
}

// The inner angle at a corner: its cosine is -nz nz', its sine in a form that does not cancel.
UnitComplex corner_angle(EdgePlane a, EdgePlane b, double sign) {
  return {-sign * a.nz * b.nz, std::sqrt(a.rest + a.nz * a.nz * b.rest)};
}

}  // namespace

SphericalRectangle::SphericalRectangle(Vec2d min, Vec2d max, double height) : min_(min), max_(max), height_(height) {
  // Normals as in the paper: n0 = (0, z0, -y0), n1 = (-z0, 0, x1), n2 = (0, -z0, y1), n3 = (z0, 0, -x0), made unit.
  const EdgePlane y0 = make_edge_plane(min.y, height), x1 = make_edge_plane(max.x, height);
  const EdgePlane y1 = make_edge_plane(max.y, height), x0 = make_edge_plane(min.x, height);
  b0_ = -y0.nz;
  b1_ = y1.nz;
  const UnitComplex g01 = corner_angle(y0, x1, -1) * corner_angle(x1, y1, 1);
  const UnitComplex g23 = corner_angle(y1, x0, -1) * corner_angle(x0, y0, 1);
  // The angles add up to 2 pi plus the solid angle. Over pi it can only be where the eye is close over the rectangle;
  // elsewhere a negative angle is rounding.
  const UnitComplex sum = g01 * g23;
  const bool is_over = min.x < 0 && max.x > 0 && min.y < 0 && max.y > 0;
  const bool is_close = 2 * height < std::min(max.x - min.x, max.y - min.y);
  solid_angle_ = is_over && is_close ? angle_of(sum) : std::max(0.0, std::atan2(sum.sin, sum.cos));
  inner_cos_ = g23.cos;
  inner_sin_ = g23.sin;
}

Vec2d SphericalRectangle::sample(Vec2f u) const {
  const double au = u.x * solid_angle_ + two_pi - angle_of({inner_cos_, inner_sin_});
  const double fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
  // cu = sign(fu) / sqrt(fu^2 + b0^2) is the cosine of the angle to x, and cu / sqrt(1 - cu^2) its cotangent.
  const double y0_share = height_ * height_ / (min_.y * min_.y + height_ * height_);  // 1 - b0^2
  const double cotangent_squared = 1 / std::max(0.0, fu * fu - y0_share);
  const double x = std::clamp(std::copysign(std::sqrt(cotangent_squared), fu) * height_, min_.x, max_.x);

  const double d = std::sqrt(x * x + height_ * height_);
  const double h0 = min_.y / std::sqrt(d * d + min_.y * min_.y);
  const double h1 = max_.y / std::sqrt(d * d + max_.y * max_.y);
  const double hv = h0 + u.y * (h1 - h0);
  const double y = hv * d / std::sqrt(std::max(1e-300, (1 - hv) * (1 + hv)));
  return {x, std::clamp(y, min_.y, max_.y)};
}

}  // namespace basicrt
