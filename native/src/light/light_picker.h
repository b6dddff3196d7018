// SPDX-License-Identifier: GPL-3.0-or-later
// Which light to sample: distant ones beside a tree of all others.
#pragma once

#include <cstdint>
#include <vector>

#include "light/light_tree.h"

namespace basicrt {

// A source is a lamp or a shape, and has a number of primitives, each of which is a light.
struct LightRef {
  std::uint32_t source = 0, primitive = 0;
};

// Made in three steps: sources, lights, build(). One light alone costs nothing to pick.
class LightPicker {
 public:
  void add_source(std::uint32_t primitives);
  // Lights without intensity are left out: they are never picked.
  void add(LightRef light, const LightBounds& bounds);
  void add_distant(LightRef light, const DistantBounds& bounds);
  void build();

  struct Pick {
    LightRef light;
    float probability;
  };
  // `u` in [0, 1). Needs a light. The probabilities of all lights add up to one, and none is zero whose light reaches
  // the point.
  [[nodiscard]] Pick pick(const LitPoint& point, float u) const;
  [[nodiscard]] float probability(LightRef light, const LitPoint& point) const;

  // Calls visit(source) for each solid light in the tree that the ray may run into.
  template <class Visitor>
  void visit_solid(const Ray& ray, Visitor&& visit) const {
    if (!tree_.is_empty()) tree_.visit_solid(ray, [&](std::uint32_t light) { visit(near_[light].source); });
  }

  [[nodiscard]] std::size_t size() const { return near_.size() + distant_.size(); }
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Distant {
    LightRef light;
    DistantBounds bounds;
  };
  // How the tree (the first) and each distant light share the choice.
  struct Shares {
    float total = 0;
    int shining = 0;
    LightTree::Weights at_root;
    [[nodiscard]] float probability(float importance) const;
  };
  [[nodiscard]] Shares share(const LitPoint& point) const;
  [[nodiscard]] std::uint32_t& place_of(LightRef light) { return places_[firsts_[light.source] + light.primitive]; }

  static constexpr std::uint32_t no_light = ~0u, distant_bit = 1u << 31;

  std::vector<LightRef> near_;  // in the tree's order
  std::vector<Distant> distant_;
  std::vector<LightBounds> bounds_;    // of near ones, until build()
  std::vector<std::size_t> firsts_;    // each source's first entry in places_
  std::vector<std::uint32_t> places_;  // an index into near_, or into distant_ with distant_bit, or no_light
  LightTree tree_;
};

}  // namespace basicrt
