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

// The material with nothing but its nodes of one kind, compiled; nothing where there is none. They are added up, so that
// there is a surface from which they are found.
template <class Shader>
std::optional<Material> part_of(const Material& material, const Table<Texture>& textures) {
  Material part = material;
  part.volume = part.surface = no_node;
  for (NodeIndex node = 0; node < material.nodes.size(); ++node)
    if (std::holds_alternative<Shader>(material.nodes[node]))
      part.surface = part.add(AddShader{.first = part.surface, .second = node});
  return part.surface == no_node ? std::nullopt : std::optional(compile(std::move(part), textures));
}

// Calls visit(Shader) for each node of the kind, with constants for all inputs.
template <class Shader, class Visitor>
void for_each_resolved(const Material& part, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                       const ShadingContext& context, Visitor&& visit) {
  with_values(part, textures, point, wo, context, [&](const Evaluator& in) {
    const auto leaf = [&]<class Node>(const Node& node, float) {
      if constexpr (std::is_same_v<Node, Shader>) visit(resolve(node, in));
    };
    for_each_leaf(part, part.surface, 1, [](const NumberInput&) { return 0.0f; }, leaf);
  });
}

}  // namespace

PreparedMaterial::PreparedMaterial(Material the_material, const Table<Texture>& textures)
    : material(compile(the_material, textures)),
      transparent(compile(transparent_part(material), textures)),
      // Compiled, the surface has lost the operations that only these name.
      aovs(part_of<AovShader>(the_material, textures)),
      displacement(part_of<DisplacementShader>(the_material, textures)),
      front(uniform_shading(material, textures, {0, 0, 1})),
      back(uniform_shading(material, textures, {0, 0, -1})),
      is_boundary(material.volume != no_node && material.surface == no_node) {
  if (material.volume != no_node) medium = make_medium(material);
}

void for_each_aov(const PreparedMaterial& prepared, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                  const ShadingContext& context, const std::function<void(const AovShader&)>& visit) {
  if (prepared.aovs) for_each_resolved<AovShader>(*prepared.aovs, textures, point, wo, context, visit);
}

Displacement displacement_at(const PreparedMaterial& prepared, const Table<Texture>& textures,
                             const SurfacePoint& point, const ShadingContext& context) {
  Displacement sum;
  const auto add = [&](const DisplacementShader& one) {
    const Color& offset = one.offset.constant;
    if (!is_finite(offset)) return;
    sum.offset += Vec3f(offset);
    sum.keeps_normals = sum.keeps_normals && one.keeps_normals;
  };
  if (prepared.displacement)
    for_each_resolved<DisplacementShader>(*prepared.displacement, textures, point, point.geometric_normal, context,
                                          add);
  return sum;
}

}  // namespace basicrt
