// SPDX-License-Identifier: GPL-3.0-or-later
// Shades a material once for each side, to see whether that will do for every point.
#include "bsdf/prepared_material.h"

#include <type_traits>
#include <utility>

#include "bsdf/shader_graph.h"
#include "shading/program.h"

namespace basicrt {
namespace {

std::optional<SurfaceShading> uniform_shading(const Material& material, const Table<Texture>& textures, Vec3f wo) {
  SurfacePoint anywhere;
  anywhere.geometric_normal = anywhere.shading_normal = {0, 0, 1};
  anywhere.derivatives.emplace().dpdu = {1, 0, 0};
  const SurfaceShading shading = shade(material, textures, anywhere, wo);
  return shading.is_uniform ? std::optional(shading) : std::nullopt;
}

}  // namespace

PreparedMaterial::PreparedMaterial(Material the_material, const Table<Texture>& textures)
    : material(compile(the_material, textures)),
      transparent(compile(transparent_part(material), textures)),
      aovs(aov_part(the_material)),  // compiled, the surface has lost the operations that only they name
      front(uniform_shading(material, textures, {0, 0, 1})),
      back(uniform_shading(material, textures, {0, 0, -1})),
      is_boundary(material.volume != no_node && material.surface == no_node) {
  if (material.volume != no_node) medium = make_medium(material);
  if (aovs) aovs = compile(std::move(*aovs), textures);
}

// Added up, so that there is a surface from which they are found.
std::optional<Material> aov_part(const Material& material) {
  Material part = material;
  part.volume = part.surface = no_node;
  for (NodeIndex node = 0; node < material.nodes.size(); ++node)
    if (std::holds_alternative<AovShader>(material.nodes[node]))
      part.surface = part.add(AddShader{.first = part.surface, .second = node});
  return part.surface == no_node ? std::nullopt : std::optional(std::move(part));
}

void for_each_aov(const PreparedMaterial& prepared, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                  const ShadingContext& context, const std::function<void(const AovShader&)>& visit) {
  if (!prepared.aovs) return;
  with_values(*prepared.aovs, textures, point, wo, context, [&](const Evaluator& in) {
    const auto leaf = [&]<class Node>(const Node& node, float) {
      if constexpr (std::is_same_v<Node, AovShader>) visit(resolve(node, in));
    };
    for_each_leaf(*prepared.aovs, prepared.aovs->surface, 1, [](const NumberInput&) { return 0.0f; }, leaf);
  });
}

}  // namespace basicrt
