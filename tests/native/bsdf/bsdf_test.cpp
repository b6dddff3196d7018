// SPDX-License-Identifier: GPL-3.0-or-later
// What a Bsdf makes of its lobes, and shade() of a material: sides, mixing, emission, leaking light.
#include "bsdf/bsdf.h"

#include <gtest/gtest.h>

#include "bsdf/fixtures.h"

namespace basicrt {
namespace {

using test::direction_at;
using test::make_bsdf;
using test::make_material;
using test::make_mix;
using test::make_point;
using test::make_sum;

TEST(Bsdf, without_lobes_absorbs_everything) {
  const Bsdf bsdf(Frame{}, {0, 0, 1});
  EXPECT_TRUE(bsdf.is_empty());
  EXPECT_TRUE(bsdf.has_only_deltas());
  EXPECT_FALSE(bsdf.sample({0, 0, 1}, 0.5f, {0.5f, 0.5f}));
  EXPECT_EQ(bsdf.eval({0, 0, 1}, {0, 0, 1}).pdf, 0);
}

TEST(Bsdf, leaves_out_black_lobes) {
  EXPECT_TRUE(make_bsdf(make_material(DiffuseShader{Color(0.0f)}), make_point(), {0, 0, 1}).is_empty());
}

TEST(Bsdf, knows_whether_only_deltas_are_there) {
  const Vec3f wo = direction_at(20);
  const ShaderNode mirror = GlossyShader{Color(1.0f), 0}, diffuse = DiffuseShader{Color(0.5f), true};
  EXPECT_TRUE(make_bsdf(make_mix(0.5f, mirror, TransparentShader{}), make_point(), wo).has_only_deltas());
  EXPECT_FALSE(make_bsdf(make_mix(0.5f, mirror, diffuse), make_point(), wo).has_only_deltas());
}

// Over all pairs of normals and directions: reflection stays in front of both, refraction behind both.
TEST(Bsdf, lets_no_light_leak_through_the_surface) {
  test::Rng rng(8);
  const Vec3f geometric{0, 0, 1}, shading = direction_at(40);
  for (const auto& named : test::all_materials())
    for (int i = 0; i < 500; ++i) {
      const Vec3f wo = sample_sphere(test::next_unit_vec2(rng));
      const Bsdf bsdf = make_bsdf(named.material, make_point(geometric, shading), wo);
      const auto is_reflected = [&](Vec3f normal, Vec3f wi) { return dot(normal, wi) * dot(geometric, wo) > 0; };
      const float choice = test::next_unit_float(rng);
      const auto sample = bsdf.sample(wo, choice, test::next_unit_vec2(rng));
      if (sample && sample->kind != ScatterKind::transparent) {
        EXPECT_EQ(is_reflected(geometric, sample->wi), is_reflected(shading, sample->wi)) << named.name << ", seed 8";
      }
      const Vec3f wi = sample_sphere(test::next_unit_vec2(rng));
      if (is_reflected(geometric, wi) != is_reflected(shading, wi)) {
        EXPECT_EQ(bsdf.eval(wo, wi).pdf, 0);
        EXPECT_EQ(bsdf.eval(wo, wi).value, Color(0.0f));
      }
    }
}

TEST(Bsdf, samples_have_their_density_where_the_shading_normal_is_bent) {
  const auto materials = test::all_materials();
  for (const auto& named : materials) {
    const Vec3f wo = direction_at(50, 200);
    const Bsdf bsdf = make_bsdf(named.material, make_point({0, 0, 1}, direction_at(25)), wo);
    if (bsdf.has_only_deltas()) continue;
    const auto result = test::chi_square_sphere(
        [&](test::Rng& rng) -> std::optional<Vec3f> {
          const float choice = test::next_unit_float(rng);
          const auto sample = bsdf.sample(wo, choice, test::next_unit_vec2(rng));
          return sample && !sample->is_delta ? std::optional(sample->wi) : std::nullopt;
        },
        [&](Vec3f wi) { return bsdf.eval(wo, wi).pdf; }, {.samples = 100000, .pilot_samples = 20000});
    EXPECT_GT(result.p_value, test::sidak_threshold(static_cast<int>(materials.size())))
        << named.name << ": " << result.describe();
  }
}

TEST(Shade, a_one_sided_diffuse_is_black_from_behind) {
  const Vec3f front = direction_at(30), back = direction_at(150);
  const Material one_sided = make_material(DiffuseShader{Color(0.5f), false});
  const Material two_sided = make_material(DiffuseShader{Color(0.5f), true});
  EXPECT_NEAR(make_bsdf(one_sided, make_point(), front).eval(front, {0, 0, 1}).value.x, 0.5f * inv_pi, 1e-7);
  EXPECT_TRUE(make_bsdf(one_sided, make_point(), back).is_empty());
  EXPECT_NEAR(make_bsdf(two_sided, make_point(), back).eval(back, {0, 0, -1}).value.x, 0.5f * inv_pi, 1e-7);
  EXPECT_EQ(make_bsdf(two_sided, make_point(), back).eval(back, {0, 0, 1}).value.x, 0);
}

TEST(Shade, mixes_and_adds_by_weight) {
  const Vec3f wo = direction_at(30), wi = direction_at(40, 100);
  const ShaderNode red = DiffuseShader{Color{0.8f, 0, 0}}, green = DiffuseShader{Color{0, 0.4f, 0}};
  const float lambert = inv_pi * wi.z;
  const Color mixed = make_bsdf(make_mix(0.25f, red, green), make_point(), wo).eval(wo, wi).value;
  EXPECT_NEAR(mixed.x, 0.75f * 0.8f * lambert, 1e-6);
  EXPECT_NEAR(mixed.y, 0.25f * 0.4f * lambert, 1e-6);
  const Color sum = make_bsdf(make_sum(red, green), make_point(), wo).eval(wo, wi).value;
  EXPECT_NEAR(sum.x, 0.8f * lambert, 1e-6);
  EXPECT_NEAR(sum.y, 0.4f * lambert, 1e-6);
}

TEST(Shade, an_empty_input_is_black) {
  Material material;
  const NodeIndex diffuse = material.add(DiffuseShader{Color(0.8f)});
  material.surface = material.add(MixShader{0.5f, diffuse, no_node});
  const Vec3f up{0, 0, 1};
  EXPECT_NEAR(make_bsdf(material, make_point(), up).eval(up, up).value.x, 0.4f * inv_pi, 1e-6);
  EXPECT_TRUE(make_bsdf(Material{}, make_point(), up).is_empty());
}

TEST(Shade, colours_come_from_textures) {
  Table<Texture> textures;
  ColorInput input{Color(0.1f)};
  input.texture = textures.append(CheckerboardTexture{.color0 = Color(0.2f), .color1 = Color(0.6f), .scale = {2, 2}});
  const Material material = make_material(DiffuseShader{input});
  SurfacePoint point = make_point();
  const Vec3f up{0, 0, 1};
  point.uv = {0.1f, 0.1f};
  EXPECT_NEAR(shade(material, textures, point, up).bsdf.eval(up, up).value.x, 0.2f * inv_pi, 1e-6);
  point.uv = {0.6f, 0.1f};
  EXPECT_NEAR(shade(material, textures, point, up).bsdf.eval(up, up).value.x, 0.6f * inv_pi, 1e-6);
}

TEST(Shade, transparent_goes_straight_on_exactly) {
  const Vec3f wo = normalize(Vec3f{0.3f, 0.2f, -0.9f});
  const auto sample = make_bsdf(make_material(TransparentShader{Color(0.5f)}), make_point({1, 2, 3}), wo)
                          .sample(wo, 0.3f, {0.1f, 0.2f});
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->wi, -wo);
  EXPECT_EQ(sample->kind, ScatterKind::transparent);
  EXPECT_EQ(sample->weight, Color(0.5f));
}

TEST(Shade, stretched_microfacets_follow_the_tangent) {
  ConductorShader node;
  node.alpha_x = 0.4f;
  node.alpha_y = 0.05f;
  SurfacePoint point = make_point();
  point.derivatives->dpdu = {0, 3, 0};
  const Vec3f wo{0, 0, 1};
  const Bsdf bsdf = make_bsdf(make_material(node), point, wo);
  EXPECT_GT(bsdf.eval(wo, direction_at(20, 90)).value.x, 100 * bsdf.eval(wo, direction_at(20, 0)).value.x);
}

TEST(Shade, emission_agrees_with_emitted_radiance_on_both_sides) {
  PrincipledShader glowing;
  glowing.emission = Color{1, 2, 3};
  glowing.alpha = 0.5f;
  const std::vector<Material> materials = {make_material(EmissionShader{Color{4, 5, 6}, true}),
                                           make_material(EmissionShader{Color{4, 5, 6}, false}),
                                           make_material(glowing),
                                           make_mix(0.25f, EmissionShader{Color(8.0f), false}, glowing),
                                           make_sum(EmissionShader{Color(1.0f)}, EmissionShader{Color(1.0f)}),
                                           make_material(DiffuseShader{})};
  const std::vector<Color> front = {{4, 5, 6},   {4, 5, 6},  {0.5f, 1, 1.5f}, {6.125f, 6.25f, 6.375f},
                                    Color(2.0f), Color(0.0f)};
  const std::vector<Color> back = {{4, 5, 6},   Color(0.0f), {0.5f, 1, 1.5f}, {0.125f, 0.25f, 0.375f},
                                   Color(2.0f), Color(0.0f)};
  const Table<Texture> textures;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    EXPECT_EQ(shade(materials[i], textures, make_point(), {0, 0, 1}).emission, front[i]);
    EXPECT_EQ(shade(materials[i], textures, make_point(), {0, 0, -1}).emission, back[i]);
    EXPECT_EQ(emitted_radiance(materials[i], SurfaceSide::front), front[i]);
    EXPECT_EQ(emitted_radiance(materials[i], SurfaceSide::back), back[i]);
    EXPECT_EQ(is_emissive(materials[i]), !is_black(front[i]));
  }
}

