// SPDX-License-Identifier: GPL-3.0-or-later
// Checks curves and answers what shading asks of them.
#include "geometry/curves.h"

#include <algorithm>
#include <string>

#include "geometry/check_arrays.h"
#include "geometry/curve_segment.h"

namespace basicrt {

std::uint32_t Curves::curve_of(std::uint32_t point) const {
  return static_cast<std::uint32_t>(std::ranges::upper_bound(firsts, point) - firsts.begin()) - 1;
}

float Curves::intercept_at(std::uint32_t segment, float u) const {
  if (!intercepts.empty()) return intercepts[segment] + (intercepts[segment + 1] - intercepts[segment]) * u;
  const std::uint32_t curve = curve_of(segment), count = end_of(curve) - firsts[curve];
  return (static_cast<float>(segment - firsts[curve]) + u) / static_cast<float>(count - 1);
}

float Curves::radius_at(std::uint32_t segment, float u) const {
  return radii[segment] + (radii[segment + 1] - radii[segment]) * u;
}

float Curves::length_of(std::uint32_t curve) const {
  double sum = 0;
  for (std::uint32_t i = firsts[curve]; i + 1 < end_of(curve); ++i)
    sum += length(Vec3d(points[i + 1]) - Vec3d(points[i]));
  return static_cast<float>(sum);
}

bool has_segments(const Curves& curves) {
  for (std::uint32_t curve = 0; curve < curves.firsts.size(); ++curve)
    if (curves.end_of(curve) - curves.firsts[curve] > 1) return true;
  return false;
}

Bounds3f bounds(const Curves& curves) {
  Bounds3f result;
  for_each_segment(
      curves, [&](std::uint32_t, const CurveSegment& segment) { result.extend(bounds_of_range(segment, {0, 1})); });
  return result;
}

void validate(const Curves& curves, std::string_view item) {
  const std::size_t count = curves.points.size(), curve_count = curves.firsts.size();
  check_count(item, "points", count);
  check_finite(item, "points", curves.points);
  check_exact_length(item, "radii", curves.radii.size(), count, "one for each point");
  check_radii(item, curves.radii);
  if (count > 0 && curve_count == 0)
    throw SceneError(std::string(item) + ".firsts", "must name each curve's first point, is empty");
  for (std::size_t i = 0; i < curve_count; ++i) {
    const std::uint32_t first = curves.firsts[i];
    const std::string entry = array_entry(item, "firsts", i);
    if (i == 0 && first != 0) throw SceneError(entry, "must be 0, is " + std::to_string(first));
    if (i > 0 && first <= curves.firsts[i - 1])
      throw SceneError(entry, "must be greater than the one before, is " + std::to_string(first) + " after " +
                                  std::to_string(curves.firsts[i - 1]));
    if (first >= count)
      throw SceneError(entry, "point " + std::to_string(first) + ", but there are " + std::to_string(count));
  }
  check_length(item, "intercepts", curves.intercepts.size(), count, "one for each point");
  check_finite(item, "intercepts", curves.intercepts);
  check_length(item, "randoms", curves.randoms.size(), curve_count, "one for each curve");
  check_finite(item, "randoms", curves.randoms);
  check_length(item, "uvs", curves.uvs.size(), curve_count, "one for each curve");
  check_finite(item, "uvs", curves.uvs);
  check_attributes(item, curves.attributes, {{AttributeDomain::vertex, count}, {AttributeDomain::face, curve_count}});
}

}  // namespace basicrt
