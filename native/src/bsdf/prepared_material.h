// SPDX-License-Identifier: GPL-3.0-or-later
// A material with what shade() makes of it, where that is always the same.
#pragma once

#include <functional>
#include <optional>

#include "bsdf/bsdf.h"
#include "bsdf/medium.h"

namespace basicrt {

struct PreparedMaterial {
  Material material;                          // compiled
  Material transparent;                       // its transparent_part(), compiled
  std::optional<Material> aovs;               // what it writes into passes, compiled, where it does
  std::optional<Material> displacement;       // what moves vertices, compiled, where it does
  std::optional<SurfaceShading> front, back;  // of each side that is uniform
  std::optional<Medium> medium;               // what its volume is
  bool is_boundary = false;                   // it has a volume and no surface: light passes straight through
  std::uint32_t matte_id = 0;

  PreparedMaterial(Material the_material, const Table<Texture>& textures);
};

// Calls visit(AovShader) for each, with constants for all inputs.
void for_each_aov(const PreparedMaterial& prepared, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                  const ShadingContext& context, const std::function<void(const AovShader&)>& visit);

// By how much the material moves a vertex that is there, world space, and whether normals stay as they were.
struct Displacement {
  Vec3f offset{0.0f};
  bool keeps_normals = true;
};
[[nodiscard]] Displacement displacement_at(const PreparedMaterial& prepared, const Table<Texture>& textures,
                                           const SurfacePoint& point, const ShadingContext& context);

// `context` is called for a ShadingContext where the material asks for more than the point.
template <class ContextFunction>
[[nodiscard]] SurfaceShading shade(const PreparedMaterial& prepared, const Table<Texture>& textures,
                                   const SurfacePoint& point, Vec3f wo, ContextFunction&& context) {
  const std::optional<SurfaceShading>& uniform = dot(point.geometric_normal, wo) < 0 ? prepared.back : prepared.front;
  if (!uniform) return shade(prepared.material, textures, point, wo, context());
  return {Bsdf(make_frame(point.shading_normal), point.geometric_normal, uniform->bsdf), uniform->emission,
          uniform->holdout};
}

}  // namespace basicrt
