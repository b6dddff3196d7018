// SPDX-License-Identifier: GPL-3.0-or-later
// Checks point clouds and says where they are.
#include "geometry/point_cloud.h"

#include "geometry/check_arrays.h"
#include "geometry/sphere.h"

namespace basicrt {

Bounds3f point_bounds(const PointCloud& cloud, std::uint32_t point) {
  if (!(cloud.radii[point] > 0)) return {};
  return sphere_bounds(cloud.positions[point], cloud.radii[point]);
}

Bounds3f bounds(const PointCloud& cloud) {
  Bounds3f result;
  for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) result.extend(point_bounds(cloud, i));
  return result;
}

void validate(const PointCloud& cloud, std::string_view item) {
  const std::size_t count = cloud.positions.size();
  check_count(item, "positions", count);
  check_finite(item, "positions", cloud.positions);
  check_exact_length(item, "radii", cloud.radii.size(), count, "one for each position");
  check_radii(item, cloud.radii);
  check_length(item, "randoms", cloud.randoms.size(), count, "one for each position");
  check_finite(item, "randoms", cloud.randoms);
  check_attributes(item, cloud.attributes, {{AttributeDomain::vertex, count}});
}

}  // namespace basicrt
