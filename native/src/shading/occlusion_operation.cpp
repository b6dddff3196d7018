// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/occlusion_operation.h"

#include "math/frame.h"
#include "math/hash.h"
#include "math/warp.h"
#include "shading/evaluator.h"
#include "shading/spread_points.h"
#include "shading/surface_operations.h"

namespace basicrt {

Vec3f eval(const AmbientOcclusionOperation& node, const Evaluator& in) {
  const RayProbe* probe = in.context.probe;
  const float distance = in(node.distance);
  if (probe == nullptr || !(distance > 0)) return Vec3f(1.0f);
  Vec3f normal = in(node.normal);
  normal = length_squared(normal) > 0 ? normalize(normal) : viewed_normal(in);
  const Frame frame = make_frame(node.is_inside ? -normal : normal);
  const SpreadPoints places(hash(in.context.random_bits));
  int open = 0;
  for (int i = 0; i < node.samples; ++i) {
    const Vec3f direction = frame.to_world(sample_cosine_hemisphere(places[i]));
    open += !probe->is_occluded(in.point, direction, distance, node.is_local);
  }
  return Vec3f(static_cast<float>(open) / static_cast<float>(node.samples));
}

}  // namespace basicrt
