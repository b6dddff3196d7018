// SPDX-License-Identifier: GPL-3.0-or-later
// A ray meets the sphere around each point of a curve at some distance: the hit is where that is least.
#include "geometry/curve_intersection.h"

#include <array>
#include <cmath>

namespace basicrt {
namespace {

// Parts reach over each other by so much, for rays that pass exactly between. The curve goes on there smoothly.
constexpr double overlap = 1e-9;
constexpr double root_tolerance = 1e-12;
constexpr int most_steps = 100;

// The segment as the ray sees it: how far along the ray (of unit length), and how far off it. Distances count from near the segment, where
// they are small.
class SeenCurve {
 public:
  SeenCurve(const PreciseRay& ray, const CurveSegment& segment) : radii_(segment.radii) {
    inverse_length_ = 1 / length(ray.direction);
    direction_ = ray.direction * inverse_length_;
    start_ = dot(segment.points[0] - ray.origin, direction_);
    const Vec3d near = ray.origin + direction_ * start_;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d from_ray = i == 0 ? segment.points[0] - near : segment.points[i];
      along_[i] = dot(from_ray, direction_);
      off_[i] = from_ray - direction_ * along_[i];
    }
  }

  // Of the same sign as the change of the distance at which the ray enters the sphere around the curve at u; where it passes the sphere by,
  // negative where the sphere comes nearer to the ray.
  [[nodiscard]] double round_slope(double u) const {
    const Vec3d off = CurveSegment::eval(off_, u), off_change = CurveSegment::derivative(off_, u);
    const double raw_radius = CurveSegment::eval(radii_, u), radius = std::max(raw_radius, 0.0);
    const double radius_change = raw_radius > 0 ? CurveSegment::derivative(radii_, u) : 0;
    const double half_chord_squared = radius * radius - length_squared(off);
    const double half_change = radius * radius_change - dot(off, off_change);
    return CurveSegment::derivative(along_, u) * std::sqrt(std::max(half_chord_squared, 0.0)) - half_change;
  }
  // Of the same sign as the change of the curve's distance from the ray.
  [[nodiscard]] double ribbon_slope(double u) const {
    return dot(CurveSegment::eval(off_, u), CurveSegment::derivative(off_, u));
  }
  [[nodiscard]] double slope(double u, CurveForm form) const {
    return form == CurveForm::round ? round_slope(u) : ribbon_slope(u);
  }

  [[nodiscard]] std::optional<CurveHit> hit_at(double u, CurveForm form) const {
    const Vec3d off = CurveSegment::eval(off_, u);
    const double radius = CurveSegment::eval(radii_, u), half_chord_squared = radius * radius - length_squared(off);
    if (!(radius > 0 && half_chord_squared >= 0)) return std::nullopt;
    const double distance = start_ + CurveSegment::eval(along_, u);
    if (form == CurveForm::round) return CurveHit{(distance - std::sqrt(half_chord_squared)) * inverse_length_, u, 0};
    if (!(distance > 2 * radius)) return std::nullopt;
    const Vec3d change = CurveSegment::derivative(off_, u);
    const double side = dot(cross(off, change), direction_) / (length(change) * radius);
    return CurveHit{distance * inverse_length_, u, std::clamp(std::isfinite(side) ? side : 0, -1.0, 1.0)};
  }

 private:
  std::array<Vec3d, 4> off_;
  std::array<double, 4> along_, radii_;
  Vec3d direction_;
  double start_ = 0, inverse_length_ = 1;
};

// Where the slope, negative at `from` and not so at `to`, becomes positive: by false position, with a step of bisection now and then
// (Dowell and Jarratt 1972, "The Pegasus method for computing the root of an equation").
template <class Slope>
double find_turn(double from, double to, double slope_from, double slope_to, const Slope& slope) {
  for (int step = 0; step < most_steps && to - from > root_tolerance; ++step) {
    double middle = (from * slope_to - to * slope_from) / (slope_to - slope_from);
    if (step % 4 == 3 || !(middle > from && middle < to)) middle = 0.5 * (from + to);
    const double value = slope(middle);
    if (value == 0) return middle;
    if (value < 0) {
      slope_to = slope_from / (slope_from + value) * slope_to;  // the other end counts for less
      from = middle;
      slope_from = value;
    } else {
      slope_from = slope_to / (slope_to + value) * slope_from;
      to = middle;
      slope_to = value;
    }
  }
  return 0.5 * (from + to);
}

}  // namespace

std::optional<CurveHit> intersect_curve(const PreciseRay& ray, const CurveSegment& segment, CurveRange range,
                                        CurveForm form) {
  const SeenCurve seen(ray, segment);
  const auto slope = [&](double u) { return seen.slope(u, form); };
  const bool begins = segment.is_first && range.begin == 0, ends = segment.is_last && range.end == 1;
  const std::array<double, 3> u = {begins ? 0 : range.begin - overlap, 0.5 * (range.begin + range.end),
                                   ends ? 1 : range.end + overlap};
  const std::array<double, 3> slopes = {slope(u[0]), slope(u[1]), slope(u[2])};
  std::optional<CurveHit> nearest;
  const auto take = [&](double at) {
    const std::optional<CurveHit> hit = seen.hit_at(at, form);
    const bool is_within = hit && hit->t >= ray.t_min && hit->t <= ray.t_max;
    if (is_within && (!nearest || hit->t < nearest->t)) nearest = hit;
  };
  // Round curves end with half a sphere.
  if (form == CurveForm::round && begins && slopes[0] >= 0) take(0);
  if (form == CurveForm::round && ends && slopes[2] <= 0) take(1);
  for (std::size_t i = 0; i < 2; ++i)
    if (slopes[i] < 0 && slopes[i + 1] >= 0) take(find_turn(u[i], u[i + 1], slopes[i], slopes[i + 1], slope));
  return nearest;
}

}  // namespace basicrt
