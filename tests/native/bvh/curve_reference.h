// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against curves without any cleverness: very many places along each, then golden sections.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/curves.h"
#include "geometry/precise_ray.h"

namespace basicrt::test {

struct CurveReferenceHit {
  double t;
  std::uint32_t segment;
  double u;
  double depth;  // how far inside the silhouette, 0 to 1
};

// A curve as one function of s: segment s.floor at s - s.floor, by the textbook's formula of the spline.
class ReferenceCurve {
 private:
  template <class At>
  auto spline(double s, const At& at) const {
    const auto k = std::min(static_cast<std::uint32_t>(s), segments() - 1);
    const double u = s - k, uu = u * u, uuu = uu * u;
    const std::uint32_t from = first_ + k, to = from + 1;
    const std::uint32_t before = from == first_ ? from : from - 1, after = to + 1 == end_ ? to : to + 1;
    return at(before) * (0.5 * (-u + 2 * uu - uuu)) + at(from) * (0.5 * (2 - 5 * uu + 3 * uuu)) +
           at(to) * (0.5 * (u + 4 * uu - 3 * uuu)) + at(after) * (0.5 * (uuu - uu));
  }

 public:
  ReferenceCurve(const Curves& curves, std::uint32_t curve, const PreciseRay& ray)
      : curves_(curves), first_(curves.firsts[curve]), end_(curves.end_of(curve)), ray_(ray) {}

  [[nodiscard]] std::uint32_t first() const { return first_; }
  [[nodiscard]] std::uint32_t segments() const { return end_ - first_ - 1; }

  // Whether the ray passes by a sphere around all of it: a spline's weights add up to 1, their magnitudes to 1.25 at most.
  [[nodiscard]] bool is_far() const {
    const Vec3d center(curves_.points[first_]);
    double reach = 0, thickest = 0;
    for (std::uint32_t i = first_; i < end_; ++i) {
      reach = std::max(reach, length(Vec3d(curves_.points[i]) - center));
      thickest = std::max(thickest, double{curves_.radii[i]});
    }
    return length(cross(center - ray_.origin, ray_.direction)) > 1.3 * (reach + thickest) * length(ray_.direction);
  }

  // Where the ray enters the sphere around the curve at s (round), or how far the curve is from it (ribbon); infinite where it passes by.
  [[nodiscard]] double value(double s) const { return curves_.form == CurveForm::round ? entry(s) : distance(s); }
  [[nodiscard]] double entry(double s) const {
    const double d = distance(s), r = radius(s);
    if (!(r > 0 && d <= r)) return std::numeric_limits<double>::infinity();
    return along(s) - std::sqrt(r * r - d * d) / length(ray_.direction);
  }
  [[nodiscard]] double distance(double s) const {
    return length(cross(point(s) - ray_.origin, ray_.direction)) / length(ray_.direction);
  }
  // Of the point of the ray that is nearest to the curve, along the ray.
  [[nodiscard]] double along(double s) const {
    return dot(point(s) - ray_.origin, ray_.direction) / length_squared(ray_.direction);
  }
  [[nodiscard]] Vec3d point(double s) const {
    return spline(s, [&](std::uint32_t i) { return Vec3d(curves_.points[i]); });
  }
  [[nodiscard]] double radius(double s) const {
    return std::max(0.0, spline(s, [&](std::uint32_t i) { return double{curves_.radii[i]}; }));
  }

 private:
  const Curves& curves_;
  std::uint32_t first_, end_;
  PreciseRay ray_;
};

inline double golden_minimum(const ReferenceCurve& curve, double from, double to) {
  constexpr double ratio = 0.6180339887498949;
  for (int i = 0; i < 100; ++i) {
    const double a = to - (to - from) * ratio, b = from + (to - from) * ratio;
    (curve.value(a) < curve.value(b) ? to : from) = curve.value(a) < curve.value(b) ? b : a;
  }
  return 0.5 * (from + to);
}

// The nearest, which must be where the value is least around: of the whole curve, not of its pieces.
inline std::optional<CurveReferenceHit> reference_hit(const Curves& curves, const PreciseRay& ray, int places = 400) {
  std::optional<CurveReferenceHit> nearest;
  for (std::uint32_t number = 0; number < curves.firsts.size(); ++number) {
    const ReferenceCurve curve(curves, number, ray);
    if (curves.end_of(number) - curves.firsts[number] < 2 || curve.is_far()) continue;
    const int last = places * static_cast<int>(curve.segments());
    const auto s = [&](int i) { return static_cast<double>(i) / places; };
    const auto consider = [&](double at) {
      const double d = curve.distance(at), r = curve.radius(at);
      if (!(r > 0 && d <= r)) return;
      const double t = curves.form == CurveForm::round ? curve.entry(at) : curve.along(at);
      if (curves.form == CurveForm::ribbon && t * length(ray.direction) <= 2 * r) return;
      if (!(t >= ray.t_min && t <= ray.t_max) || (nearest && t >= nearest->t)) return;
      const auto k = std::min(static_cast<std::uint32_t>(at), curve.segments() - 1);
      nearest = CurveReferenceHit{t, curve.first() + k, at - k, std::sqrt(1 - d * d / (r * r))};
    };
    std::vector<double> values;
    for (int i = 0; i <= last; ++i) values.push_back(curve.value(s(i)));
    for (int i = 0; i <= last; ++i) {
      if (!std::isfinite(values[i])) continue;
      const bool is_end = i == 0 || i == last;
      if (is_end && curves.form == CurveForm::ribbon) continue;
      const bool is_least = (i == 0 || values[i] <= values[i - 1]) && (i == last || values[i] <= values[i + 1]);
      if (is_least) consider(golden_minimum(curve, s(std::max(i - 1, 0)), s(std::min(i + 1, last))));
    }
  }
  return nearest;
}

}  // namespace basicrt::test
