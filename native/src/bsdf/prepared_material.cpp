// SPDX-License-Identifier: GPL-3.0-or-later
// Shades a material once for each side, to see whether that will do for every point.
#include "bsdf/prepared_material.h"

#include <utility>

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
    : material(compile(std::move(the_material), textures)),
      transparent(compile(transparent_part(material), textures)),
      front(uniform_shading(material, textures, {0, 0, 1})),
      back(uniform_shading(material, textures, {0, 0, -1})),
      is_boundary(material.volume != no_node && material.surface == no_node) {
  if (material.volume != no_node) medium = make_medium(material);
}

}  // namespace basicrt
