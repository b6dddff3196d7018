// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a material's graph down to the nodes that scatter and emit.
#pragma once

#include <concepts>
#include <variant>

#include "base/table.h"
#include "shading/material.h"

namespace basicrt {

inline Color eval_color(const ColorInput& input, const Table<Texture>& textures, Vec2f uv) {
  return input.texture.is_valid() ? eval_texture(textures[input.texture], uv) : input.constant;
}

inline bool is_constant(const ColorInput& input, const Table<Texture>& textures) {
  return !input.texture.is_valid() || std::holds_alternative<ConstantTexture>(textures[input.texture]);
}

// Calls visit(node, weight) for each way from `index` to a node that is neither Mix nor Add, with the product of the
// shares on the way. lobe_count() bounds how many there are.
template <class Visitor>
void for_each_leaf(const Material& material, NodeIndex index, float weight, Visitor&& visit) {
  if (index == no_node || weight == 0) return;
  std::visit(
      [&]<class Node>(const Node& node) {
        if constexpr (std::same_as<Node, MixShader>) {
          for_each_leaf(material, node.first, weight * (1 - node.factor), visit);
          for_each_leaf(material, node.second, weight * node.factor, visit);
        } else if constexpr (std::same_as<Node, AddShader>) {
          for_each_leaf(material, node.first, weight, visit);
          for_each_leaf(material, node.second, weight, visit);
        } else {
          visit(node, weight);
        }
      },
      material.nodes[index]);
}

template <class Visitor>
void for_each_leaf(const Material& material, Visitor&& visit) {
  for_each_leaf(material, material.surface, 1, visit);
}

}  // namespace basicrt
