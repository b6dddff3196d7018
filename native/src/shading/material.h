// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is made of: a small graph of described shader nodes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/describe.h"
#include "base/id.h"
#include "math/color.h"
#include "shading/aov.h"
#include "shading/inputs.h"
#include "shading/operation.h"

namespace basicrt {

// The index of a node in Material::nodes.
using NodeIndex = std::uint32_t;
inline constexpr NodeIndex no_node = ~0u;

// How a rough surface's facets are turned. Multiscatter GGX also keeps the light that bounces between them, as Blender's
// nodes do by default; the others lose it. Ashikhmin and Shirley's is for the glossy node; others take it for GGX.
enum class FacetDistribution : std::uint8_t { multi_ggx, ggx, beckmann, ashikhmin_shirley };
template <>
inline constexpr std::array enum_names<FacetDistribution> =
    std::to_array<std::string_view>({"multi_ggx", "ggx", "beckmann", "ashikhmin_shirley"});
inline constexpr std::string_view facet_distribution_doc = "how the microfacets are turned: multi_ggx, ggx or beckmann";
inline constexpr std::string_view normal_doc = "in world space, on the viewer's side; zero is the surface's own";

// Along what stretched microfacets lie: the way u grows, or around an axis of the object, through the middle of its box.
// Blender's nodes go around z where nothing is linked to their Tangent.
enum class TangentKind : std::uint8_t { uv, radial_x, radial_y, radial_z };
template <>
inline constexpr std::array enum_names<TangentKind> =
    std::to_array<std::string_view>({"uv", "radial_x", "radial_y", "radial_z"});
inline constexpr std::string_view tangent_doc =
    "what stretched microfacets lie along: uv, or around an axis of the object, radial_x, radial_y or radial_z";
inline constexpr std::string_view rotation_doc = "of that about the normal, in whole turns";
inline constexpr std::string_view film_thickness_doc = "of a thin film on it, nanometres; 0 is none";

[[nodiscard]] inline bool may_differ_from_zero(const NumberInput& input) {
  return input.is_varying() || input.constant != 0;
}

struct DiffuseShader {
  ColorInput color;
  bool is_two_sided = false;
  NumberInput roughness = 0.0f;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "diffuse";
  static constexpr auto fields() {
    return fields_of(
        field("color", &DiffuseShader::color, "reflectance", within(0, 1)),
        field("twosided", &DiffuseShader::is_two_sided, "whether the back reflects too"),
        field("normal", &DiffuseShader::normal, normal_doc),
        field("roughness", &DiffuseShader::roughness,
              "0 is Lambert's reflection, above that Oren and Nayar's, which keeps all light", within(0, 1)));
  }
};

// Blender's Glossy node: microfacets tinted by a colour, without Fresnel; a mirror where the roughness is 0.
struct GlossyShader {
  ColorInput color;
  NumberInput roughness = 0.5f;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  NumberInput anisotropy = 0.0f, rotation = 0.0f;
  TangentKind tangent = TangentKind::uv;
  ColorInput normal{Vec3f(0.0f)};

  [[nodiscard]] bool is_stretched() const { return may_differ_from_zero(anisotropy); }
  static constexpr std::string_view kind = "glossy";
  static constexpr auto fields() {
    return fields_of(field("color", &GlossyShader::color, "reflectance", within(0, 1)),
                     field("roughness", &GlossyShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
                     field("distribution", &GlossyShader::distribution,
                           "how the microfacets are turned: multi_ggx, ggx, beckmann or ashikhmin_shirley"),
                     field("normal", &GlossyShader::normal, normal_doc),
                     field("anisotropy", &GlossyShader::anisotropy,
                           "above 0 smoother along the tangent, below 0 across", within(-1, 1)),
                     field("rotation", &GlossyShader::rotation, rotation_doc),
                     field("tangent", &GlossyShader::tangent, tangent_doc));
  }
};

// A conductor with measured indices, microfacets by Beckmann as in the assignment's format, or GGX.
struct ConductorShader {
  ColorInput color{Color(1.0f)};
  float alpha_x = 0.1f, alpha_y = 0.1f;
  Color eta_outside{1.0f}, eta{0.200438f, 0.924033f, 1.10221f}, k{3.91295f, 2.45285f, 2.14219f};
  bool is_ggx = false;

