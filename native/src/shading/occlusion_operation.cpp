// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/occlusion_operation.h"

#include <cmath>

#include "math/frame.h"
#include "math/hash.h"
#include "math/warp.h"
#include "shading/evaluator.h"
#include "shading/surface_operations.h"

namespace basicrt {
namespace {

// Evenly spread points of the unit square, shifted together by chance: Roberts 2018, "The Unreasonable Effectiveness of
// Quasirandom Sequences".
Vec2f spread_point(int i, Vec2f shift) {
  const auto wrapped = [](float x) { return std::min(x - std::floor(x), one_minus_epsilon); };
  const auto n = static_cast<float>(i);
  return {wrapped(shift.x + n * 0.75487767f), wrapped(shift.y + n * 0.56984029f)};
}

}  // namespace

Vec3f eval(const AmbientOcclusionOperation& node, const Evaluator& in) {
  const RayProbe* probe = in.context.probe;
  const float distance = in(node.distance);
  if (probe == nullptr || !(distance > 0)) return Vec3f(1.0f);
  Vec3f normal = in(node.normal);
  normal = length_squared(normal) > 0 ? normalize(normal) : viewed_normal(in);
  const Frame frame = make_frame(node.is_inside ? -normal : normal);
  const std::uint64_t bits = hash(in.context.random_bits);
  const Vec2f shift{to_unit_float(static_cast<std::uint32_t>(bits >> 32)),
                    to_unit_float(static_cast<std::uint32_t>(bits))};
  int open = 0;
  for (int i = 0; i < node.samples; ++i) {
    const Vec3f direction = frame.to_world(sample_cosine_hemisphere(spread_point(i, shift)));
    open += !probe->is_occluded(in.point, direction, distance, node.is_local);
  }
  return Vec3f(static_cast<float>(open) / static_cast<float>(node.samples));
}

}  // namespace basicrt
