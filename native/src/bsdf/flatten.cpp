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
  target.shading.bsdf.add(Lambert{}, node.color.constant * weight);
}

void flatten(const GlossyShader& node, const Target& target, float weight) {
  const Color color = node.color.constant;
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Color scale = compensate(microfacets, node.distribution,
                                 [&] { return multiple_scattering(node.roughness, target.cos_theta(), color); });
  target.shading.bsdf.add(MicrofacetReflection<NoFresnel>{microfacets, {}}, color * scale * weight);
}

void flatten(const ConductorShader& node, const Target& target, float weight) {
  const MicrofacetModel model = node.is_ggx ? MicrofacetModel::ggx : MicrofacetModel::beckmann;
  const ConductorFresnel fresnel{node.eta / node.eta_outside, node.k / node.eta_outside};
  if (node.is_stretched()) target.shading.bsdf.set_frame(make_frame(target.normal, target.point.derivatives->dpdu));
  target.shading.bsdf.add(MicrofacetReflection<ConductorFresnel>{{node.alpha_x, node.alpha_y, model}, fresnel},
                          node.color.constant * weight, fresnel(target.cos_theta()));
}

void flatten(const RefractionShader& node, const Target& target, float weight) {
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Dielectric lobe{
      .eta = target.relative_ior(node.ior),
      .alpha = microfacets.alpha_x,
      .model = microfacets.model,
      .reflected = node.is_total_reflection_kept ? ReflectedLight::only_past_critical_angle : ReflectedLight::none};
  target.shading.bsdf.add(lobe, node.color.constant * weight);
}

void flatten(const GlassShader& node, const Target& target, float weight) {
  const Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  const Dielectric lobe{.eta = target.relative_ior(node.ior),
                        .alpha = microfacets.alpha_x,
                        .model = microfacets.model,
                        .reflect_tint = node.reflect_color.constant,
                        .transmit_tint = node.transmit_color.constant};
  const Color scale = compensate(microfacets, node.distribution, [&] {
    return glass_multiple_scattering(node.roughness, lobe.eta, target.cos_theta(), lobe.transmit_tint);
  });
  target.shading.bsdf.add(lobe, scale * weight, lobe.albedo(target.cos_theta()));
}

void flatten(const TransparentShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(Transparent{}, node.color.constant * weight);
}

void flatten(const EmissionShader& node, const Target& target, float weight) {
  if (node.is_two_sided || !target.is_back)
    target.shading.emission += node.radiance.constant * (node.strength * weight);
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
  const float ior = node.specular_ior_level == 0.5f ? node.ior.constant : ior_from_reflectance(f0);
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
  const float alpha = node.alpha.constant;
  target.shading.bsdf.add(Transparent{}, Color(weight * (1 - alpha)));
  weight *= alpha;
  target.shading.emission += node.emission.constant * (node.emission_strength * weight);

  const Color base = node.base_color.constant;
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

// What the lobes of a shader without varying inputs are turned to.
template <class Shader>
Vec3f normal_of(const Shader& shader, const SurfacePoint& point, bool is_back) {
  if constexpr (requires { shader.normal; }) {
    const Vec3f normal = shader.normal.constant;
    const float size = length(normal);
    if (size > 0) return normal * ((is_back ? -1.0f : 1.0f) / size);
  }
  return point.shading_normal;
}

}  // namespace

SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                     const ShadingContext& context) {
  SurfaceShading shading{Bsdf(make_frame(point.shading_normal), point.geometric_normal)};
  const bool is_back = dot(point.geometric_normal, wo) < 0;
  with_values(material, textures, point, wo, context, [&](const Evaluator& in) {
    const auto share_of = [&](const NumberInput& input) {
      shading.is_uniform = shading.is_uniform && !input.is_varying();
      return eval_factor(input, in);
    };
    const auto flatten_constant = [&](const auto& node, float weight) {
      const Target target{point, wo, is_back, shading, normal_of(node, point, is_back)};
      if (target.normal != point.shading_normal) {
        shading.is_uniform = false;
        shading.bsdf.set_frame(make_frame(target.normal));
      }
      flatten(node, target, weight);
    };
    for_each_leaf(material, material.surface, 1, share_of, [&](const auto& node, float weight) {
      if (!is_varying(node)) return flatten_constant(node, weight);
      shading.is_uniform = false;
      flatten_constant(resolve(node, in), weight);
    });
  });
  return shading;
}

}  // namespace basicrt
