// SPDX-License-Identifier: GPL-3.0-or-later
// What only some of Blender's lobes have: energy that must come back, layers, stretching, films.
#include <gtest/gtest.h>

#include <complex>

#include "bsdf/fixtures.h"
#include "bsdf/thin_film.h"

namespace basicrt {
namespace {

using test::direction_at;

double albedo_of(const ShaderNode& node, float degrees, int count = 150000) {
  const Vec3f wo = direction_at(degrees);
  return test::directional_albedo(test::make_bsdf(test::make_material(node), test::make_point(), wo), wo, count).y;
}

TEST(OrenNayar, loses_no_light_of_a_white_surface) {
  for (const float roughness : {0.1f, 0.5f, 1.0f})
    for (const float degrees : {0.0f, 40.0f, 75.0f, 130.0f})
      EXPECT_NEAR(albedo_of(DiffuseShader{Color(1.0f), true, roughness}, degrees), 1, 0.004)
          << "roughness " << roughness << " from " << degrees << " degrees";
}

TEST(OrenNayar, is_lamberts_where_smooth) {
  const Vec3f wo = direction_at(50), wi = direction_at(65, 200);
  const OrenNayar smooth(Color(0.5f), 1e-5f, wo.z);
  EXPECT_NEAR(smooth.eval(wo, wi).value.x, Lambert{}.eval(wo, wi).value.x, 1e-5);
}

TEST(Translucent, sends_all_of_its_colour_behind) {
  EXPECT_NEAR(albedo_of(TranslucentShader{Color(0.6f)}, 40), 0.6, 1e-5);
  const Vec3f wo = direction_at(40);
  const Bsdf bsdf = test::make_bsdf(test::make_material(TranslucentShader{}), test::make_point(), wo);
  EXPECT_EQ(bsdf.eval(wo, direction_at(20)).value.x, 0);
  EXPECT_NEAR(bsdf.eval(wo, direction_at(160)).value.x, 0.8f * inv_pi * std::cos(20 * pi / 180), 1e-5);
}

TEST(Sheen, returns_the_share_of_its_layer) {
  for (const float roughness : {0.2f, 0.5f, 0.9f})
    for (const float degrees : {20.0f, 60.0f, 85.0f}) {
      const auto layer = make_sheen(roughness, direction_at(degrees));
      ASSERT_TRUE(layer);
      // Of the leaning lobe, next to nothing is below the surface.
      EXPECT_NEAR(albedo_of(SheenShader{Color(1.0f), roughness}, degrees), layer->albedo, 0.01 * layer->albedo);
    }
}

TEST(Sheen, is_brighter_towards_grazing_angles) {
  EXPECT_GT(make_sheen(0.4f, direction_at(80))->albedo, 3 * make_sheen(0.4f, direction_at(30))->albedo);
}

TEST(Toon, is_even_within_the_spot_and_black_outside) {
  const Vec3f wo = direction_at(30);
  const GlossyToon lobe(0.2f, 0);  // 18 degrees around the mirrored view
  const float inside = lobe.eval(wo, direction_at(35, 210)).value.x;
  EXPECT_GT(inside, 0);
  EXPECT_FLOAT_EQ(lobe.eval(wo, direction_at(20, 210)).value.x, inside);
  EXPECT_EQ(lobe.eval(wo, direction_at(50, 210)).value.x, 0);
  EXPECT_EQ(DiffuseToon(0.2f, 0).eval(wo, direction_at(20)).value.x, 0);
}

TEST(Turn, turns_a_lobe_with_its_tangent) {
  const float angle = 0.7f;
  const Microfacets plain{0.1f, 0.6f}, turned{0.1f, 0.6f, MicrofacetModel::ggx, Turn({1, 0, 0}, angle)};
  const auto rotate = [&](Vec3f w) {
    return Vec3f{std::cos(angle) * w.x - std::sin(angle) * w.y, std::sin(angle) * w.x + std::cos(angle) * w.y, w.z};
  };
  const Vec3f wo = direction_at(40, 10), wi = direction_at(55, 170);
  const LobeValue expected = MicrofacetReflection<NoFresnel>{plain, {}}.eval(wo, wi);
  const LobeValue found = MicrofacetReflection<NoFresnel>{turned, {}}.eval(rotate(wo), rotate(wi));
  EXPECT_NEAR(found.value.x, expected.value.x, 2e-3f * expected.value.x);
  EXPECT_NEAR(found.pdf, expected.pdf, 2e-3f * expected.pdf);
}

// The compensation is that of round facets with the same product of alphas, which lose less: .83 for .92 is left here.
TEST(Stretched, metal_keeps_most_of_its_light) {
  MetallicShader node;
  node.base_color = node.edge_tint = Color(1.0f);
  node.roughness = 0.5f;
  node.anisotropy = 0.8f;
  EXPECT_NEAR(albedo_of(node, 0), 0.8313 / 0.9158, 0.004);
}

TEST(F82, has_the_tint_at_82_degrees_and_its_mean) {
  const Color f0{0.9f, 0.6f, 0.3f}, tint{0.5f, 0.8f, 1};
  const F82Fresnel metal = make_f82(f0, tint);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(metal(1)[c], f0[c], 1e-6);
    EXPECT_NEAR(metal(1.0f / 7)[c], (fresnel_schlick(1.0f / 7, f0) * tint)[c], 1e-5);
  }
  Vec3d sum(0.0);
  constexpr int steps = 10000;
  for (int i = 0; i < steps; ++i) {
    const float mu = (static_cast<float>(i) + 0.5f) / steps;
    sum += Vec3d(metal(mu)) * (2.0 * mu / steps);
  }
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(metal.mean()[c], sum[c], 1e-3);
}

TEST(Principled, layers_keep_white_white) {
  PrincipledShader node;
  node.base_color = Color(1.0f);
  node.sheen_weight = node.coat_weight = 1;
  node.coat_roughness = 0.1f;
  node.diffuse_roughness = 0.6f;
  for (const float degrees : {0.0f, 50.0f, 75.0f})
    EXPECT_NEAR(albedo_of(node, degrees), 1, 0.01) << degrees << " degrees";
  node.metallic = 1;
  for (const float degrees : {0.0f, 50.0f, 75.0f})
    EXPECT_NEAR(albedo_of(node, degrees), 1, 0.015) << degrees << " degrees";
}

TEST(Principled, coat_tints_what_is_below_by_the_length_of_the_way) {
  PrincipledShader node;
  node.base_color = Color(1.0f);
  node.specular_ior_level = 0;
  node.coat_weight = node.coat_ior = 1;  // a coat of no reflection
  node.coat_tint = Color(0.5f);
  EXPECT_NEAR(albedo_of(node, 0), 0.5, 1e-3);
  EXPECT_NEAR(albedo_of(node, 60), 0.25, 1e-3);
}

TEST(Principled, layers_take_their_share_of_emission) {
  PrincipledShader node;
  node.emission = Color(1.0f);
  node.coat_weight = 1;
  const Vec3f wo = direction_at(80);
  static const Table<Texture> no_textures;
  const SurfaceShading shading = shade(test::make_material(node), no_textures, test::make_point(), wo);
  EXPECT_NEAR(shading.emission.x, 1 - fresnel_dielectric(wo.z, 1.5f).reflectance, 0.03);
  // It is another in each direction, so lights don't count on it.
  EXPECT_TRUE(is_black(emitted_radiance(test::make_material(node), SurfaceSide::front)));
  EXPECT_TRUE(has_varying_emission(test::make_material(node), SurfaceSide::front));
}

TEST(FilmDielectric, is_plain_glass_without_film_and_tint) {
  FilmDielectric film{.eta = 1.5f, .alpha = 0.3f};
  film.f0_tint = film.transmit_tint = PackedColor<1>(Color(1.0f));
  const Dielectric plain{.eta = 1.5f, .alpha = 0.3f};
  for (const float degrees : {20.0f, 60.0f, 120.0f, 160.0f}) {
    const Vec3f wo = direction_at(35), wi = direction_at(degrees, 200);
    const LobeValue a = film.eval(wo, wi), b = plain.eval(wo, wi);
    EXPECT_NEAR(a.value.x, b.value.x, 1e-4f * b.value.x) << degrees << " degrees";
    EXPECT_NEAR(a.pdf, b.pdf, 1e-4f * b.pdf) << degrees << " degrees";
  }
}

TEST(FilmDielectric, loses_nothing_where_smooth) {
  GlassShader node;
  node.thin_film_thickness = 450;
  for (const float degrees : {0.0f, 60.0f, 110.0f, 150.0f}) EXPECT_NEAR(albedo_of(node, degrees), 1, 2e-3) << degrees;
}

TEST(ThinFilm, of_nothing_is_no_film) {
  for (const float cosine : {0.1f, 0.5f, 1.0f}) {
    EXPECT_NEAR(film_on_dielectric({0.0f, 1.33f}, cosine, 1.5f).y, fresnel_dielectric(cosine, 1.5f).reflectance, 1e-3);
    const Color metal = film_on_conductor({0.0f, 1.33f}, cosine, Color(0.2f), Color(3.9f), Color(-1.0f));
    EXPECT_NEAR(metal.y, fresnel_conductor(cosine, 0.2f, 3.9f), 1e-3);
  }
}

// All trips through the film at one wavelength, by amplitudes: Born and Wolf, "Principles of Optics", 1.6.4.
double exact_reflectance(double wavelength, double thickness, double film, std::complex<double> below, double cosine) {
  using Complex = std::complex<double>;
  const double sine = std::sqrt(1 - cosine * cosine), inside = std::sqrt(1 - sine * sine / (film * film));
  const Complex beyond = std::sqrt(1.0 - Complex(sine * sine) / (below * below));
  const Complex round_trip = std::polar(1.0, 4 * 3.14159265358979 * film * thickness * inside / wavelength);
  const auto mix = [&](Complex top, Complex bottom) {
    return std::norm((top + bottom * round_trip) / (1.0 + top * bottom * round_trip));
  };
  const double s = mix((cosine - film * inside) / (cosine + film * inside),
                       (film * inside - below * beyond) / (film * inside + below * beyond));
  const double p = mix((film * cosine - inside) / (film * cosine + inside),
                       (below * inside - film * beyond) / (below * inside + film * beyond));
  return (s + p) / 2;
}

// The CIE 1931 observer's y by Wyman, Sloan and Shirley 2013.
double sensitivity_y(double wavelength) {
  const auto lobe = [&](double mean, double below, double above) {
    const double x = (wavelength - mean) / (wavelength < mean ? below : above);
    return std::exp(-x * x / 2);
  };
  return 0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1);
}

