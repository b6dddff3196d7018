// SPDX-License-Identifier: GPL-3.0-or-later
// From shader nodes to lobes and emission: one small function for each node.
#include "bsdf/flatten.h"

namespace basicrt {
namespace flattening {
namespace {

void flatten(const DiffuseShader& node, const Target& target, float weight) {
  if (target.is_back && !node.is_two_sided) return;
  const Color color = target.eval(node.color);
  add_diffuse(target, node.roughness, color, color * weight);
}

void flatten(const TranslucentShader& node, const Target& target, float weight) {
  target.shading.bsdf.add(Translucent{}, target.eval(node.color) * weight);
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
  const Color color = target.eval(node.color);
  Microfacets microfacets = make_microfacets(node.roughness, node.distribution);
  if (node.is_stretched()) microfacets = stretch_glossy(node, target, microfacets);
  if (node.distribution == FacetDistribution::ashikhmin_shirley) {
    const AshikhminShirley lobe{std::max(microfacets.alpha_x, 1e-4f), std::max(microfacets.alpha_y, 1e-4f),
                                microfacets.turn};
    target.shading.bsdf.add(lobe, color * weight);
    return;
  }
  const Color scale = compensate(microfacets, node.distribution, [&] {
    return multiple_scattering(node.is_stretched() ? mean_roughness(microfacets) : node.roughness, target.cos_theta(),
                               color);
  });
  target.shading.bsdf.add(MicrofacetReflection<NoFresnel>{microfacets, {}}, color * scale * weight);
}

void flatten(const ConductorShader& node, const Target& target, float weight) {
  const MicrofacetModel model = node.is_ggx ? MicrofacetModel::ggx : MicrofacetModel::beckmann;
  const ConductorFresnel fresnel{node.eta / node.eta_outside, node.k / node.eta_outside};
  const Turn turn = node.is_stretched() ? target.turn(TangentKind::uv, 0) : Turn();
  target.shading.bsdf.add(MicrofacetReflection<ConductorFresnel>{{node.alpha_x, node.alpha_y, model, turn}, fresnel},
                          target.eval(node.color) * weight, fresnel(target.cos_theta()));
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
    const ConductorFresnel fresnel{node.ior, node.extinction};
    if (film.is_none())
      add(fresnel, fresnel.mean());
    else
      add(make_film_on_conductor(film, node.ior, node.extinction), fresnel.mean());
    return;
  }
  const F82Fresnel fresnel = make_f82(target.eval(node.base_color), target.eval(node.edge_tint));
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
  target.shading.bsdf.add(lobe, target.eval(node.color) * weight);
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

void flatten(const SheenShader& node, const Target& target, float weight) {
  const Color color = target.eval(node.color) * weight;
  if (node.model == SheenModel::ashikhmin)
    target.shading.bsdf.add(make_velvet(node.roughness), color);
  else if (const auto layer = make_sheen(node.roughness, target.local_wo()))
    target.shading.bsdf.add(layer->lobe, color * layer->albedo);
}

void flatten(const ToonShader& node, const Target& target, float weight) {
  const Color color = target.eval(node.color) * weight;
  if (node.component == ToonComponent::diffuse)
    target.shading.bsdf.add(DiffuseToon(node.size, node.smooth), color);
  else
    target.shading.bsdf.add(GlossyToon(node.size, node.smooth), color);
}

void flatten(const GlassShader& node, const Target& target, float weight) {
  if (const ThinFilm film(node.thin_film_thickness,
                          target.is_back ? node.thin_film_ior / node.ior : node.thin_film_ior);
      !film.is_none()) {
    FilmDielectric lobe{.eta = target.relative_ior(node.ior), .alpha = node.roughness * node.roughness, .film = film};
    lobe.f0_tint = lobe.transmit_tint = PackedColor<1>(Color(1.0f));
    if (node.distribution == FacetDistribution::beckmann) lobe.model = MicrofacetModel::beckmann;
    // One colour for both, as Blender's node has it.
    const Color color = target.eval(node.transmit_color);
    add_film_glass(target, lobe, node.roughness, node.distribution, color, color * weight);
    return;
  }
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

// What the material's surface comes to, added to `target`.
void flatten_surface(const Material& material, const Target& target) {
  for_each_leaf(
      material, material.surface, 1, [&](const ShareInput& input) { return target.eval(input); },
      [&](const auto& node, float weight) { flatten(node, target, weight); });
}

}  // namespace
}  // namespace flattening

SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point, Vec3f wo) {
  SurfaceShading shading{Bsdf(make_frame(point.shading_normal), point.geometric_normal)};
  const bool is_back = dot(point.geometric_normal, wo) < 0;
  flattening::flatten_surface(material, {textures, point, wo, is_back, shading});
  return shading;
}

}  // namespace basicrt
