// SPDX-License-Identifier: GPL-3.0-or-later
// What turning shader nodes into lobes has in common: where that happens, and the microfacets.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/albedo.h"
#include "bsdf/bsdf.h"
#include "bsdf/shader_graph.h"
#include "bsdf/sheen.h"
#include "bsdf/thin_film.h"

namespace basicrt::flattening {

// A shader's normal, which is on the viewer's side, on the surface's own; zero stands for the surface's normal.
[[nodiscard]] inline Vec3f lobe_normal(Vec3f normal, const SurfacePoint& point, bool is_back) {
  const float size = length(normal);
  return size > 0 ? normal * ((is_back ? -1.0f : 1.0f) / size) : point.shading_normal;
}

// Where a material is being flattened, and into what.
struct Target {
  const SurfacePoint& point;
  Vec3f wo;
  bool is_back;  // the viewer is behind the surface
  SurfaceShading& shading;
  Vec3f normal;  // that the shader wants, on the surface's own side

  // Between the viewer and the shading normal on his side, at least 0.
  [[nodiscard]] float cos_theta() const {
    shading.is_uniform = false;
    return std::clamp(dot(normal, wo) * (is_back ? -1.0f : 1.0f), 0.0f, 1.0f);
  }
  // Towards the viewer, z being the shading normal on his side.
  [[nodiscard]] Vec3f local_wo() const {
    shading.is_uniform = false;
    return make_frame(normal).to_local(is_back ? -wo : wo);
  }
  // How far stretched microfacets are turned: `rotation` in whole turns, as the viewer sees them.
  [[nodiscard]] Turn turn(TangentKind kind, float rotation) const {
    shading.is_uniform = false;
    const SurfaceDerivatives& derivatives = *point.derivatives;
    const Vec3f tangent =
        kind == TangentKind::uv ? derivatives.dpdu : derivatives.radial_tangents[static_cast<std::size_t>(kind) - 1];
    const float whole_turns = rotation - std::floor(rotation);
    return {make_frame(normal).to_local(tangent), (is_back ? -2 : 2) * pi * whole_turns};
  }
  // The index beyond the surface over that on the viewer's side.
  [[nodiscard]] float relative_ior(float ior) const { return is_back ? 1 / ior : ior; }
};

[[nodiscard]] inline Microfacets make_microfacets(float roughness, FacetDistribution distribution) {
  const float alpha = roughness * roughness;
  const bool is_beckmann = distribution == FacetDistribution::beckmann;
  return {alpha, alpha, is_beckmann ? MicrofacetModel::beckmann : MicrofacetModel::ggx};
}

// Longer across the tangent where `anisotropy` is above 0, as the Principled and the Metallic node have it.
[[nodiscard]] inline Microfacets stretch(Microfacets microfacets, float anisotropy, Turn turn) {
  const float aspect = std::sqrt(1 - 0.9f * anisotropy);
  microfacets.alpha_x = std::min(microfacets.alpha_x / aspect, 1.0f);
  microfacets.alpha_y *= aspect;
  microfacets.turn = turn;
  return microfacets;
}

// Of round microfacets that lose about as much light as these.
[[nodiscard]] inline float mean_roughness(const Microfacets& microfacets) {
  return std::sqrt(std::sqrt(microfacets.alpha_x * microfacets.alpha_y));
}

// What `microfacets` are multiplied by so that light bouncing between them is kept, where it is to be.
[[nodiscard]] Color compensate(const Microfacets& microfacets, FacetDistribution distribution,
                               auto multiple_scattering_function) {
  const bool is_needed = distribution == FacetDistribution::multi_ggx && !microfacets.is_smooth();
  return is_needed ? multiple_scattering_function() : Color(1.0f);
}

// Adds a reflection by microfacets whose light meets `fresnel` at each bounce, a mean of `mean` of them.
template <class Fresnel>
void add_metal(const Target& target, const Microfacets& microfacets, const Fresnel& fresnel, Color mean,
               FacetDistribution distribution, Color weight) {
  const Color scale = compensate(microfacets, distribution, [&] {
    return multiple_scattering(mean_roughness(microfacets), target.cos_theta(), mean);
  });
  target.shading.bsdf.add(MicrofacetReflection<Fresnel>{microfacets, fresnel}, scale * weight,
                          fresnel(target.cos_theta()));
}

// Lambert's or Oren and Nayar's; the weight holds the colour.
inline void add_diffuse(const Target& target, float roughness, Color color, Color weight) {
  if (roughness < 1e-5f)
    target.shading.bsdf.add(Lambert{}, weight);
  else
    target.shading.bsdf.add(OrenNayar(clamp_to_unit(color), roughness, target.cos_theta()), weight);
}

// The weight holds the colour. Colours that go next to nowhere beneath the surface are reflected diffusely.
inline void add_subsurface(const Target& target, const Subsurface& lobe, Color weight) {
  Color stays(0.0f), wanders = weight;
  for (std::size_t i = 0; i < 3; ++i)
    if (lobe.radius()[i] < Subsurface::least_radius) std::swap(stays[i], wanders[i]);
  target.shading.bsdf.add(Lambert{}, stays);
  target.shading.bsdf.add(lobe, wanders);
}

// Glass of which the reflection at normal incidence is tinted, or which has a film on it.
// Light that bounces between facets is taken to meet `bounced`.
inline void add_film_glass(const Target& target, const FilmDielectric& lobe, float roughness,
                           FacetDistribution distribution, Color bounced, Color weight) {
  const Color scale = compensate({lobe.alpha, lobe.alpha}, distribution, [&] {
    return glass_multiple_scattering(roughness, lobe.eta, target.cos_theta(), bounced);
  });
  target.shading.bsdf.add(lobe, scale * weight, lobe.albedo(target.cos_theta()));
}

void flatten(const PrincipledShader& node, const Target& target, float weight);

}  // namespace basicrt::flattening