// Luminance weighs the channels as the eye's y does.
TEST(ThinFilm, has_the_luminance_of_the_exact_spectrum) {
  const auto exact = [](double thickness, std::complex<double> below, double cosine) {
    double sum = 0, weights = 0;
    for (double wavelength = 360; wavelength <= 830; wavelength += 0.5) {
      const double weight = sensitivity_y(wavelength);
      sum += weight * exact_reflectance(wavelength, thickness, 1.33, below, cosine);
      weights += weight;
    }
    return sum / weights;
  };
  // The channels are of equal power in themselves, so the white of their sum is not that of equal power.
  const auto found = [](Color c) { return (0.2126 * 1.2048 * c.x + 0.7152 * 0.9483 * c.y + 0.0722 * 0.9089 * c.z); };
  for (const float thickness : {150.0f, 400.0f, 700.0f})
    for (const float cosine : {0.3f, 0.7f, 1.0f}) {
      const ThinFilm film(thickness, 1.33f);
      EXPECT_NEAR(found(film_on_dielectric(film, cosine, 1.8f)), exact(thickness, 1.8, cosine), 0.004)
          << thickness << " nm, cosine " << cosine;
      const Color metal = film_on_conductor(film, cosine, Color(1.5f), Color(2.5f), Color(-1.0f));
      EXPECT_NEAR(found(metal), exact(thickness, {1.5, 2.5}, cosine), 0.01) << thickness << " nm, cosine " << cosine;
    }
}

