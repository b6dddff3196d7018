// SPDX-License-Identifier: GPL-3.0-or-later
// Traces batches of rays against instances of shapes: one tree for each shape, one over the instances.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/huge_pages.h"
#include "bvh/kernels/kernel.h"
#include "bvh/shape_tree.h"
#include "geometry/hit.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

struct TracedInstance {
  std::uint32_t shape = 0;  // index into the trees
  TransformD object_to_world;
  TransformD world_to_object;
  std::uint32_t visibility = ray_all;  // RayKind bits
  // Object to world at equally spaced times from 0 to 1, linear between them, instead of the two above; none: it stands still.
  std::vector<TransformD> motion;
};

class Tracer {
 public:
  Tracer();  // of an empty scene: every ray misses
  Tracer(std::vector<ShapeTree> trees, std::vector<TracedInstance> instances, const BvhConfig& config);
  ~Tracer();
  Tracer(Tracer&&) noexcept;
  Tracer& operator=(Tracer&&) noexcept;

  // The nearest hit of each ray in [t_min, t_max], of which no distance is negative; of hits at exactly the same distance that of the lowest instance,
  // then primitive. Watertight: no ray passes between two triangles that share an edge. A ray with a NaN, or from or towards infinity, misses. Distances
  // and barycentrics are those of single precision: make_surface_point() solves the hit again.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  // Whether anything at all lies in [t_min, t_max]: 1 or 0 for each ray.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> results) const;

  [[nodiscard]] Bounds3f bounds() const { return bounds_; }
  // Of all trees, with the triangles that they hold: bytes.
  [[nodiscard]] std::size_t memory() const;
  // Places some instances otherwise, each of the same shape as before, and builds the tree over all of them again. False, with
  // nothing changed, where it takes a new Tracer: for those that move, and for small meshes that share a tree.
  struct Move {
    std::uint32_t index;
    TracedInstance instance;
  };
  [[nodiscard]] bool move_instances(std::span<const Move> moves, const BvhConfig& config);
  // Gives the trees back, so that the next Tracer need not build them again. Leaves this one empty.
  [[nodiscard]] std::vector<ShapeTree> take_trees();

  // For tests and benchmarks: with this kernel instead of the chosen one.
  void use(const Kernel& kernel) { kernel_ = &kernel; }

 private:
  [[nodiscard]] KernelScene kernel_scene() const;
  [[nodiscard]] Bounds3f box_of(const TracedInstance& instance) const;
  void build_tree_of_instances(const BvhConfig& config);
  void merge_small_meshes(std::span<const Bounds3f> boxes,
                          const BvhConfig& config);  // boxes: of the instances, in the world
  // The nearest hit on one instance in double precision: for what kernels don't walk.
  [[nodiscard]] bool intersect_precisely(std::uint32_t instance, const Ray& ray, Hit& hit) const;

  const Kernel* kernel_ = nullptr;  // none: the chosen one, whichever that is when rays are traced
  std::vector<ShapeTree> trees_;
  std::vector<TracedInstance> instances_;
  std::vector<Bounds3f> boxes_;                                // of the instances, in the world
  std::vector<std::vector<KernelInterval>> kernel_intervals_;  // of each tree
  HugeVector<KernelInstance> kernel_instances_;
  MeshTree merged_;  // of small meshes that are used once, in world space
  std::vector<TriangleOwner> merged_owners_;
  NodeTree instance_tree_;
  Bounds3f bounds_;
};

}  // namespace basicrt