TEST(Transparency, is_what_the_transparent_lobes_let_through) {
  PrincipledShader leaf;
  leaf.alpha = 0.25f;
  const Table<Texture> textures;
  const auto of = [&](const Material& material) { return transparency(material, textures, make_point(), {0, 0, 1}); };
  EXPECT_EQ(of(make_material(TransparentShader{Color{0.2f, 0.4f, 0.6f}})), (Color{0.2f, 0.4f, 0.6f}));
  EXPECT_EQ(of(make_material(leaf)), Color(0.75f));
  EXPECT_EQ(of(make_mix(0.5f, TransparentShader{}, leaf)), Color(0.875f));
  EXPECT_EQ(of(make_material(GlassShader{})), Color(0.0f));
  EXPECT_TRUE(is_transparent(make_material(leaf)));
  EXPECT_TRUE(is_transparent(make_mix(0.5f, DiffuseShader{}, TransparentShader{})));
  EXPECT_FALSE(is_transparent(make_mix(0, DiffuseShader{}, TransparentShader{})));
  EXPECT_FALSE(is_transparent(make_material(GlassShader{})));
}

TEST(LobeCount, counts_every_way_through_the_graph) {
  PrincipledShader all;
  all.alpha = all.metallic = all.transmission = 0.5f;
  EXPECT_EQ(lobe_count(make_material(DiffuseShader{})), 1);
  EXPECT_EQ(lobe_count(make_material(PrincipledShader{})), 2);
  EXPECT_EQ(lobe_count(make_material(all)), 5);
  EXPECT_EQ(lobe_count(make_mix(0.5f, all, DiffuseShader{})), 6);
  all.sheen_weight = all.coat_weight = 0.5f;
  EXPECT_EQ(lobe_count(make_material(all)), 7);
}

TEST(LobeCount, is_quick_for_exponentially_many_ways) {
  Material material;
  NodeIndex node = no_node;
  for (int i = 0; i < 100; ++i) node = material.add(AddShader{node, node});
  material.surface = node;
  EXPECT_GT(lobe_count(material), Bsdf::max_lobes);
}

TEST(LobeCount, bounds_what_shade_makes) {
  for (const auto& named : test::all_materials()) EXPECT_LE(lobe_count(named.material), Bsdf::max_lobes) << named.name;
}

}  // namespace
}  // namespace basicrt