TEST(Caustics, of_blender_s_glossy_lobes_can_be_left_out) {
  const Vec3f wo = direction_at(30), across = direction_at(35, 210), through = direction_at(160, 210);
  const auto without_reflection = [&](const ShaderNode& node) {
    Bsdf bsdf = test::make_bsdf(test::make_material(node), test::make_point(), wo);
    bsdf.remove_glossy(true, false);
    return bsdf;
  };
  EXPECT_TRUE(without_reflection(ToonShader{.component = ToonComponent::glossy}).is_empty());
  EXPECT_TRUE(without_reflection(GlossyShader{.distribution = FacetDistribution::ashikhmin_shirley}).is_empty());
  EXPECT_TRUE(without_reflection(MetallicShader{}).is_empty());
  EXPECT_FALSE(without_reflection(SheenShader{}).is_empty());
  EXPECT_FALSE(without_reflection(DiffuseShader{.is_two_sided = true, .roughness = 0.5f}).is_empty());
  GlassShader glass{.roughness = 0.5f};
  glass.thin_film_thickness = 400;
  const Bsdf bsdf = without_reflection(glass);
  EXPECT_EQ(bsdf.eval(wo, across).value.x, 0);
  EXPECT_GT(bsdf.eval(wo, through).value.x, 0);
}

TEST(Roughening, reaches_blender_s_glossy_lobes) {
  const Vec3f wo = direction_at(30);
  GlassShader glass{.roughness = 0.1f};
  glass.thin_film_thickness = 400;
  Bsdf bsdf = test::make_bsdf(test::make_material(glass), test::make_point(), wo);
  bsdf.roughen(0.3f);
  EXPECT_FLOAT_EQ(bsdf.transmission_alpha(), 0.3f);
  const GlossyShader mirror{.roughness = 0.01f, .distribution = FacetDistribution::ashikhmin_shirley};
  Bsdf rough = test::make_bsdf(test::make_material(mirror), test::make_point(), wo);
  EXPECT_TRUE(rough.has_only_deltas());
  rough.roughen(0.3f);
  EXPECT_FALSE(rough.has_only_deltas());
}

TEST(RadialTangents, go_around_the_axes_in_sizes_of_the_box) {
  SurfacePoint point = test::make_point();
  point.position = {3, 1, 0};
  Bounds3f box;
  box.extend({-2, -1, -1});
  box.extend({4, 1, 1});
  add_radial_tangents(point, box, Placement());
  // From the middle (1, 0, 0) it is a third of the box along x, and half of it along y.
  const auto& [x, y, z] = point.derivatives->radial_tangents;
  EXPECT_NEAR(z.x, -0.5f, 1e-6);
  EXPECT_NEAR(z.y, 1.0f / 3, 1e-6);
  EXPECT_NEAR(x.z, 0.5f, 1e-6);
  EXPECT_NEAR(y.z, 1.0f / 3, 1e-6);
}

}  // namespace
}  // namespace basicrt
