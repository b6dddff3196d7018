// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a material's graph down to the nodes that scatter and emit.
#pragma once

#include <algorithm>
#include <concepts>
#include <variant>

#include "base/table.h"
#include "shading/material.h"

namespace basicrt {

inline Color eval_color(const ColorInput& input, const Table<Texture>& textures, Vec2f uv) {
  return input.texture.is_valid() ? eval_texture(textures[input.texture], uv).color : input.constant;
}

// In [0, 1].
inline float eval_share(const ShareInput& input, const Table<Texture>& textures, Vec2f uv) {
  if (!input.texture.is_valid()) return input.constant;
  const Rgba value = eval_texture(textures[input.texture], uv);
  return std::clamp(input.is_alpha ? value.alpha : luminance(value.color), 0.0f, 1.0f);
}

template <class Input>
bool is_constant(const Input& input, const Table<Texture>& textures) {
  return !input.texture.is_valid() || std::holds_alternative<ConstantTexture>(textures[input.texture]);
}

// Calls visit(node, weight) for each way from `index` to a node that is neither Mix nor Add, with the product of the
// shares on the way; share_of(ShareInput) gives a Mix's factor. lobe_count() bounds how many there are.
template <class ShareFunction, class Visitor>
void for_each_leaf(const Material& material, NodeIndex index, float weight, ShareFunction&& share_of, Visitor&& visit) {
  if (index == no_node || weight == 0) return;
  std::visit(
      [&]<class Node>(const Node& node) {
        if constexpr (std::same_as<Node, MixShader>) {
          const float factor = share_of(node.factor);
          for_each_leaf(material, node.first, weight * (1 - factor), share_of, visit);
          for_each_leaf(material, node.second, weight * factor, share_of, visit);
        } else if constexpr (std::same_as<Node, AddShader>) {
          for_each_leaf(material, node.first, weight, share_of, visit);
          for_each_leaf(material, node.second, weight, share_of, visit);
        } else {
          visit(node, weight);
        }
      },
      material.nodes[index]);
}

// At no place in particular: a share that varies counts as half.
template <class Visitor>
void for_each_leaf(const Material& material, Visitor&& visit) {
  const auto share_of = [](const ShareInput& input) { return input.texture.is_valid() ? 0.5f : input.constant; };
  for_each_leaf(material, material.surface, 1, share_of, visit);
}

}  // namespace basicrt