  [[nodiscard]] bool is_stretched() const { return alpha_x != alpha_y; }
  static constexpr std::string_view kind = "roughconductor";
  static constexpr auto fields() {
    return fields_of(field("reflectance", &ConductorShader::color, "multiplies the Fresnel reflectance", within(0, 1)),
                     field("alpha_x", &ConductorShader::alpha_x, "width of the microfacets along u", within(0, 1)),
                     field("alpha_y", &ConductorShader::alpha_y, "width of the microfacets along v", within(0, 1)),
                     field("etaI", &ConductorShader::eta_outside, "refractive index outside", above(0)),
                     field("etaT", &ConductorShader::eta, "refractive index of the metal", at_least(0)),
                     field("k", &ConductorShader::k, "extinction of the metal", at_least(0)),
                     field("ggx", &ConductorShader::is_ggx, "GGX microfacets instead of Beckmann's"));
  }
};

// Blender's Metallic node: by two colours, or by measured indices.
enum class MetalModel : std::uint8_t { f82, physical_conductor };
template <>
inline constexpr std::array enum_names<MetalModel> = std::to_array<std::string_view>({"f82", "physical_conductor"});

struct MetallicShader {
  MetalModel model = MetalModel::f82;
  ColorInput base_color{Color{0.617f, 0.577f, 0.54f}}, edge_tint{Color{0.695f, 0.726f, 0.77f}};
  ColorInput ior{Vec3f(2.757f, 2.513f, 2.231f)}, extinction{Vec3f(3.867f, 3.404f, 3.009f)};
  NumberInput roughness = 0.5f;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  NumberInput anisotropy = 0.0f, rotation = 0.0f;
  TangentKind tangent = TangentKind::uv;
  NumberInput thin_film_thickness = 0.0f, thin_film_ior = 1.33f;
  ColorInput normal{Vec3f(0.0f)};

