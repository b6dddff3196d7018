// SPDX-License-Identifier: GPL-3.0-or-later
// Traces batches of rays against instances of shapes: one tree for each shape, one over the instances.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bvh/shape_tree.h"
#include "bvh/wide_bvh.h"
#include "geometry/hit.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

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

  // The nearest hit of each ray in [t_min, t_max], of which no distance is negative; of hits at exactly the same distance that of the lowest instance,
  // then primitive. A ray with a NaN, or from or towards infinity, misses.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  // Whether anything at all lies in [t_min, t_max]: 1 or 0 for each ray.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> results) const;

  [[nodiscard]] Bounds3f bounds() const;
  // Gives the trees back, so that the next Tracer need not build them again. Leaves this one empty.
  [[nodiscard]] std::vector<ShapeTree> take_trees();

 private:
  // What a ray needs of an instance, in the order of the leaves of `instance_bvh_`.
  struct PlacedInstance {
    TransformD world_to_object;
    std::uint32_t shape;
    std::uint32_t index;  // as the constructor got it
    std::uint32_t visibility;
    bool is_translation;
  };

  template <class Query>
  struct InstanceVisitor;
  template <class Query>
  void trace(std::span<const Ray> rays, std::span<typename Query::Result> results) const;
  template <class Query>
  void trace_batch(std::span<const Ray> rays, std::span<typename Query::Result> results) const;

  std::vector<ShapeTree> trees_;
  std::vector<PlacedInstance> placed_;
  WideBvh instance_bvh_;  // its leaves' items are placed instances
};

}  // namespace basicrt
