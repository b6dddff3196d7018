// SPDX-License-Identifier: GPL-3.0-or-later
// A plain walk that counts what rays have to visit: the quality of a tree, whatever the machine and the kernel.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "bvh/mesh_tree.h"
#include "math/constants.h"

namespace basicrt::benchmark {

struct Visits {
  double nodes = 0, blocks = 0;  // for each ray
};

struct PlainRay {
  Vec3f origin, direction;
  float t_max = std::numeric_limits<float>::infinity();
};

// Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
inline void shorten(PlainRay& ray, const TriangleBlock& block) {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const auto corner = [&](int i) {
      return Vec3f{block.corners[i][0][lane], block.corners[i][1][lane], block.corners[i][2][lane]};
    };
    const Vec3f edge1 = corner(1) - corner(0), edge2 = corner(2) - corner(0), p = cross(ray.direction, edge2);
    const float determinant = dot(edge1, p);
    if (determinant == 0) continue;
    const Vec3f s = ray.origin - corner(0), q = cross(s, edge1);
    const float u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant, t = dot(edge2, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && t > 1e-5f && t < ray.t_max) ray.t_max = t;
  }
}

// Where the ray enters a child's box, or infinity.
inline float entry(const TreeNode& node, std::size_t child, const PlainRay& ray) {
  float nearest = 0, farthest = ray.t_max;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float a = (node.bounds[axis][0][child] - ray.origin[axis]) / ray.direction[axis];
    const float b = (node.bounds[axis][1][child] - ray.origin[axis]) / ray.direction[axis];
    nearest = std::max(nearest, std::min(a, b));
    farthest = std::min(farthest, std::max(a, b));
  }
  return nearest <= farthest ? nearest : std::numeric_limits<float>::infinity();
}

inline void walk(const MeshTree& tree, PlainRay ray, Visits& visits) {
  struct Entry {
    TreeReference reference;
    float t;
  };
  std::array<Entry, 8 * max_tree_depth> stack;
  std::size_t size = 0;
  stack[size++] = {tree.tree.root, 0};
  const unsigned octant = (ray.direction.x < 0) + 2 * (ray.direction.y < 0) + 4 * (ray.direction.z < 0);
  while (size > 0) {
    const auto [reference, t] = stack[--size];
    if (t > ray.t_max) continue;
    if (reference & triangles_mark) {
      ++visits.blocks;
      shorten(ray, tree.blocks[reference & reference_index]);
      continue;
    }
    ++visits.nodes;
    const TreeNode& node = tree.tree.nodes[reference];
    for (const std::uint32_t order : node.order) {
      const std::uint32_t child = order >> (3 * octant) & 7;
      const float child_t = entry(node, child, ray);
      if (node.children[child] != no_reference && child_t <= ray.t_max && std::isfinite(child_t))
        stack[size++] = {node.children[child], child_t};
    }
  }
}

// Of rays from anywhere on the triangles in all directions.
inline Visits count_visits(const MeshTree& tree, const Mesh& mesh, int rays) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(mesh.triangles.size() - 1));
  Visits sum;
  for (int i = 0; i < rays; ++i) {
    const std::uint32_t triangle = any(rng);
    const float a = uniform(rng), b = uniform(rng) * (1 - a), z = 2 * uniform(rng) - 1, angle = 2 * pi * uniform(rng);
    const float radius = std::sqrt(1 - z * z);
    const Vec3f origin =
        mesh.position(triangle, 0) * (1 - a - b) + mesh.position(triangle, 1) * a + mesh.position(triangle, 2) * b;
    walk(tree, {.origin = origin, .direction = {radius * std::cos(angle), radius * std::sin(angle), z}}, sum);
  }
  return {sum.nodes / rays, sum.blocks / rays};
}

}  // namespace basicrt::benchmark
