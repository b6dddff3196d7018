// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses one of many lights by how much each may matter to a point: Conty Estevez and Kulla 2018, "Importance Sampling
// of Many Lights with Adaptive Tree Splitting".
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "light/light_bounds.h"
#include "math/ray.h"
#include "math/simd.h"

namespace basicrt {

// Nodes of eight children, whose importances are computed side by side. The same lights in the same order always give
// the same tree.
class LightTree {
 public:
  static constexpr int width = 8;

  LightTree() = default;
  // Lights are numbered as they come; each has an intensity over 0.
  explicit LightTree(std::vector<LightBounds> lights);

  // How much each child of a node may matter to a point; all of them its share of the intensity where none seems to.
  struct Weights {
    alignas(16) std::array<float, width> of_child;
    float total;
    bool is_guess;  // none seems to
  };
  [[nodiscard]] Weights weigh_root(const LitPoint& point) const { return weigh(nodes_.front(), point); }

  struct Choice {
    std::uint32_t light;
    float probability;
  };
  // `u` in [0, 1). The probabilities of all lights add up to one, and none is zero whose light reaches the point.
  [[nodiscard]] Choice choose(const LitPoint& point, float u) const { return choose(point, u, weigh_root(point)); }
  [[nodiscard]] Choice choose(const LitPoint& point, float u, const Weights& at_root) const;
  [[nodiscard]] float probability(std::uint32_t light, const LitPoint& point) const;

  // Calls visit(light) for each solid light that the ray may run into.
  template <class Visitor>
  void visit_solid(const Ray& ray, Visitor&& visit) const;

  [[nodiscard]] bool is_empty() const { return nodes_.empty(); }
  [[nodiscard]] std::size_t bytes() const {
    return nodes_.size() * sizeof(Node) + places_.size() * sizeof(std::uint32_t);
  }

 private:
  using Lanes = std::array<float, width>;
  // Of each child: a ball and a box around it and the cone of its normals, as in LightBounds.
  struct alignas(64) Node {
    Lanes center_x{}, center_y{}, center_z{}, radius{};
    Lanes half_x{}, half_y{}, half_z{};  // of the box
    Lanes axis_x{}, axis_y{}, axis_z{}, cos_normals{}, sin_normals{}, cos_emission{};
    Lanes lowest{};                                 // along the axis; minus infinity unless one-sided and flat
    Lanes is_two_sided{};                           // 1 or 0
    Lanes intensity{};                              // 0: no child
    std::array<std::uint32_t, width> child{};       // a node or, if a leaf, a light
    std::uint32_t place = 0;                        // in the parent, as in places_
    std::uint8_t count = 0, leaves = 0, solid = 0;  // children; a bit for each that is a leaf, or holds solid lights
  };
  struct Item {
    LightBounds bounds;
    std::uint32_t light;
  };
  static constexpr int most_levels = 32;

  [[nodiscard]] static Weights weigh(const Node& node, const LitPoint& point);
  [[nodiscard]] static unsigned solid_children_near(const Node& node, const Ray& ray);
  std::uint32_t build_node(std::span<Item> items, std::uint32_t place, int depth);
  void set_child(std::uint32_t node, int lane, const LightBounds& bounds);

  std::vector<Node> nodes_;            // the root first
  std::vector<std::uint32_t> places_;  // of each light: node * width + lane
};

template <class Visitor>
void LightTree::visit_solid(const Ray& ray, Visitor&& visit) const {
  std::array<std::uint32_t, most_levels * width> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    for (unsigned near = solid_children_near(node, ray); near != 0; near &= near - 1) {
      const int lane = std::countr_zero(near);
      if ((node.leaves >> lane & 1) != 0)
        visit(node.child[lane]);
      else
        stack[size++] = node.child[lane];
    }
  }
}

}  // namespace basicrt
