// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is made of: a small graph of described shader nodes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "base/describe.h"
#include "base/id.h"
#include "math/color.h"
#include "shading/texture.h"

namespace basicrt {

// A colour that may vary over the surface: the texture where there is one, else the constant.
struct ColorInput {
  Color constant{0.8f};
  Id<Texture> texture{};

  ColorInput() = default;
  ColorInput(Color c) : constant(c) {}  // NOLINT: a colour is a colour input
};

template <class Visitor>
constexpr void for_each_number(const ColorInput& input, Visitor&& visit) {
  for_each_number(input.constant, visit);
}

// A number in [0, 1] that may vary over the surface: a texture's luminance or alpha, or the constant.
struct ShareInput {
  float constant = 1;
  Id<Texture> texture{};
  bool is_alpha = false;

  ShareInput() = default;
  ShareInput(float share) : constant(share) {}  // NOLINT: a number is an input
};

template <class Visitor>
constexpr void for_each_number(const ShareInput& input, Visitor&& visit) {
  visit(input.constant);
}

// The index of a node in Material::nodes.
using NodeIndex = std::uint32_t;
inline constexpr NodeIndex no_node = ~0u;

// How a rough surface's facets are turned. Multiscatter GGX also keeps the light that bounces between them, as Blender's
// nodes do by default; the others lose it.
enum class FacetDistribution : std::uint8_t { multi_ggx, ggx, beckmann };
template <>
inline constexpr std::array enum_names<FacetDistribution> =
    std::to_array<std::string_view>({"multi_ggx", "ggx", "beckmann"});
inline constexpr std::string_view facet_distribution_doc = "how the microfacets are turned: multi_ggx, ggx or beckmann";

struct DiffuseShader {
  ColorInput color;
  bool is_two_sided = false;
  static constexpr std::string_view kind = "diffuse";
  static constexpr auto fields() {
    return std::tuple{field("color", &DiffuseShader::color, "reflectance", within(0, 1)),
                      field("twosided", &DiffuseShader::is_two_sided, "whether the back reflects too")};
  }
};

// Blender's Glossy node: microfacets tinted by a colour, without Fresnel; a mirror where the roughness is 0.
struct GlossyShader {
  ColorInput color;
  float roughness = 0.5f;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  static constexpr std::string_view kind = "glossy";
  static constexpr auto fields() {
    return std::tuple{
        field("color", &GlossyShader::color, "reflectance", within(0, 1)),
        field("roughness", &GlossyShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
        field("distribution", &GlossyShader::distribution, facet_distribution_doc)};
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
    return std::tuple{field("reflectance", &ConductorShader::color, "multiplies the Fresnel reflectance", within(0, 1)),
                      field("alpha_x", &ConductorShader::alpha_x, "width of the microfacets along u", within(0, 1)),
                      field("alpha_y", &ConductorShader::alpha_y, "width of the microfacets along v", within(0, 1)),
                      field("etaI", &ConductorShader::eta_outside, "refractive index outside", above(0)),
                      field("etaT", &ConductorShader::eta, "refractive index of the metal", at_least(0)),
                      field("k", &ConductorShader::k, "extinction of the metal", at_least(0)),
                      field("ggx", &ConductorShader::is_ggx, "GGX microfacets instead of Beckmann's")};
  }
};

// All light is refracted, or, past the critical angle, mirrored: no Fresnel reflection. Facets lose what bounces between
// them whatever the distribution.
struct RefractionShader {
  ColorInput color{Color(1.0f)};
  float ior = 1.5f;
  float roughness = 0;
  FacetDistribution distribution = FacetDistribution::ggx;
  bool is_total_reflection_kept = true;
  static constexpr std::string_view kind = "refraction";
  static constexpr auto fields() {
    return std::tuple{
        field("color", &RefractionShader::color, "tint of the refracted light", within(0, 1)),
        field("eta", &RefractionShader::ior, "refractive index inside over outside", above(0)),
        field("roughness", &RefractionShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
        field("distribution", &RefractionShader::distribution, facet_distribution_doc),
        field("total_reflection", &RefractionShader::is_total_reflection_kept,
              "mirror light past the critical angle, or lose it as Blender does")};
  }
};

// Fresnel reflection and refraction, by microfacets where rough.
struct GlassShader {
  ColorInput reflect_color{Color(1.0f)}, transmit_color{Color(1.0f)};
  float ior = 1.5f;
  float roughness = 0;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  static constexpr std::string_view kind = "glass";
  static constexpr auto fields() {
    return std::tuple{field("R", &GlassShader::reflect_color, "tint of the reflected light", within(0, 1)),
                      field("T", &GlassShader::transmit_color, "tint of the refracted light", within(0, 1)),
                      field("eta", &GlassShader::ior, "refractive index inside over outside", above(0)),
                      field("roughness", &GlassShader::roughness, "the microfacets' alpha is its square", within(0, 1)),
                      field("distribution", &GlassShader::distribution, facet_distribution_doc)};
  }
};

struct TransparentShader {
  ColorInput color{Color(1.0f)};
  static constexpr std::string_view kind = "transparent";
  static constexpr auto fields() {
    return std::tuple{field("color", &TransparentShader::color, "what passes straight through", within(0, 1))};
  }
};

struct EmissionShader {
  ColorInput radiance{Color(1.0f)};
  bool is_two_sided = true;
  float strength = 1;
  static constexpr std::string_view kind = "emission";
  static constexpr auto fields() {
    return std::tuple{field("radiance", &EmissionShader::radiance, "W / (m^2 sr), each direction alike", at_least(0)),
                      field("twosided", &EmissionShader::is_two_sided, "whether the back emits too"),
                      field("strength", &EmissionShader::strength, "multiplies the radiance", at_least(0))};
  }
};

// A hole in the picture for what the camera sees, black for all else.
struct HoldoutShader {
  static constexpr std::string_view kind = "holdout";
  static constexpr auto fields() { return std::tuple{}; }
};

// Blender's Principled BSDF with constant values: the sockets that change an ordinary opaque, metal or glass surface.
struct PrincipledShader {
  ColorInput base_color;
  float metallic = 0, roughness = 0.5f, ior = 1.5f, transmission = 0, specular_ior_level = 0.5f;
  ColorInput emission{Color(0.0f)};
  float emission_strength = 1;
  ShareInput alpha = 1.0f;
  FacetDistribution distribution = FacetDistribution::multi_ggx;
  static constexpr std::string_view kind = "principled";
  static constexpr auto fields() {
    return std::tuple{
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
        field("distribution", &PrincipledShader::distribution, facet_distribution_doc)};
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
    return std::tuple{
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
        field("diameter", &V::diameter, "mie: of the droplets, micrometres", within(0, 50))};
  }
};

struct MixShader {
  ShareInput factor = 0.5f;
  NodeIndex first = no_node, second = no_node;
  static constexpr std::string_view kind = "mix";
  static constexpr auto fields() {
    return std::tuple{field("factor", &MixShader::factor, "0 is all the first, 1 all the second", within(0, 1)),
                      field("first", &MixShader::first, "a node made before this one"),
                      field("second", &MixShader::second, "a node made before this one")};
  }
};

struct AddShader {
  NodeIndex first = no_node, second = no_node;
  static constexpr std::string_view kind = "add";
  static constexpr auto fields() {
    return std::tuple{field("first", &AddShader::first, "a node made before this one"),
                      field("second", &AddShader::second, "a node made before this one")};
  }
};

using ShaderNode =
    std::variant<DiffuseShader, GlossyShader, ConductorShader, RefractionShader, GlassShader, TransparentShader,
                 EmissionShader, HoldoutShader, PrincipledShader, VolumeShader, MixShader, AddShader>;

// A node refers only to nodes before it, so there is no cycle. A Mix or Add input of no_node is black and opaque,
// as an empty socket is in Blender.
struct Material {
  std::string name;
  std::vector<ShaderNode> nodes;
  NodeIndex surface = no_node;  // none: black, opaque; with a volume nothing but the volume's boundary
  NodeIndex volume = no_node;   // what fills the shape: of VolumeShader and EmissionShader nodes, mixed and added
  int pass_index = 0;           // the pass Material Index

  NodeIndex add(ShaderNode node) {
    nodes.push_back(std::move(node));
    return static_cast<NodeIndex>(nodes.size() - 1);
  }
};

}  // namespace basicrt
