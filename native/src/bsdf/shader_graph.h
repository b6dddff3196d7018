// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a material's graph down to the nodes that scatter and emit.
#pragma once

#include <concepts>
#include <variant>

#include "shading/program.h"

namespace basicrt {

// Of a Mix, in [0, 1].
inline float eval_factor(const NumberInput& input, const Evaluator& in) {
  return input.is_varying() ? clamp_to_range(in(input), within(0, 1)) : input.constant;
}

// Calls visit(node, weight) for each way from `index` to a node that is neither Mix nor Add, with the product of the
// shares on the way; share_of(NumberInput) gives a Mix's factor. lobe_count() bounds how many there are.
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
  const auto share_of = [](const NumberInput& input) { return input.is_varying() ? 0.5f : input.constant; };
  for_each_leaf(material, material.surface, 1, share_of, visit);
}

}  // namespace basicrt