  [[nodiscard]] bool is_stretched() const { return may_differ_from_zero(anisotropy); }
  static constexpr std::string_view kind = "metallic";
  static constexpr auto fields() {
    using M = MetallicShader;
    return fields_of(
        field("model", &M::model, "f82: by base_color and edge_tint; physical_conductor: by ior and extinction"),
        field("base_color", &M::base_color, "reflectance where it is met head on", within(0, 1)),
        field("edge_tint", &M::edge_tint, "multiplies the reflectance near grazing incidence", within(0, 1)),
        field("ior", &M::ior, "refractive index of the metal", at_least(0)),
        field("extinction", &M::extinction, "of the metal", at_least(0)),
        field("roughness", &M::roughness, "the microfacets' alpha is its square", within(0, 1)),
        field("distribution", &M::distribution, facet_distribution_doc),
        field("anisotropy", &M::anisotropy, "above 0 smoother across the tangent", within(0, 1)),
        field("rotation", &M::rotation, rotation_doc), field("tangent", &M::tangent, tangent_doc),
        field("normal", &M::normal, normal_doc),
        field("thin_film_thickness", &M::thin_film_thickness, film_thickness_doc, at_least(0)),
        field("thin_film_ior", &M::thin_film_ior, "refractive index of the film", above(0)));
  }
};

// All light is refracted, or, past the critical angle, mirrored: no Fresnel reflection. Facets lose what bounces between
// them whatever the distribution.
struct RefractionShader {
  ColorInput color{Color(1.0f)};
  NumberInput ior = 1.5f;
  NumberInput roughness = 0.0f;
  FacetDistribution distribution = FacetDistribution::ggx;
  bool is_total_reflection_kept = true;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "refraction";
  static constexpr auto fields() {
    return fields_of(
        field("color", &RefractionShader::color, "tint of the refracted light", within(0, 1)),
        field("eta", &RefractionShader::ior, "refractive index inside over outside", above(0)),
        field("roughness", &RefractionShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
        field("distribution", &RefractionShader::distribution, facet_distribution_doc),
        field("total_reflection", &RefractionShader::is_total_reflection_kept,
              "mirror light past the critical angle, or lose it as Blender does"),
        field("normal", &RefractionShader::normal, normal_doc));
  }
};

// Fresnel reflection and refraction, by microfacets where rough.
struct GlassShader {
  ColorInput reflect_color{Color(1.0f)}, transmit_color{Color(1.0f)};
  NumberInput ior = 1.5f;
  NumberInput roughness = 0.0f;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  NumberInput thin_film_thickness = 0.0f, thin_film_ior = 1.33f;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "glass";
  static constexpr auto fields() {
    return fields_of(field("R", &GlassShader::reflect_color, "tint of the reflected light", within(0, 1)),
                     field("T", &GlassShader::transmit_color, "tint of the refracted light", within(0, 1)),
                     field("eta", &GlassShader::ior, "refractive index inside over outside", above(0)),
                     field("roughness", &GlassShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
                     field("distribution", &GlassShader::distribution, facet_distribution_doc),
                     field("normal", &GlassShader::normal, normal_doc),
                     field("thin_film_thickness", &GlassShader::thin_film_thickness, film_thickness_doc, at_least(0)),
                     field("thin_film_ior", &GlassShader::thin_film_ior, "refractive index of the film", above(0)));
  }
};

struct TransparentShader {
  ColorInput color{Color(1.0f)};
  static constexpr std::string_view kind = "transparent";
  static constexpr auto fields() {
    return fields_of(field("color", &TransparentShader::color, "what passes straight through", within(0, 1)));
  }
};

struct TranslucentShader {
  ColorInput color;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "translucent";
  static constexpr auto fields() {
    return fields_of(field("color", &TranslucentShader::color, "what goes through, spread evenly", within(0, 1)),
                     field("normal", &TranslucentShader::normal, normal_doc));
  }
};

// Microfibres as simulated by Zeltner et al. 2022, or Ashikhmin's upright microfacets.
enum class SheenModel : std::uint8_t { microfiber, ashikhmin };
template <>
inline constexpr std::array enum_names<SheenModel> = std::to_array<std::string_view>({"microfiber", "ashikhmin"});

struct SheenShader {
  ColorInput color;
  NumberInput roughness = 0.5f;
  SheenModel model = SheenModel::microfiber;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "sheen";
  static constexpr auto fields() {
    return fields_of(field("color", &SheenShader::color, "tint", within(0, 1)),
                     field("roughness", &SheenShader::roughness, "how far from grazing it is seen", within(0, 1)),
                     field("model", &SheenShader::model, "microfiber or ashikhmin"),
                     field("normal", &SheenShader::normal, normal_doc));
  }
};

enum class ToonComponent : std::uint8_t { diffuse, glossy };
template <>
inline constexpr std::array enum_names<ToonComponent> = std::to_array<std::string_view>({"diffuse", "glossy"});

// A spot around the normal or the mirrored view.
struct ToonShader {
  ColorInput color;
  ToonComponent component = ToonComponent::diffuse;
  NumberInput size = 0.5f, smooth = 0.0f;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "toon";
  static constexpr auto fields() {
    return fields_of(field("color", &ToonShader::color, "tint", within(0, 1)),
                     field("component", &ToonShader::component, "diffuse: around the normal; glossy: the reflection"),
                     field("size", &ToonShader::size, "of the spot, in right angles", within(0, 1)),
                     field("smooth", &ToonShader::smooth, "width of the soft rim, in right angles", within(0, 1)),
                     field("normal", &ToonShader::normal, normal_doc));
  }
};

struct EmissionShader {
  ColorInput radiance{Color(1.0f)};
  bool is_two_sided = true;
  NumberInput strength = 1.0f;
  static constexpr std::string_view kind = "emission";
  static constexpr auto fields() {
    return fields_of(field("radiance", &EmissionShader::radiance, "W / (m^2 sr), each direction alike", at_least(0)),
                     field("twosided", &EmissionShader::is_two_sided, "whether the back emits too"),
                     field("strength", &EmissionShader::strength, "multiplies the radiance", at_least(0)));
  }
};

// A hole in the picture for what the camera sees, black for all else.
struct HoldoutShader {
  static constexpr std::string_view kind = "holdout";
  static constexpr auto fields() { return fields_of(); }
};

// How the look of a body that light goes about in becomes the paths of that light, by a random walk. chiang: colour and
// radius as Chiang, Kutz and Burley 2016 have them, the radius 4 pi mean free paths; skin: the same, but the radius is that of
// diffusion, and half of the light enters diffusely; van_de_hulst: the radius is the mean free path.
enum class SubsurfaceModel : std::uint8_t { chiang, skin, van_de_hulst };
template <>
inline constexpr std::array enum_names<SubsurfaceModel> =
    std::to_array<std::string_view>({"chiang", "skin", "van_de_hulst"});
inline constexpr std::string_view subsurface_model_doc =
    "what the radius means: chiang, as of Blender's Random Walk before 5.2, skin, or van_de_hulst, as of the one since";
inline constexpr std::string_view subsurface_radius_doc = "how far light of each colour goes, metres times the scale";

// Light that enters the surface, goes about beneath it and leaves it diffusely elsewhere.
struct SubsurfaceShader {
  ColorInput color{Color(0.8f)};
  ColorInput radius{Vec3f(1.0f, 0.2f, 0.1f)};
  NumberInput scale = 0.05f, ior = 1.4f, alpha = 1.0f, anisotropy = 0.0f;
  SubsurfaceModel model = SubsurfaceModel::chiang;
  ColorInput normal{Vec3f(0.0f)};
  static constexpr std::string_view kind = "subsurface";
  static constexpr auto fields() {
    using S = SubsurfaceShader;
    return fields_of(
        field("color", &S::color, "of the light that comes back from a thick body", within(0, 1)),
        field("radius", &S::radius, subsurface_radius_doc, at_least(0)),
        field("scale", &S::scale, "multiplies the radius", at_least(0)),
        field("ior", &S::ior, "refractive index by which light enters", above(0)),
        field("alpha", &S::alpha, "of the microfacets by which light enters", within(0, 1)),
        field("anisotropy", &S::anisotropy, "above 0 light is scattered forwards, below 0 backwards", within(-1, 1)),
        field("model", &S::model, subsurface_model_doc), field("normal", &S::normal, normal_doc));
  }
};

// Blender's Principled BSDF but for thin walls.
struct PrincipledShader {
  ColorInput base_color;
  NumberInput metallic = 0.0f, roughness = 0.5f, ior = 1.5f, transmission = 0.0f, specular_ior_level = 0.5f;
  ColorInput emission{Color(0.0f)};
  NumberInput emission_strength = 1.0f;
  NumberInput alpha = 1.0f;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  NumberInput diffuse_roughness = 0.0f;
  ColorInput specular_tint{Color(1.0f)};
  NumberInput anisotropic = 0.0f, anisotropic_rotation = 0.0f;
  TangentKind tangent = TangentKind::uv;
  NumberInput sheen_weight = 0.0f, sheen_roughness = 0.5f;
  ColorInput sheen_tint{Color(1.0f)};
  NumberInput coat_weight = 0.0f, coat_roughness = 0.03f, coat_ior = 1.5f;
  ColorInput coat_tint{Color(1.0f)};
  NumberInput thin_film_thickness = 0.0f, thin_film_ior = 1.33f;
  ColorInput normal{Vec3f(0.0f)}, coat_normal{Vec3f(0.0f)};
  NumberInput subsurface_weight = 0.0f;
  ColorInput subsurface_radius{Vec3f(1.0f, 0.2f, 0.1f)};
  NumberInput subsurface_scale = 0.05f, subsurface_ior = 1.4f, subsurface_anisotropy = 0.0f;
  SubsurfaceModel subsurface_model = SubsurfaceModel::chiang;

