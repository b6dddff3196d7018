// SPDX-License-Identifier: GPL-3.0-or-later
// What ray kernels get and give. A kernel is the same code (walk.inl) compiled for one instruction
// set. Plain data only: an ordinary inline function compiled with AVX could be linked into code for machines without it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bvh/tree.h"
#include "geometry/key_interval.h"

namespace basicrt {

// Of the memory of a Ray.
struct alignas(16) KernelRay {
  float origin[3];
  float t_min;
  float direction[3];
  float t_max;
  std::uint32_t kinds;
  float time;
  std::uint32_t from_instance, from_primitive;
};

// Of the memory of a Hit.
struct KernelHit {
  float t;
  std::uint32_t instance, primitive;
  float u, v;
};

// Whose triangle it is that stands among those of many instances.
struct TriangleOwner {
  std::uint32_t instance, primitive;
};

// What a ray needs to know of a mesh that deforms, between two keys.
struct KernelInterval {
  const TreeNode* nodes;
  const MovingTriangleBlock* blocks;
  TreeReference root;
};

// What a ray needs to know of an instance.
struct KernelInstance {
  enum class Space : std::uint32_t { world, translated, transformed, moving };

  double world_to_object[3][4];  // where it doesn't move
  const TreeNode* nodes;
  const TriangleBlock* blocks;
  TreeReference
      root;  // no_reference: a mesh that deforms, or its hits come from KernelScene::intersect_precisely alone
  std::uint32_t visibility;
  Space space;
  float reach;  // the largest coordinate of the mesh, without its sign
  // Small meshes are merged in one tree, which stands as an instance behind all others: for that one the owners of its triangles, and for
  // the others where their triangles start in it, or no_reference where they are not in it.
  const TriangleOwner* owners;
  std::uint32_t first_merged;
  std::uint32_t interval_count;     // of a mesh that deforms: its trees, else 0
  const KernelInterval* intervals;  // as many
  const void* motion;               // for KernelScene::world_to_object_at
};

struct KernelScene {
  const TreeNode* nodes;  // the tree over the instances
  TreeReference root;
  const KernelInstance* instances;
  const void* owner;  // for the functions below

  // For what kernels leave to double precision. The first finds a nearer hit on one instance (of whatever kind), false where there
  // is none; the second the distance along a ray's line to a triangle's plane.
  bool (*intersect_precisely)(const void* owner, std::uint32_t instance, const KernelRay& ray, KernelHit& hit);
  double (*plane_distance)(const KernelInstance& instance, const KernelRay& ray, const float (&corners)[3][3]);
  // Where an instance is that moves, at a ray's time.
  void (*world_to_object_at)(const KernelInstance& instance, float time, double (&world_to_object)[3][4]);
};

// Rays and hits are read and written in the memory of Ray and Hit.
struct Kernel {
  const char* name;
  std::size_t scratch_size;  // bytes
  void (*intersect)(const KernelScene& scene, const void* rays, void* hits, std::size_t count, void* scratch);
  void (*occluded)(const KernelScene& scene, const void* rays, std::uint8_t* results, std::size_t count, void* scratch);
};

}  // namespace basicrt
