// SPDX-License-Identifier: GPL-3.0-or-later
// The builders behind build_bvh, one file each. They get at least one primitive.
#pragma once

#include <span>

#include "bvh/bvh.h"

namespace basicrt {

[[nodiscard]] Bvh build_median(std::span<const Bounds3f> bounds, const BvhConfig& config);
[[nodiscard]] Bvh build_binned_sah(std::span<const Bounds3f> bounds, const BvhConfig& config);

// What primitives are sorted by. An empty box sorts as if at the origin.
[[nodiscard]] inline Vec3f centroid(const Bounds3f& box) { return box.is_empty() ? Vec3f(0) : box.center(); }

[[nodiscard]] constexpr std::size_t largest_axis(Vec3f extent) {
  if (extent.x >= extent.y && extent.x >= extent.z) return 0;
  return extent.y >= extent.z ? 1 : 2;
}

}  // namespace basicrt