  [[nodiscard]] bool is_stretched() const { return may_differ_from_zero(anisotropic); }
  static constexpr std::string_view kind = "principled";
  static constexpr auto fields() {
    return fields_of(
        field("base_color", &PrincipledShader::base_color, "reflectance of diffuse and metal, tint of glass",
              within(0, 1)),
        field("metallic", &PrincipledShader::metallic, "0 a dielectric, 1 a metal", within(0, 1)),
        field("roughness", &PrincipledShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
        field("ior", &PrincipledShader::ior, "refractive index", at_least(1)),
        field("transmission", &PrincipledShader::transmission, "how much of the dielectric is glass", within(0, 1)),
        field("specular_ior_level", &PrincipledShader::specular_ior_level,
              "0.5 leaves the index's reflectance as it is", within(0, 1)),
        field("emission", &PrincipledShader::emission, "W / (m^2 sr), both sides", at_least(0)),
        field("emission_strength", &PrincipledShader::emission_strength, "multiplies the emission", at_least(0)),
        field("alpha", &PrincipledShader::alpha, "opacity", within(0, 1)),
        field("distribution", &PrincipledShader::distribution, facet_distribution_doc),
        field("normal", &PrincipledShader::normal, normal_doc),
        field("diffuse_roughness", &PrincipledShader::diffuse_roughness, "as of the diffuse shader", within(0, 1)),
        field("specular_tint", &PrincipledShader::specular_tint,
              "of a dielectric's reflection where it is met head on, of a metal's near grazing incidence",
              within(0, 1)),
        field("anisotropic", &PrincipledShader::anisotropic, "above 0 smoother across the tangent", within(0, 1)),
        field("anisotropic_rotation", &PrincipledShader::anisotropic_rotation, rotation_doc),
        field("tangent", &PrincipledShader::tangent, tangent_doc),
        field("sheen_weight", &PrincipledShader::sheen_weight, "of the fibres on top of all", within(0, 1)),
        field("sheen_roughness", &PrincipledShader::sheen_roughness, "as of the sheen shader", within(0, 1)),
        field("sheen_tint", &PrincipledShader::sheen_tint, "colour of the fibres", within(0, 1)),
        field("coat_weight", &PrincipledShader::coat_weight, "of the clear coat beneath the sheen", within(0, 1)),
        field("coat_roughness", &PrincipledShader::coat_roughness, "of the coat", within(0, 1)),
        field("coat_ior", &PrincipledShader::coat_ior, "refractive index of the coat", at_least(1)),
        field("coat_tint", &PrincipledShader::coat_tint, "what the coat lets through of light from straight above",
              within(0, 1)),
        field("coat_normal", &PrincipledShader::coat_normal, normal_doc),
        field("thin_film_thickness", &PrincipledShader::thin_film_thickness, film_thickness_doc, at_least(0)),
        field("thin_film_ior", &PrincipledShader::thin_film_ior, "refractive index of the film", above(0)),
        field("subsurface_weight", &PrincipledShader::subsurface_weight,
              "how much of the diffuse light goes about beneath the surface", within(0, 1)),
        field("subsurface_radius", &PrincipledShader::subsurface_radius, subsurface_radius_doc, at_least(0)),
        field("subsurface_scale", &PrincipledShader::subsurface_scale, "multiplies the radius", at_least(0)),
        field("subsurface_ior", &PrincipledShader::subsurface_ior,
              "skin: refractive index by which light enters; other models have the surface's", above(0)),
        field("subsurface_anisotropy", &PrincipledShader::subsurface_anisotropy,
              "above 0 light is scattered forwards, below 0 backwards", within(-1, 1)),
        field("subsurface_model", &PrincipledShader::subsurface_model, subsurface_model_doc));
  }
};

// How a volume turns light. Mie is the approximation of Jendersie and d'Eon 2023 by the diameter of water droplets.
enum class PhaseKind : std::uint8_t { henyey_greenstein, rayleigh, draine, fournier_forand, mie };
template <>
inline constexpr std::array enum_names<PhaseKind> =
    std::to_array<std::string_view>({"henyey_greenstein", "rayleigh", "draine", "fournier_forand", "mie"});

// A volume that is the same everywhere, by its coefficients.
struct VolumeShader {
  Color absorption{0.0f}, scattering{0.0f}, emission{0.0f};
  PhaseKind phase = PhaseKind::henyey_greenstein;
  float anisotropy = 0, alpha = 0.5f, ior = 1.33f, backscatter = 0.1f, diameter = 20;
  static constexpr std::string_view kind = "volume";
  static constexpr auto fields() {
    using V = VolumeShader;
    return fields_of(
        field("absorption", &V::absorption, "share of the light that each metre takes away, 1 / m", at_least(0)),
        field("scattering", &V::scattering, "share of the light that each metre scatters, 1 / m", at_least(0)),
        field("emission", &V::emission, "radiance that each metre adds, W / (m^3 sr)", at_least(0)),
        field("phase", &V::phase,
              "how scattered light turns: henyey_greenstein, rayleigh, draine, fournier_forand or mie"),
        field("anisotropy", &V::anisotropy, "henyey_greenstein, draine: above 0 forwards, below 0 backwards",
              within(-1, 1)),
        field("alpha", &V::alpha, "draine: 0 is henyey_greenstein, 1 with anisotropy 0 is rayleigh", at_least(0)),
        field("ior", &V::ior, "fournier_forand: refractive index of the particles", above(1)),
        field("backscatter", &V::backscatter, "fournier_forand: share of the light that is scattered backwards",
              within(0, 0.5)),
        field("diameter", &V::diameter, "mie: of the droplets, micrometres", within(0, 50)));
  }
};

// Blender's Principled Hair node, of Chiang's model. Of curves, or of fibres that run along u.
enum class HairParametrization : std::uint8_t { melanin, color, absorption };
template <>
inline constexpr std::array enum_names<HairParametrization> =
    std::to_array<std::string_view>({"melanin", "color", "absorption"});

struct PrincipledHairShader {
  HairParametrization parametrization = HairParametrization::color;
  ColorInput color{Color{0.017513f, 0.005763f, 0.002059f}};
  NumberInput melanin = 0.8f, melanin_redness = 1.0f;
  ColorInput tint{Color(1.0f)};
  ColorInput absorption{Color{0.245531f, 0.52f, 1.365f}};
  NumberInput roughness = 0.3f, radial_roughness = 0.3f, coat = 0.0f, ior = 1.55f, offset = 0.0349066f;
  NumberInput random_color = 0.0f, random_roughness = 0.0f, random = 0.0f;

