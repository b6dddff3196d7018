// SPDX-License-Identifier: GPL-3.0-or-later
// What can be said of a material without shading it: transparency, emission, how many lobes it takes.
#include <algorithm>
#include <vector>

#include "base/overloaded.h"
#include "bsdf/bsdf.h"
#include "bsdf/shader_graph.h"

namespace basicrt {

Color transparency(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f /*wo*/) {
  Color sum(0.0f);
  const Overloaded leaf{
      [&](const TransparentShader& node, float weight) { sum += eval_color(node.color, textures, point.uv) * weight; },
      [&](const PrincipledShader& node, float weight) {
        sum += Color((1 - eval_share(node.alpha, textures, point.uv)) * weight);
      },
      [](const auto& /*opaque*/, float) {}};
  const auto share_of = [&](const ShareInput& input) { return eval_share(input, textures, point.uv); };
  for_each_leaf(material, material.surface, 1, share_of, leaf);
  return sum;
}

bool is_transparent(const Material& material) {
  bool result = false;
  const Overloaded leaf{
      [&](const TransparentShader& node, float) {
        result |= node.color.texture.is_valid() || !is_black(node.color.constant);
      },
      [&](const PrincipledShader& node, float) { result |= node.alpha.texture.is_valid() || node.alpha.constant < 1; },
      [](const auto& /*opaque*/, float) {}};
  for_each_leaf(material, leaf);
  return result;
}

bool needs_derivatives(const Material& material) {
  bool result = false;
  const auto leaf = [&]<class Node>(const Node& node, float) {
    if constexpr (requires { node.is_stretched(); }) result |= node.is_stretched();
  };
  for_each_leaf(material, leaf);
  return result;
}

Color emitted_radiance(const Material& material, SurfaceSide side) {
  Color sum(0.0f);
  bool varies = false, shines = false;
  const auto add = [&](const ColorInput& radiance, float weight) {
    varies = varies || radiance.texture.is_valid();
    shines = shines || radiance.texture.is_valid() || !is_black(radiance.constant);
    sum += radiance.constant * weight;
  };
  const Overloaded leaf{[&](const EmissionShader& node, float weight) {
                          if (node.is_two_sided || side == SurfaceSide::front)
                            add(node.radiance, node.strength * weight);
                        },
                        [&](const PrincipledShader& node, float weight) {
                          // What is above lets through another share in each direction.
                          varies =
                              varies || node.alpha.texture.is_valid() || node.sheen_weight > 0 || node.coat_weight > 0;
                          add(node.emission, node.emission_strength * node.alpha.constant * weight);
                        },
                        [](const auto& /*dark*/, float) {}};
  const auto share_of = [&](const ShareInput& input) {
    varies = varies || input.texture.is_valid();
    return input.texture.is_valid() ? 0.5f : input.constant;
  };
  for_each_leaf(material, material.surface, 1, share_of, leaf);
  return varies && shines ? Color(0.0f) : sum;
}

bool is_emissive(const Material& material) {
  return !is_black(emitted_radiance(material, SurfaceSide::front)) ||
         !is_black(emitted_radiance(material, SurfaceSide::back));
}

namespace {

// Each of the layers that flatten() makes of it.
int count_lobes(const PrincipledShader& node) {
  const bool is_varied = node.alpha.texture.is_valid();
  if (!is_varied && node.alpha.constant == 0) return 1;
  const bool is_dielectric = node.metallic < 1, is_opaque = is_dielectric && node.transmission < 1;
  return (is_varied || node.alpha.constant < 1) + (node.sheen_weight > 0) + (node.coat_weight > 0) +
         (node.metallic > 0) + (is_dielectric && node.transmission > 0) + 2 * is_opaque;
}

}  // namespace

int lobe_count(const Material& material) {
  // Not by for_each_leaf: the ways through a graph may be exponentially many, and this is what refuses them.
  constexpr int many = 1 << 20;
  std::vector<int> counts;
  const auto count_of = [&](NodeIndex index) { return index < counts.size() ? counts[index] : 1; };
  const Overloaded count{[&](const MixShader& node) { return count_of(node.first) + count_of(node.second); },
                         [&](const AddShader& node) { return count_of(node.first) + count_of(node.second); },
                         [](const PrincipledShader& node) { return count_lobes(node); }, [](const auto&) { return 1; }};
  for (const ShaderNode& node : material.nodes) counts.push_back(std::min(std::visit(count, node), many));
  return std::max(count_of(material.surface), count_of(material.volume));
}

}  // namespace basicrt
