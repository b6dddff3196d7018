// SPDX-License-Identifier: GPL-3.0-or-later
// Materials, surface points and directions that the tests of scattering share.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "bsdf/bsdf.h"
#include "math/warp.h"
#include "support/chi_square.h"

namespace basicrt::test {

inline Material make_material(const ShaderNode& node) { return {.name = {}, .nodes = {node}, .surface = 0}; }

inline Material make_mix(float factor, const ShaderNode& first, const ShaderNode& second) {
  return {.name = {}, .nodes = {first, second, MixShader{factor, 0, 1}}, .surface = 2};
}

inline Material make_sum(const ShaderNode& first, const ShaderNode& second) {
  return {.name = {}, .nodes = {first, second, AddShader{0, 1}}, .surface = 2};
}

// A point whose normals are given, and the same for both unless said otherwise.
inline SurfacePoint make_point(Vec3f geometric_normal, Vec3f shading_normal) {
  SurfacePoint point;
  point.geometric_normal = normalize(geometric_normal);
  point.shading_normal = normalize(shading_normal);
  const Frame frame = make_frame(point.shading_normal);
  point.derivatives = SurfaceDerivatives{.dpdu = frame.tangent, .dpdv = frame.bitangent};
  return point;
}
inline SurfacePoint make_point(Vec3f normal = {0, 0, 1}) { return make_point(normal, normal); }

// The direction at an angle to z, in degrees: more than 90 is behind the surface.
inline Vec3f direction_at(float degrees, float azimuth_degrees = 30) {
  const float theta = degrees * pi / 180, phi = azimuth_degrees * pi / 180;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

inline Bsdf make_bsdf(const Material& material, const SurfacePoint& point, Vec3f wo) {
  static const Table<Texture> no_textures;
  return shade(material, no_textures, point, wo).bsdf;
}

struct NamedMaterial {
  std::string name;
  Material material;
};

// One or more of every kind, with and without deltas.
inline std::vector<NamedMaterial> all_materials() {
  const auto conductor = [](float alpha_x, float alpha_y, bool is_ggx) {
    ConductorShader node;
    node.alpha_x = alpha_x;
    node.alpha_y = alpha_y;
    node.is_ggx = is_ggx;
    return make_material(node);
  };
  const auto principled = [](float metallic, float roughness, float transmission, float alpha) {
    PrincipledShader node;
    node.base_color = Color{0.8f, 0.4f, 0.2f};
    node.metallic = metallic;
    node.roughness = roughness;
    node.transmission = transmission;
    node.alpha = alpha;
    return make_material(node);
  };
  const auto metallic = [](MetalModel model, float anisotropy, float film) {
    MetallicShader node;
    node.model = model;
    node.anisotropy = anisotropy;
    node.rotation = 0.15f;
    node.thin_film_thickness = film;
    return make_material(node);
  };
  const auto principled_hair = [](float roughness, float radial_roughness, float coat) {
    PrincipledHairShader node;
    node.color = Color{0.6f, 0.3f, 0.1f};
    node.roughness = roughness;
    node.radial_roughness = radial_roughness;
    node.coat = coat;
    return make_material(node);
  };
  const auto filmed_glass = [] {
    // Light that bounces between facets is added as that of glass without a film.
    GlassShader node{.roughness = 0.4f, .distribution = FacetDistribution::ggx};
    node.thin_film_thickness = 500;
    return make_material(node);
  };
  const auto layered = [](float transmission, float film) {
    PrincipledShader node;
    node.base_color = Color{0.8f, 0.4f, 0.2f};
    node.specular_tint = Color{0.9f, 0.3f, 0.5f};
    node.metallic = 0.3f;
    node.transmission = transmission;
    node.diffuse_roughness = 0.5f;
    node.anisotropic = 0.7f;
    node.anisotropic_rotation = 0.3f;
    node.sheen_weight = node.coat_weight = 0.7f;
    node.coat_roughness = 0.2f;
    node.coat_tint = Color{0.3f, 0.9f, 0.6f};
    node.thin_film_thickness = film;
    return make_material(node);
  };
  return {
      {"diffuse", make_material(DiffuseShader{Color{0.7f, 0.5f, 0.1f}, true})},
      {"glossy, roughness .1", make_material(GlossyShader{Color(0.9f), 0.1f})},
      {"glossy, roughness .5", make_material(GlossyShader{Color(0.9f), 0.5f})},
      {"glossy, roughness 1", make_material(GlossyShader{Color(0.9f), 1})},
      {"mirror", make_material(GlossyShader{Color(0.9f), 0})},
      {"conductor, Beckmann, alpha .1", conductor(0.1f, 0.1f, false)},
      {"conductor, Beckmann, alpha .5", conductor(0.5f, 0.5f, false)},
      {"conductor, Beckmann, alphas .05 and .4", conductor(0.05f, 0.4f, false)},
      {"conductor, GGX, alphas .05 and .4", conductor(0.05f, 0.4f, true)},
      {"refraction, smooth", make_material(RefractionShader{Color(1.0f), 1.5f, 0})},
      {"refraction, roughness .4", make_material(RefractionShader{Color(1.0f), 1.5f, 0.4f})},
      {"refraction, Beckmann, roughness .7, total reflection lost",
       make_material(RefractionShader{Color(1.0f), 1.5f, 0.7f, FacetDistribution::beckmann, false})},
      {"glass, smooth", make_material(GlassShader{Color(1.0f), Color(1.0f), 1.5f, 0})},
      {"glass, roughness .3", make_material(GlassShader{Color(1.0f), Color(1.0f), 1.5f, 0.3f})},
      {"glass, roughness .8, index 2, tinted",
       make_material(GlassShader{Color{0.9f, 0.5f, 0.1f}, Color{0.2f, 0.6f, 0.8f}, 2, 0.8f})},
      {"glass, Beckmann, roughness .5",
       make_material(GlassShader{Color(1.0f), Color(1.0f), 1.5f, 0.5f, FacetDistribution::beckmann})},
      {"glass, roughness .5, index .8", make_material(GlassShader{Color(1.0f), Color(1.0f), 0.8f, 0.5f})},
      {"principled, dielectric", principled(0, 0.5f, 0, 1)},
      {"principled, all of it", principled(0.3f, 0.4f, 0.5f, 0.7f)},
      {"diffuse, roughness .4", make_material(DiffuseShader{Color{0.7f, 0.5f, 0.1f}, true, 0.4f})},
      {"diffuse, roughness 1", make_material(DiffuseShader{Color{0.9f, 0.5f, 0.1f}, true, 1})},
      {"translucent", make_material(TranslucentShader{Color{0.7f, 0.5f, 0.1f}})},
      {"sheen, roughness .25", make_material(SheenShader{Color(0.9f), 0.25f})},
      {"sheen, roughness .8", make_material(SheenShader{Color(0.9f), 0.8f})},
      {"sheen, Ashikhmin", make_material(SheenShader{Color(0.9f), 0.6f, SheenModel::ashikhmin})},
      {"toon, diffuse", make_material(ToonShader{Color(0.9f), ToonComponent::diffuse, 0.4f, 0.3f})},
      {"toon, glossy", make_material(ToonShader{Color(0.9f), ToonComponent::glossy, 0.2f, 0.1f})},
      {"glossy, Ashikhmin and Shirley",
       make_material(GlossyShader{Color(0.9f), 0.5f, FacetDistribution::ashikhmin_shirley})},
      {"glossy, Ashikhmin and Shirley, stretched",
       make_material(GlossyShader{Color(0.9f), 0.6f, FacetDistribution::ashikhmin_shirley, 0.5f, 0.2f})},
      {"glossy, stretched", make_material(GlossyShader{Color(0.9f), 0.5f, FacetDistribution::multi_ggx, -0.6f, 0.1f})},
      {"metallic, stretched", metallic(MetalModel::f82, 0.8f, 0)},
      {"metallic, filmed", metallic(MetalModel::f82, 0, 420)},
      {"metallic, measured and filmed", metallic(MetalModel::physical_conductor, 0.3f, 300)},
      {"glass, filmed", filmed_glass()},
      {"principled, layered", layered(0, 0)},
      {"principled, layered and filmed", layered(0.5f, 350)},
      {"hair, reflection", make_material(HairShader{HairComponent::reflection, Color(0.9f), 0.2f, 0.4f, 0.5f})},
      {"hair, transmission", make_material(HairShader{HairComponent::transmission, Color(0.9f), 0.1f, 0.3f, 0.6f})},
      {"principled hair, brown", principled_hair(0.3f, 0.3f, 0)},
      {"principled hair, coated", principled_hair(0.6f, 0.5f, 0.4f)},
      {"diffuse and mirror", make_mix(0.4f, DiffuseShader{Color(0.5f), true}, GlossyShader{Color(0.9f), 0})},
      {"diffuse and glass",
       make_mix(0.7f, DiffuseShader{Color(0.5f), true}, GlassShader{Color(1.0f), Color(1.0f), 1.5f, 0.5f})},
      {"transparent and glossy", make_mix(0.5f, TransparentShader{Color(0.5f)}, GlossyShader{Color(0.9f), 0.4f})},
  };
}

// The mean of sample weights: the share of a white sky's light that comes back.
inline Vec3d directional_albedo(const Bsdf& bsdf, Vec3f wo, int count = 200000, std::uint64_t seed = 1) {
  Rng rng(seed);
  Vec3d sum(0.0);
  for (int i = 0; i < count; ++i) {
    const float choice = next_unit_float(rng);
    if (const auto sample = bsdf.sample(wo, choice, next_unit_vec2(rng))) sum += Vec3d(sample->weight);
  }
  return sum * (1.0 / count);
}

}  // namespace basicrt::test
