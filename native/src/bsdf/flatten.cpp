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
  Vec3f wo;
  bool is_back;  // the viewer is behind the surface
  SurfaceShading& shading;

  // Whoever asks for either gets something that isn't the same everywhere.
  [[nodiscard]] Color eval(const ColorInput& input) const {
    shading.is_uniform = shading.is_uniform && is_constant(input, textures);
    return eval_color(input, textures, point.uv);
  }
  [[nodiscard]] float eval(const ShareInput& input) const {
    shading.is_uniform = shading.is_uniform && is_constant(input, textures);
    return eval_share(input, textures, point.uv);
  }
  // Between the viewer and the shading normal on his side, at least 0.
  [[nodiscard]] float cos_theta() const {
    shading.is_uniform = false;
    return std::clamp(dot(point.shading_normal, wo) * (is_back ? -1.0f : 1.0f), 0.0f, 1.0f);
  }
  // The index beyond the surface over that on the viewer's side.
  [[nodiscard]] float relative_ior(float ior) const { return is_back ? 1 / ior : ior; }
};

Color square_root(Color c) { return {std::sqrt(c.x), std::sqrt(c.y), std::sqrt(c.z)}; }

Microfacets make_microfacets(float roughness, FacetDistribution distribution) {
  const float alpha = roughness * roughness;
  const bool is_beckmann = distribution == FacetDistribution::beckmann;
  return {alpha, alpha, is_beckmann ? MicrofacetModel::beckmann : MicrofacetModel::ggx};
}

// What `microfacets` are multiplied by so that light bouncing between them is kept, where it is to be.
Color compensate(const Microfacets& microfacets, FacetDistribution distribution, auto multiple_scattering_function) {
  const bool is_needed = distribution == FacetDistribution::multi_ggx && !microfacets.is_smooth();
  return is_needed ? multiple_scattering_function() : Color(1.0f);
}

void flatten(const DiffuseShader& node, const Target& target, float weight) {
  if (target.is_back && !node.is_two_sided) return;
  target.shading.bsdf.add(Lambert{}, target.eval(node.color) * weight);
}

void flatten(const GlossyShader& node, const Target& target, float weight) {
  const Color color = target.eval(node.color);
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Color scale = compensate(microfacets, node.distribution,
                                 [&] { return multiple_scattering(node.roughness, target.cos_theta(), color); });
  target.shading.bsdf.add(MicrofacetReflection<NoFresnel>{microfacets, {}}, color * scale * weight);
}

void flatten(const ConductorShader& node, const Target& target, float weight) {
  const MicrofacetModel model = node.is_ggx ? MicrofacetModel::ggx : MicrofacetModel::beckmann;
  const ConductorFresnel fresnel{node.eta / node.eta_outside, node.k / node.eta_outside};
  if (node.is_stretched())
    target.shading.bsdf.set_frame(make_frame(target.point.shading_normal, target.point.derivatives->dpdu));
  target.shading.bsdf.add(MicrofacetReflection<ConductorFresnel>{{node.alpha_x, node.alpha_y, model}, fresnel},
                          target.eval(node.color) * weight, fresnel(target.cos_theta()));
}

void flatten(const RefractionShader& node, const Target& target, float weight) {
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Dielectric lobe{
      .eta = target.relative_ior(node.ior),
      .alpha = microfacets.alpha_x,
      .model = microfacets.model,
      .reflected = node.is_total_reflection_kept ? ReflectedLight::only_past_critical_angle : ReflectedLight::none};
  target.shading.bsdf.add(lobe, target.eval(node.color) * weight);
}

void flatten(const GlassShader& node, const Target& target, float weight) {
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Dielectric lobe{.eta = target.relative_ior(node.ior),
                        .alpha = microfacets.alpha_x,
                        .model = microfacets.model,
                        .reflect_tint = target.eval(node.reflect_color),
                        .transmit_tint = target.eval(node.transmit_color)};
  const Color scale = compensate(microfacets, node.distribution, [&] {
    return glass_multiple_scattering(node.roughness, lobe.eta, target.cos_theta(), lobe.transmit_tint);
  });
  target.shading.bsdf.add(lobe, scale * weight, lobe.albedo(target.cos_theta()));
}

void flatten(const TransparentShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(Transparent{}, target.eval(node.color) * weight);
}

void flatten(const EmissionShader& node, const Target& target, float weight) {
  if (node.is_two_sided || !target.is_back)
    target.shading.emission += target.eval(node.radiance) * (node.strength * weight);
}

void flatten(const VolumeShader&, const Target&, float) {}  // nothing on a surface

void flatten(const HoldoutShader&, const Target& target, float weight) { target.shading.holdout += weight; }

void add_metal(const PrincipledShader& node, const Target& target, Color base, float weight) {
  const SchlickFresnel fresnel{base};
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Color scale = compensate(microfacets, node.distribution, [&] {
    return multiple_scattering(node.roughness, target.cos_theta(), fresnel.mean());
  });
  target.shading.bsdf.add(MicrofacetReflection<SchlickFresnel>{microfacets, fresnel}, scale * weight,
                          fresnel(target.cos_theta()));
}

void add_reflection_over_diffuse(const PrincipledShader& node, const Target& target, Color base, float weight) {
  const float f0 = reflectance_from_ior(node.ior) * 2 * node.specular_ior_level;
  const float ior = node.specular_ior_level == 0.5f ? node.ior : ior_from_reflectance(f0);
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  DielectricLayer layer = dielectric_layer(node.roughness, ior, target.cos_theta());
  if (node.distribution != FacetDistribution::multi_ggx) layer = {1, layer.albedo / layer.scale};
  if (microfacets.is_smooth()) layer = {1, fresnel_dielectric(target.cos_theta(), ior).reflectance};
  Bsdf& bsdf = target.shading.bsdf;
  bsdf.add(MicrofacetReflection<InterfaceFresnel>{microfacets, {ior}}, Color(weight * layer.scale),
           Color(layer.albedo / layer.scale));
  bsdf.add(Lambert{}, base * (weight * (1 - layer.albedo)));
}

// From the top down, each layer by what the ones above leave: transparency, emission, metal, glass, and a dielectric
// reflection over diffuse.
void flatten(const PrincipledShader& node, const Target& target, float weight) {
  const float alpha = target.eval(node.alpha);
  target.shading.bsdf.add(Transparent{}, Color(weight * (1 - alpha)));
  weight *= alpha;
  target.shading.emission += target.eval(node.emission) * (node.emission_strength * weight);

  const Color base = target.eval(node.base_color);
  if (node.metallic > 0) add_metal(node, target, base, weight * node.metallic);
  weight *= 1 - node.metallic;
  if (node.transmission > 0) {
    // The root, for light passes twice through most bodies. The level of the specular reflection leaves glass alone.
    const GlassShader glass{.transmit_color = square_root(base),
                            .ior = node.ior,
                            .roughness = node.roughness,
                            .distribution = node.distribution};
    flatten(glass, target, weight * node.transmission);
  }
  weight *= 1 - node.transmission;
  if (weight > 0) add_reflection_over_diffuse(node, target, base, weight);
}

}  // namespace

SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo) {
  SurfaceShading shading{Bsdf(make_frame(point.shading_normal), point.geometric_normal)};
  const bool is_back = dot(point.geometric_normal, wo) < 0;
  const Target target{textures, point, wo, is_back, shading};
  for_each_leaf(
      material, material.surface, 1, [&](const ShareInput& input) { return target.eval(input); },
      [&](const auto& node, float weight) { flatten(node, target, weight); });
  return shading;
}

}  // namespace basicrt
