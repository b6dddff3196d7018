// SPDX-License-Identifier: GPL-3.0-or-later
// Shadow rays of smooth-shaded meshes. Where light grazes the mesh, facets shade each other though the surface that their
// normals stand for would be lit: such rays start on that surface.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/mesh.h"
#include "geometry/placement.h"
#include "geometry/surface_point.h"

namespace basicrt {

// How much of the way to the smooth surface a shadow ray towards `wi` starts, in [0, 1]. Blender's geometry offset is the
// `cutoff`, above 0: a ray starts on the smooth surface where the cosines of the facet and of the shading normal (of
// which no more than the cutoff counts) add up to the cutoff or less, and on the facet where they add up to twice that.
[[nodiscard]] inline float smooth_share(const SurfacePoint& point, Vec3f wi, float cutoff) {
  const float cosine = dot(point.shading_normal, wi), facet_cosine = dot(point.geometric_normal, wi);
  const float sum = std::min(std::abs(cosine), cutoff) + (cosine < 0 ? -facet_cosine : facet_cosine);
  return std::clamp(2 - sum / cutoff, 0.0f, 1.0f);
}

// The share of reflected light that Blender's shading offset, in [0, 1], leaves: light from an angle is reflected as if
// it came from a wider one, so that it ends before facets shade each other.
[[nodiscard]] inline float offset_share(const SurfacePoint& point, Vec3f wi, float shading_offset) {
  const float cosine = dot(point.is_backfacing ? -point.shading_normal : point.shading_normal, wi);
  if (!(cosine > 0)) return 1;
  const float widening = 1 / (1 - shading_offset / 2);
  return std::max(std::cos(std::acos(std::min(cosine, 1.0f)) * widening), 0.0f) / cosine;
}

// From a point of a mesh's facet to the smooth surface above it, on the side of `wi`; zero where the surface bends away
// to the other side. World space.
[[nodiscard]] Vec3f shift_to_smooth_surface(const Mesh& mesh, const Placement& placement, const SurfacePoint& point,
                                            Vec3f wi);

}  // namespace basicrt