  [[nodiscard]] bool is_stretched() const { return true; }
  static constexpr std::string_view kind = "principled_hair";
  static constexpr auto fields() {
    using H = PrincipledHairShader;
    return fields_of(
        field("parametrization", &H::parametrization, "which of the next few count: melanin, color or absorption"),
        field("color", &H::color, "of much hair, seen from afar", within(0, 1)),
        field("melanin", &H::melanin, "how dark natural hair is", within(0, 1)),
        field("melanin_redness", &H::melanin_redness, "how red", within(0, 1)),
        field("tint", &H::tint, "that melanin is dyed with", within(0, 1)),
        field("absorption", &H::absorption, "per radius of the fibre", at_least(0)),
        field("roughness", &H::roughness, "along the fibre", within(0, 1)),
        field("radial_roughness", &H::radial_roughness, "around it", within(0, 1)),
        field("coat", &H::coat, "how much smoother the first reflection is", within(0, 1)),
        field("ior", &H::ior, "refractive index of the fibre", at_least(1)),
        field("offset", &H::offset, "how far the scales are tilted, radians", within(-1.5707964, 1.5707964)),
        field("random_color", &H::random_color, "how much melanin varies", within(0, 1)),
        field("random_roughness", &H::random_roughness, "how much both roughnesses vary", within(0, 1)),
        field("random", &H::random, "what they vary with: from 0 to 1", within(0, 1)));
  }
};

// Blender's Hair node.
enum class HairComponent : std::uint8_t { reflection, transmission };
template <>
inline constexpr std::array enum_names<HairComponent> = std::to_array<std::string_view>({"reflection", "transmission"});

struct HairShader {
  HairComponent component = HairComponent::reflection;
  ColorInput color;
  NumberInput offset = 0.0f, roughness_u = 0.1f, roughness_v = 1.0f;
  NumberInput is_on_curve = 1.0f;

