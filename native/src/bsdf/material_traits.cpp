// SPDX-License-Identifier: GPL-3.0-or-later
// What can be said of a material without shading it: transparency, emission, how many lobes it takes.
#include <algorithm>
#include <optional>
#include <vector>

#include "base/overloaded.h"
#include "bsdf/bsdf.h"
#include "bsdf/shader_graph.h"

namespace basicrt {

Color transparency(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                   const ShadingContext& context) {
  Color sum(0.0f);
  with_values(material, textures, point, wo, context, [&](const Evaluator& in) {
    const Overloaded leaf{
        [&](const TransparentShader& node, float weight) { sum += resolve(node, in).color.constant * weight; },
        [&](const PrincipledShader& node, float weight) { sum += Color((1 - eval_factor(node.alpha, in)) * weight); },
        [](const auto& /*opaque*/, float) {}};
    for_each_leaf(
        material, material.surface, 1, [&](const NumberInput& input) { return eval_factor(input, in); }, leaf);
  });
  return sum;
}

bool is_transparent(const Material& material) {
  bool result = false;
  const Overloaded leaf{
      [&](const TransparentShader& node, float) {
        result |= node.color.is_varying() || !is_black(node.color.constant);
      },
      [&](const PrincipledShader& node, float) { result |= node.alpha.is_varying() || node.alpha.constant < 1; },
      [](const auto& /*opaque*/, float) {}};
  for_each_leaf(material, leaf);
  return result;
}

Material transparent_part(Material material) {
  std::vector<bool> lets_through(material.nodes.size());
  const auto any = [&](NodeIndex first, NodeIndex second) {
    return (first != no_node && lets_through[first]) || (second != no_node && lets_through[second]);
  };
  const Overloaded may_let_through{
      [](const TransparentShader&) { return true; },
      [](const PrincipledShader& node) { return node.alpha.is_varying() || node.alpha.constant < 1; },
      [&](const MixShader& node) { return any(node.first, node.second); },
      [&](const AddShader& node) { return any(node.first, node.second); },
      [](const auto& /*opaque*/) { return false; }};
  for (std::size_t i = 0; i < material.nodes.size(); ++i) {
    ShaderNode& node = material.nodes[i];
    lets_through[i] = std::visit(may_let_through, node);
    if (!lets_through[i]) {
      node = HoldoutShader{};
    } else if (const auto* principled = std::get_if<PrincipledShader>(&node)) {
      PrincipledShader only_alpha;
      only_alpha.alpha = principled->alpha;
      node = only_alpha;
    }
  }
  return material;
}

bool needs_derivatives(const Material& material) {
  bool result = false;
  const auto leaf = [&]<class Node>(const Node& node, float) {
    if constexpr (requires { node.is_stretched(); }) result |= node.is_stretched();
  };
  for_each_leaf(material, leaf);
  for (const Operation& operation : material.operations)
    std::visit([&](const auto& node) { result |= needs_derivatives(node); }, operation);
  return result;
}

namespace {

// The radiance where that is the same everywhere, else nothing.
std::optional<Color> uniform_emission(const Material& material, SurfaceSide side) {
  Color sum(0.0f);
  bool varies = false, shines = false;
  const auto add = [&](const ColorInput& radiance, const NumberInput& strength, float weight) {
    const bool is_varying = radiance.is_varying() || strength.is_varying();
    varies = varies || is_varying;
    shines = shines || is_varying || !is_black(radiance.constant * strength.constant);
    sum += radiance.constant * (strength.constant * weight);
  };
  const Overloaded leaf{[&](const EmissionShader& node, float weight) {
                          if (node.is_two_sided || side == SurfaceSide::front)
                            add(node.radiance, node.strength, weight);
                        },
                        [&](const PrincipledShader& node, float weight) {
                          // What is above lets through another share in each direction.
                          const auto is_above = [](const NumberInput& weight_of) {
                            return weight_of.is_varying() || weight_of.constant > 0;
                          };
                          varies = varies || node.alpha.is_varying() || is_above(node.sheen_weight) ||
                                   is_above(node.coat_weight);
                          add(node.emission, node.emission_strength, node.alpha.constant * weight);
                        },
                        [](const auto& /*dark*/, float) {}};
  const auto share_of = [&](const NumberInput& input) {
    varies = varies || input.is_varying();
    return input.is_varying() ? 0.5f : input.constant;
  };
  for_each_leaf(material, material.surface, 1, share_of, leaf);
  return varies && shines ? std::nullopt : std::optional(sum);
}

}  // namespace

Color emitted_radiance(const Material& material, SurfaceSide side) {
  return uniform_emission(material, side).value_or(Color(0.0f));
}

bool has_varying_emission(const Material& material, SurfaceSide side) { return !uniform_emission(material, side); }

bool is_emissive(const Material& material) {
  constexpr Color black(0.0f);
  return uniform_emission(material, SurfaceSide::front) != black ||
         uniform_emission(material, SurfaceSide::back) != black;
}

namespace {

// Each of the layers that flatten() makes of it.
int count_lobes(const PrincipledShader& node) {
  const auto may_be = [](const NumberInput& input, auto&& is_so) {
    return input.is_varying() || is_so(input.constant);
  };
  const auto is_some = [](float share) { return share > 0; };
  const auto is_part = [](float share) { return share < 1; };
  if (!may_be(node.alpha, is_some)) return 1;
  const bool is_dielectric = may_be(node.metallic, is_part),
             is_opaque = is_dielectric && may_be(node.transmission, is_part);
  return may_be(node.alpha, is_part) + may_be(node.metallic, is_some) + may_be(node.sheen_weight, is_some) +
         may_be(node.coat_weight, is_some) + (is_dielectric && may_be(node.transmission, is_some)) + 2 * is_opaque +
         2 * (is_opaque && may_be(node.subsurface_weight, is_some));
}

}  // namespace

int lobe_count(const Material& material) {
  // Not by for_each_leaf: the ways through a graph may be exponentially many, and this is what refuses them.
  constexpr int many = 1 << 20;
  std::vector<int> counts;
  const auto count_of = [&](NodeIndex index) { return index < counts.size() ? counts[index] : 1; };
  const Overloaded count{[&](const MixShader& node) { return count_of(node.first) + count_of(node.second); },
                         [&](const AddShader& node) { return count_of(node.first) + count_of(node.second); },
                         [](const PrincipledShader& node) { return count_lobes(node); },
                         [](const SubsurfaceShader&) { return 2; }, [](const auto&) { return 1; }};
  for (const ShaderNode& node : material.nodes) counts.push_back(std::min(std::visit(count, node), many));
  return std::max(count_of(material.surface), count_of(material.volume));
}

}  // namespace basicrt
