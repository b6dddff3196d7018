// SPDX-License-Identifier: GPL-3.0-or-later
// One cubic piece of a curve, in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "geometry/curves.h"
#include "math/bounds.h"
#include "math/next_float.h"

namespace basicrt {

// From u = 0 to u = 1.
struct CurveSegment {
  std::array<Vec3d, 4> points;  // coefficients of 1, u, u^2 and u^3
  std::array<double, 4> radii;
  bool is_first = true, is_last = true;  // of its curve: there it ends with half a sphere

  template <class T>
  static T eval(const std::array<T, 4>& c, double u) {
    return ((c[3] * u + c[2]) * u + c[1]) * u + c[0];
  }
  template <class T>
  static T derivative(const std::array<T, 4>& c, double u) {
    return (c[3] * (3 * u) + c[2] * 2.0) * u + c[1];
  }
  [[nodiscard]] Vec3d point(double u) const { return eval(points, u); }
  [[nodiscard]] Vec3d tangent(double u) const { return derivative(points, u); }
  // The spline may go below zero between radii that are not.
  [[nodiscard]] double radius(double u) const { return std::max(eval(radii, u), 0.0); }
};

// The end points of a curve count twice.
template <class T>
std::array<T, 4> catmull_rom(const T& before, const T& from, const T& to, const T& after) {
  return {from, (to - before) * 0.5, before - from * 2.5 + to * 2.0 - after * 0.5,
          (after - before) * 0.5 + (from - to) * 1.5};
}

// `first` to `end` are the curve's points, `segment` one but the last of them.
inline CurveSegment make_segment(const Vec3f* points, const float* radii, std::uint32_t segment, bool is_first,
                                 bool is_last) {
  const std::uint32_t before = is_first ? segment : segment - 1, after = is_last ? segment + 1 : segment + 2;
  const auto point = [&](std::uint32_t i) { return Vec3d(points[i]); };
  const auto radius = [&](std::uint32_t i) { return static_cast<double>(radii[i]); };
  return {.points = catmull_rom(point(before), point(segment), point(segment + 1), point(after)),
          .radii = catmull_rom(radius(before), radius(segment), radius(segment + 1), radius(after)),
          .is_first = is_first,
          .is_last = is_last};
}

inline CurveSegment segment_of(const Curves& curves, std::uint32_t segment) {
  const std::uint32_t curve = curves.curve_of(segment);
  return make_segment(curves.points.data(), curves.radii.data(), segment, segment == curves.firsts[curve],
                      segment + 2 == curves.end_of(curve));
}

// Calls visit(number, segment) for each.
template <class Visitor>
void for_each_segment(const Curves& curves, Visitor&& visit) {
  for (std::uint32_t curve = 0; curve < curves.firsts.size(); ++curve) {
    const std::uint32_t first = curves.firsts[curve], end = curves.end_of(curve);
    for (std::uint32_t i = first; i + 1 < end; ++i)
      visit(i, make_segment(curves.points.data(), curves.radii.data(), i, i == first, i + 2 == end));
  }
}

// A part of a segment.
struct CurveRange {
  double begin = 0, end = 1;
};

// The part's Bezier points, in whose convex hull it lies.
template <class T>
std::array<T, 4> bezier_points(const std::array<T, 4>& c, CurveRange range) {
  const double third = (range.end - range.begin) / 3;
  const T from = CurveSegment::eval(c, range.begin), to = CurveSegment::eval(c, range.end);
  return {from, from + CurveSegment::derivative(c, range.begin) * third,
          to - CurveSegment::derivative(c, range.end) * third, to};
}

// No radius in the part is larger.
inline double largest_radius(const CurveSegment& segment, CurveRange range) {
  const std::array<double, 4> radii = bezier_points(segment.radii, range);
  return std::max(0.0, *std::ranges::max_element(radii));
}

inline Bounds3f bounds_of_range(const CurveSegment& segment, CurveRange range) {
  const double radius = largest_radius(segment, range);
  Bounds3<double> box;
  for (const Vec3d point : bezier_points(segment.points, range)) box.extend(point);
  Bounds3f result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Next to what rounding to floats takes, that of doubles is nothing.
    result.lower[axis] = next_float_down(next_float_down(static_cast<float>(box.lower[axis] - radius)));
    result.upper[axis] = next_float_up(next_float_up(static_cast<float>(box.upper[axis] + radius)));
  }
  return result;
}

}  // namespace basicrt