  [[nodiscard]] bool is_stretched() const { return true; }
  static constexpr std::string_view kind = "hair";
  static constexpr auto fields() {
    using H = HairShader;
    return fields_of(
        field("component", &H::component, "reflection or transmission"),
        field("color", &H::color, "reflectance", within(0, 1)),
        field("offset", &H::offset, "how far the highlight moves along the fibre, radians",
              within(-1.5707964, 1.5707964)),
        field("roughness_u", &H::roughness_u, "along the fibre", within(0, 1)),
        field("roughness_v", &H::roughness_v, "around it", within(0, 1)),
        field("on_curve", &H::is_on_curve, "1: fibres run along u; 0: along v, without an offset", within(0, 1)));
  }
};

struct MixShader {
  NumberInput factor = 0.5f;
  NodeIndex first = no_node, second = no_node;
  static constexpr std::string_view kind = "mix";
  static constexpr auto fields() {
    return fields_of(field("factor", &MixShader::factor, "0 is all the first, 1 all the second", within(0, 1)),
                     field("first", &MixShader::first, "a node made before this one"),
                     field("second", &MixShader::second, "a node made before this one"));
  }
};

struct AddShader {
  NodeIndex first = no_node, second = no_node;
  static constexpr std::string_view kind = "add";
  static constexpr auto fields() {
    return fields_of(field("first", &AddShader::first, "a node made before this one"),
                     field("second", &AddShader::second, "a node made before this one"));
  }
};

// Shows nothing, and need not be referred to: it writes the passes AOV Color and AOV Value of its number.
struct AovShader {
  int number = 1;
  ColorInput color{Color(0.0f)};
  NumberInput value = 0.0f;
  static constexpr std::string_view kind = "aov";
  static constexpr auto fields() {
    return fields_of(field("number", &AovShader::number, "of the passes AOV Color and AOV Value", within(1, aovs)),
                     field("color", &AovShader::color, "in the pass AOV Color"),
                     field("value", &AovShader::value, "in the pass AOV Value"));
  }
};

// Shows nothing, and need not be referred to: it moves the vertices of meshes. Several of them add up.
struct DisplacementShader {
  ColorInput offset{Color(0.0f)};
  bool keeps_normals = false;
  static constexpr std::string_view kind = "displacement";
  static constexpr auto fields() {
    return fields_of(field("offset", &DisplacementShader::offset, "by how much a vertex is moved, world space, metres"),
                     field("keep_normals", &DisplacementShader::keeps_normals,
                           "the surface is shaded with the normals that it had; else with those of the new one"));
  }
};

using ShaderNode = std::variant<DiffuseShader, GlossyShader, ConductorShader, RefractionShader, GlassShader,
                                TransparentShader, EmissionShader, HoldoutShader, PrincipledShader, VolumeShader,
                                MixShader, AddShader, TranslucentShader, MetallicShader, SheenShader, ToonShader,
                                SubsurfaceShader, PrincipledHairShader, HairShader, AovShader, DisplacementShader>;

// A node refers only to nodes before it, so there is no cycle. A Mix or Add input of no_node is black and opaque,
// as an empty socket is in Blender.
struct Material {
  std::string name;
  std::vector<ShaderNode> nodes;
  std::vector<Operation> operations;  // each refers only to those before it
  NodeIndex surface = no_node;        // none: black, opaque; with a volume nothing but the volume's boundary
  NodeIndex volume = no_node;         // what fills the shape: of VolumeShader and EmissionShader nodes, mixed and added
  int pass_index = 0;                 // for operations that ask, and for the pass Material Index

  OperationIndex add(Operation operation) {
    operations.push_back(std::move(operation));
    return {static_cast<std::uint32_t>(operations.size() - 1)};
  }
  NodeIndex add(ShaderNode node) {
    nodes.push_back(std::move(node));
    return static_cast<NodeIndex>(nodes.size() - 1);
  }
};

}  // namespace basicrt
