// SPDX-License-Identifier: GPL-3.0-or-later
// Traces batches of rays against instances of shapes: one tree for each shape, one over the instances.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "geometry/hit.h"
#include "geometry/shape.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

// A shape's tree, in object space. Keeps no pointer to the shape it was built from.
struct ShapeTree;

struct TracedInstance {
  std::uint32_t shape = 0;  // index into the trees
  TransformD object_to_world;
  TransformD world_to_object;
  std::uint32_t visibility = ray_all;  // RayKind bits
};

class Tracer {
 public:
  Tracer();  // of an empty scene: every ray misses
  Tracer(std::vector<ShapeTree> trees, std::vector<TracedInstance> instances, const BvhConfig& config);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // The nearest hit of each ray in [t_min, t_max]. A ray with a NaN misses.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  // Whether anything at all lies in [t_min, t_max]: 1 or 0 for each ray.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> results) const;

  [[nodiscard]] Bounds3f bounds() const;
  // Gives the trees back, so that the next Tracer need not build them again. Leaves this one empty.
  [[nodiscard]] std::vector<ShapeTree> take_trees();

 private:
  // (the bvh layer's own business)
};

[[nodiscard]] ShapeTree build_shape_tree(const Shape& shape, const BvhConfig& config);

}  // namespace basicrt
