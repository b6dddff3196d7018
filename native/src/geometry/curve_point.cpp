// SPDX-License-Identifier: GPL-3.0-or-later
// Surface points on curves.
#include <algorithm>
#include <cmath>

#include "geometry/curve_intersection.h"
#include "geometry/error_bounds.h"
#include "geometry/local_point.h"

namespace basicrt {
namespace {

// A hit's u was rounded to a float.
constexpr double u_slack = 1e-6;

// The hit, solved again near it.
CurveHit solve_again(const PreciseRay& ray, const CurveSegment& segment, CurveForm form, const Hit& hit) {
  const CurveRange near = {std::clamp(hit.u - u_slack, 0.0, 1.0), std::clamp(hit.u + u_slack, 0.0, 1.0)};
  PreciseRay free = ray;
  free.t_min = std::max(ray.t_min, hit.t - 1e-5 * std::abs(hit.t));
  free.t_max = std::min(ray.t_max, hit.t + 1e-5 * std::abs(hit.t));
  return intersect_curve(free, segment, near, form).value_or(CurveHit{hit.t, hit.u, hit.v});
}

Vec3d unit_or(Vec3d v, Vec3d otherwise) {
  const double size = length(v);
  return size > 0 && std::isfinite(size) ? v / size : otherwise;
}

// How far off a point on the ray may be in each coordinate.
double reach_error(const PreciseRay& ray, Vec3d point) { return gamma(32) * (length(ray.origin) + length(point)); }

LocalPoint ribbon_point(const PreciseRay& ray, const CurveSegment& segment, const CurveHit& hit) {
  const Vec3d back = unit_or(-ray.direction, {0, 0, 1}), position = ray.origin + ray.direction * hit.t;
  const Vec3d across = unit_or(cross(segment.tangent(hit.u), back), Vec3d(0));
  const Vec3d facing = unit_or(
      back - segment.tangent(hit.u) * (dot(back, segment.tangent(hit.u)) / length_squared(segment.tangent(hit.u))),
      back);
  // As if it were round.
  const Vec3d rounded = across * hit.v + facing * std::sqrt(std::max(0.0, 1 - hit.v * hit.v));
  return {.t = hit.t,
          .position = position,
          .error = Vec3d(reach_error(ray, position)),
          .normal = rounded,
          .shading_normal = rounded,
          .uv = {},
          .is_backfacing = false};
}

LocalPoint round_point(const PreciseRay& ray, const CurveSegment& segment, const CurveHit& hit) {
  const Vec3d center = segment.point(hit.u), back = unit_or(-ray.direction, {0, 0, 1});
  const double radius = segment.radius(hit.u);
  // Put back onto the sphere around the curve.
  const Vec3d outward = unit_or(ray.origin + ray.direction * hit.t - center, back);
  const double grazing = std::max(std::abs(dot(back, outward)), 1e-6);
  return {.t = hit.t,
          .position = center + outward * radius,
          .error = Vec3d(reach_error(ray, center) * (1 + 1 / grazing) + gamma(32) * radius),
          .normal = outward,
          .shading_normal = outward,
          .uv = {},
          .is_backfacing = false};
}

}  // namespace

LocalPoint local_point_on(const Curves& curves, const PreciseRay& ray, const Hit& hit) {
  const CurveSegment segment = segment_of(curves, hit.primitive);
  const CurveHit again = solve_again(ray, segment, curves.form, hit);
  LocalPoint point =
      curves.form == CurveForm::ribbon ? ribbon_point(ray, segment, again) : round_point(ray, segment, again);
  point.uv = curves.uvs.empty() ? Vec2f{curves.intercept_at(hit.primitive, static_cast<float>(again.u)), 0.0f}
                                : curves.uvs[curves.curve_of(hit.primitive)];
  return point;
}

LocalDerivatives derivatives_on_curve(const Curves& curves, std::uint32_t segment, double u, Vec3d normal) {
  const Vec3d along = segment_of(curves, segment).tangent(u);
  return {.dpdu = along, .dpdv = cross(along, normal)};
}

}  // namespace basicrt
