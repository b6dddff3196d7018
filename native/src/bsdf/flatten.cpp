// SPDX-License-Identifier: GPL-3.0-or-later
// From shader nodes to lobes and emission: one small function for each node.
#include <algorithm>
#include <cmath>

#include "bsdf/albedo.h"
#include "bsdf/bsdf.h"
#include "bsdf/shader_graph.h"

namespace basicrt {
namespace {

// Where a material is being flattened, and into what.
struct Target {
  const Table<Texture>& textures;
  const SurfacePoint& point;
  bool is_back;     // the viewer is behind the surface
  float cos_theta;  // between the viewer and the shading normal on his side, at least 0
  SurfaceShading& shading;

  [[nodiscard]] Color eval(const ColorInput& input) const {
    return input.texture.is_valid() ? eval_texture(textures[input.texture], point.uv) : input.constant;
  }
  // The index beyond the surface over that on the viewer's side.
  [[nodiscard]] float relative_ior(float ior) const { return is_back ? 1 / ior : ior; }
};

Color square_root(Color c) { return {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)}; }

Microfacets make_ggx(float roughness) { return {roughness * roughness, roughness * roughness, MicrofacetModel::ggx}; }

void flatten(const DiffuseShader& node, const Target& target, float weight) {
  if (target.is_back && !node.is_two_sided) return;
  target.shading.bsdf.add(Lambert{}, target.eval(node.color) * weight);
}

void flatten(const GlossyShader& node, const Target& target, float weight) {
  const Color color = target.eval(node.color);
  const Color compensation = multiple_scattering(node.roughness, target.cos_theta, color);
  target.shading.bsdf.add(MicrofacetReflection<NoFresnel>{make_ggx(node.roughness), {}}, color * compensation * weight);
}

void flatten(const ConductorShader& node, const Target& target, float weight) {
  const MicrofacetModel model = node.is_ggx ? MicrofacetModel::ggx : MicrofacetModel::beckmann;
  const ConductorFresnel fresnel{node.eta / node.eta_outside, node.k / node.eta_outside};
  if (node.alpha_x != node.alpha_y)
    target.shading.bsdf.set_frame(make_frame(target.point.shading_normal, target.point.dpdu));
  target.shading.bsdf.add(MicrofacetReflection<ConductorFresnel>{{node.alpha_x, node.alpha_y, model}, fresnel},
                          target.eval(node.color) * weight, fresnel(target.cos_theta));
}

void flatten(const RefractionShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(
      Dielectric{.eta = target.relative_ior(node.ior), .alpha = node.roughness * node.roughness, .has_fresnel = false},
      target.eval(node.color) * weight);
}

void flatten(const GlassShader& node, const Target& target, float weight) {
  const Dielectric lobe{.eta = target.relative_ior(node.ior),
                        .alpha = node.roughness * node.roughness,
                        .reflect_tint = target.eval(node.reflect_color),
                        .transmit_tint = target.eval(node.transmit_color)};
  target.shading.bsdf.add(lobe, Color(weight * glass_multiple_scattering(node.roughness, lobe.eta, target.cos_theta)),
                          lobe.albedo(target.cos_theta));
}

void flatten(const TransparentShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(Transparent{}, target.eval(node.color) * weight);
}

void flatten(const EmissionShader& node, const Target& target, float weight) {
  if (node.is_two_sided || !target.is_back) target.shading.emission += node.radiance * weight;
}

// From the top down, each layer by what the ones above leave: transparency, emission, metal, glass, and a dielectric
// reflection over diffuse.
void flatten(const PrincipledShader& node, const Target& target, float weight) {
  Bsdf& bsdf = target.shading.bsdf;
  bsdf.add(Transparent{}, Color(weight * (1 - node.alpha)));
  weight *= node.alpha;
  target.shading.emission += node.emission * weight;

  const Color base = target.eval(node.base_color);
  const Microfacets microfacets = make_ggx(node.roughness);
  if (node.metallic > 0) {
    const SchlickFresnel fresnel{base};
    const Color compensation = multiple_scattering(node.roughness, target.cos_theta, fresnel.mean());
    bsdf.add(MicrofacetReflection<SchlickFresnel>{microfacets, fresnel}, compensation * (weight * node.metallic),
             fresnel(target.cos_theta));
  }
  weight *= 1 - node.metallic;

  const float f0 = reflectance_from_ior(node.ior) * 2 * node.specular_ior_level;
  const float ior = node.specular_ior_level == 0.5f ? node.ior : ior_from_reflectance(f0);
  if (node.transmission > 0) {
    const Dielectric lobe{
        .eta = target.relative_ior(node.ior), .alpha = microfacets.alpha_x, .transmit_tint = square_root(base)};
    bsdf.add(lobe,
             Color(weight * node.transmission * glass_multiple_scattering(node.roughness, lobe.eta, target.cos_theta)),
             lobe.albedo(target.cos_theta));
  }
  weight *= 1 - node.transmission;

  const DielectricLayer layer = dielectric_layer(node.roughness, ior, target.cos_theta);
  bsdf.add(MicrofacetReflection<InterfaceFresnel>{microfacets, {ior}}, Color(weight * layer.scale),
           Color(layer.albedo));
  bsdf.add(Lambert{}, base * (weight * (1 - layer.albedo)));
}

}  // namespace

SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo) {
  SurfaceShading shading{Bsdf(make_frame(point.shading_normal), point.geometric_normal)};
  const bool is_back = dot(point.geometric_normal, wo) < 0;
  const float cos_theta = std::clamp(dot(point.shading_normal, wo) * (is_back ? -1.0f : 1.0f), 0.0f, 1.0f);
  const Target target{textures, point, is_back, cos_theta, shading};
  for_each_leaf(material, [&](const auto& node, float weight) { flatten(node, target, weight); });
  return shading;
}

}  // namespace basicrt
