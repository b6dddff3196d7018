// SPDX-License-Identifier: GPL-3.0-or-later
// From shader nodes to lobes and emission: one small function for each node.
#include "bsdf/flatten.h"

namespace basicrt {
namespace flattening {
namespace {

void flatten(const DiffuseShader& node, const Target& target, float weight) {
  if (target.is_back && !node.is_two_sided) return;
  const Color color = node.color.constant;
  add_diffuse(target, node.roughness, color, color * weight);
}

void flatten(const TranslucentShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(Translucent{}, node.color.constant * weight);
}

void flatten(const SubsurfaceShader& node, const Target& target, float weight) {
  const Color color = node.color.constant;
  const Subsurface lobe(node.model, color, node.radius.constant * node.scale, node.ior, node.alpha, node.anisotropy);
  add_subsurface(target, lobe, color * weight);
}

// Blender's Glossy node is stretched in a way of its own.
Microfacets stretch_glossy(const GlossyShader& node, const Target& target, Microfacets microfacets) {
  const float length = 1 - std::min(std::abs(node.anisotropy), 0.99f);
  float& smoother = node.anisotropy > 0 ? microfacets.alpha_x : microfacets.alpha_y;
  float& rougher = node.anisotropy > 0 ? microfacets.alpha_y : microfacets.alpha_x;
  smoother *= length;
  rougher = std::min(rougher / length, 1.0f);
  microfacets.turn = target.turn(node.tangent, node.rotation);
  return microfacets;
}

void flatten(const GlossyShader& node, const Target& target, float weight) {
  const Color color = node.color.constant;
  Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  if (node.is_stretched()) microfacets = stretch_glossy(node, target, microfacets);
  if (node.distribution == FacetDistribution::ashikhmin_shirley) {
    const AshikhminShirley lobe{std::max(microfacets.alpha_x, 1e-4f), std::max(microfacets.alpha_y, 1e-4f),
                                microfacets.turn};
    target.shading.bsdf.add(lobe, color * weight);
    return;
  }
  const Color scale = compensate(microfacets, node.distribution, [&] {
    return multiple_scattering(node.is_stretched() ? mean_roughness(microfacets) : node.roughness.constant,
                               target.cos_theta(), color);
  });
  target.shading.bsdf.add(MicrofacetReflection<NoFresnel>{microfacets, {}}, color * scale * weight);
}

void flatten(const ConductorShader& node, const Target& target, float weight) {
  const MicrofacetModel model = node.is_ggx ? MicrofacetModel::ggx : MicrofacetModel::beckmann;
  const ConductorFresnel fresnel{node.eta / node.eta_outside, node.k / node.eta_outside};
  const Turn turn = node.is_stretched() ? target.turn(TangentKind::uv, 0) : Turn();
  target.shading.bsdf.add(MicrofacetReflection<ConductorFresnel>{{node.alpha_x, node.alpha_y, model, turn}, fresnel},
                          node.color.constant * weight, fresnel(target.cos_theta()));
}

void flatten(const MetallicShader& node, const Target& target, float weight) {
  Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  if (node.is_stretched())
    microfacets = stretch(microfacets, node.anisotropy, target.turn(node.tangent, node.rotation));
  const ThinFilm film(node.thin_film_thickness, node.thin_film_ior);
  const auto add = [&](const auto& fresnel, Color mean) {
    add_metal(target, microfacets, fresnel, mean, node.distribution, Color(weight));
  };
  if (node.model == MetalModel::physical_conductor) {
    const Color ior = node.ior.constant, extinction = node.extinction.constant;
    const ConductorFresnel fresnel{ior, extinction};
    if (film.is_none())
      add(fresnel, fresnel.mean());
    else
      add(make_film_on_conductor(film, ior, extinction), fresnel.mean());
    return;
  }
  const F82Fresnel fresnel = make_f82(node.base_color.constant, node.edge_tint.constant);
  if (film.is_none())
    add(fresnel, fresnel.mean());
  else
    add(make_film_on_f82(film, fresnel), fresnel.mean());
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

void flatten(const TransparentShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(Transparent{}, node.color.constant * weight);
}

void flatten(const EmissionShader& node, const Target& target, float weight) {
  if (node.is_two_sided || !target.is_back)
    target.shading.emission += node.radiance.constant * (node.strength * weight);
}

void flatten(const VolumeShader&, const Target&, float) {}  // nothing on a surface
void flatten(const AovShader&, const Target&, float) {}
void flatten(const DisplacementShader&, const Target&, float) {}

void flatten(const HoldoutShader&, const Target& target, float weight) { target.shading.holdout += weight; }

void flatten(const SheenShader& node, const Target& target, float weight) {
  const Color color = node.color.constant * weight;
  if (node.model == SheenModel::ashikhmin)
    target.shading.bsdf.add(make_velvet(node.roughness), color);
  else if (const auto layer = make_sheen(node.roughness, target.local_wo()))
    target.shading.bsdf.add(layer->lobe, color * layer->albedo);
}

void flatten(const ToonShader& node, const Target& target, float weight) {
  const Color color = node.color.constant * weight;
  if (node.component == ToonComponent::diffuse)
    target.shading.bsdf.add(DiffuseToon(node.size, node.smooth), color);
  else
    target.shading.bsdf.add(GlossyToon(node.size, node.smooth), color);
}

void flatten(const GlassShader& node, const Target& target, float weight) {
  if (const ThinFilm film(node.thin_film_thickness,
                          target.is_back ? node.thin_film_ior / node.ior : node.thin_film_ior.constant);
      !film.is_none()) {
    FilmDielectric lobe{.eta = target.relative_ior(node.ior), .alpha = node.roughness * node.roughness, .film = film};
    lobe.f0_tint = lobe.transmit_tint = PackedColor<1>(Color(1.0f));
    if (node.distribution == FacetDistribution::beckmann) lobe.model = MicrofacetModel::beckmann;
    // One colour for both, as Blender's node has it.
    const Color color = node.transmit_color.constant;
    add_film_glass(target, lobe, node.roughness, node.distribution, color, color * weight);
    return;
  }
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

// Along the fibre, in the lobes' frame. Surfaces other than curves have fibres along u, or along v where `is_across`.
Vec3f local_fiber(const Target& target, bool is_across = false) {
  target.shading.is_uniform = false;
  const SurfaceDerivatives& derivatives = *target.point.derivatives;
  const Vec3f along = is_across ? derivatives.dpdv : derivatives.dpdu;
  return make_frame(target.normal).to_local(target.is_back ? -along : along);
}

void flatten(const PrincipledHairShader& node, const Target& target, float weight) {
  const auto varied = [&](float share) { return 1 + 2 * (node.random - 0.5f) * share; };
  const float factor = varied(node.random_roughness);
  ChiangHairSettings settings{.roughness = node.roughness * factor,
                              .radial_roughness = node.radial_roughness * factor,
                              .coat = node.coat,
                              .ior = node.ior,
                              .offset = node.offset};
  switch (node.parametrization) {
    case HairParametrization::absorption:
      settings.absorption = node.absorption.constant;
      break;
    case HairParametrization::color:
      settings.absorption = hair_absorption_of_color(node.color.constant, settings.radial_roughness);
      break;
    case HairParametrization::melanin: {
      const float share = node.melanin * varied(std::clamp(node.random_color.constant, 0.0f, 1.0f));
      // From even steps for the eye to how much of it there is.
      const float melanin = -std::log(std::max(1 - share, 0.0001f));
      settings.absorption =
          hair_absorption_of_melanin(melanin * (1 - node.melanin_redness), melanin * node.melanin_redness) +
          hair_absorption_of_color(node.tint.constant, settings.radial_roughness);
      break;
    }
  }
  const ChiangHair lobe(settings, local_fiber(target));
  // Dark hair reflects too: none is left out as black.
  target.shading.bsdf.add(lobe, Color(weight), lobe.albedo() + Color(0.05f));
}

void flatten(const HairShader& node, const Target& target, float weight) {
  const bool is_fiber = node.is_on_curve.constant != 0;
  const float offset = is_fiber ? -node.offset.constant : 0;
  const Vec3f fiber = local_fiber(target, !is_fiber);
  const Color color = node.color.constant * weight;
  if (node.component == HairComponent::reflection)
    target.shading.bsdf.add(HairReflection(fiber, node.roughness_u, node.roughness_v, offset), color);
  else
    target.shading.bsdf.add(HairTransmission(fiber, node.roughness_u, node.roughness_v, offset), color);
}

// What the lobes of a shader without varying inputs are turned to.
template <class Shader>
Vec3f normal_of(const Shader& shader, const SurfacePoint& point, bool is_back) {
  if constexpr (requires { shader.normal; }) return lobe_normal(shader.normal.constant, point, is_back);
  return point.shading_normal;
}

// A shader without varying inputs.
template <class Shader>
void flatten_constant(const Shader& node, const SurfacePoint& point, Vec3f wo, SurfaceShading& shading, float weight) {
  const bool is_back = dot(point.geometric_normal, wo) < 0;
  const Target target{point, wo, is_back, shading, normal_of(node, point, is_back)};
  if (target.normal != point.shading_normal) shading.is_uniform = false;
  shading.bsdf.use_normal(target.normal);
  flatten(node, target, weight);
}

}  // namespace
}  // namespace flattening

SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo,
                     const ShadingContext& context) {
  SurfaceShading shading{Bsdf(make_frame(point.shading_normal), point.geometric_normal)};
  with_values(material, textures, point, wo, context, [&](const Evaluator& in) {
    const auto share_of = [&](const NumberInput& input) {
      shading.is_uniform = shading.is_uniform && !input.is_varying();
      return eval_factor(input, in);
    };
    for_each_leaf(material, material.surface, 1, share_of, [&](const auto& node, float weight) {
      if (!is_varying(node)) return flattening::flatten_constant(node, point, wo, shading, weight);
      shading.is_uniform = false;
      flattening::flatten_constant(resolve(node, in), point, wo, shading, weight);
    });
  });
  return shading;
}

}  // namespace basicrt
