// SPDX-License-Identifier: GPL-3.0-or-later
// What passes and baking make of a surface's lobes: some kinds of them alone, one normal, one roughness.
#include <gtest/gtest.h>

#include "bsdf/fixtures.h"

namespace basicrt::test {
namespace {

TEST(KeepKinds, leaves_what_the_value_of_those_kinds_is) {
  const Vec3f wo = direction_at(25);
  for (const auto& [name, material] : all_materials()) {
    const Bsdf whole = make_bsdf(material, make_point(), wo);
    for (const std::uint32_t kinds : {std::uint32_t{ray_diffuse}, std::uint32_t{ray_glossy},
                                      std::uint32_t{ray_transmission}, ray_diffuse | ray_glossy, 0u}) {
      Bsdf kept = whole;
      kept.keep_kinds(kinds);
      for (const float angle : {10.0f, 60.0f, 85.0f, 120.0f, 170.0f}) {
        const Vec3f wi = direction_at(angle, 200);
        const Color expected = whole.eval_kinds(wo, wi, kinds).value, value = kept.eval(wo, wi).value;
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], 1e-6f * expected[i]) << name << ", " << kinds;
      }
    }
  }
}

TEST(KeepKinds, leaves_out_what_passes_straight_through) {
  Bsdf bsdf = make_bsdf(make_mix(0.5f, TransparentShader{}, DiffuseShader{}), make_point(), direction_at(0));
  bsdf.keep_kinds(ray_diffuse | ray_glossy | ray_transmission);
  EXPECT_EQ(bsdf.albedo(direction_at(0), ScatterKind::transparent), Color(0.0f));
  EXPECT_FALSE(bsdf.is_empty());
}

TEST(MeanRoughness, is_that_of_the_nodes) {
  const Vec3f wo = direction_at(20);
  const auto roughness = [&](const Material& material) {
    return make_bsdf(material, make_point(), wo).mean_roughness();
  };
  EXPECT_NEAR(roughness(make_material(GlossyShader{.color = Color(0.5f), .roughness = 0.3f})), 0.3f, 1e-6f);
  EXPECT_NEAR(roughness(make_material(GlassShader{.roughness = 0.4f})), 0.4f, 1e-6f);
  EXPECT_NEAR(roughness(make_material(PrincipledShader{.roughness = 0.6f})), 0.6f, 1e-6f);
  EXPECT_EQ(roughness(make_material(DiffuseShader{})), 1);
  const Material half = make_mix(0.5f, GlossyShader{.color = Color(0.5f), .roughness = 0.2f},
                                 GlossyShader{.color = Color(0.5f), .roughness = 0.4f});
  EXPECT_NEAR(roughness(half), 0.3f, 2e-3f);  // the rougher one counts a little more: it is to keep its light
}

TEST(Specularity, is_all_of_a_mirror_and_nothing_of_what_is_rough) {
  const Vec3f wo = direction_at(20);
  const auto of = [&](const Material& material) { return make_bsdf(material, make_point(), wo).specularity(wo); };
  const Specularity mirror = of(make_material(GlossyShader{.color = Color(0.5f), .roughness = 0}));
  EXPECT_EQ(mirror.albedo, Color(0.5f));
  EXPECT_EQ(mirror.roughness, 0);
  const Specularity rough = of(make_material(GlossyShader{.color = Color(0.5f), .roughness = 0.4f}));
  EXPECT_EQ(rough.albedo, Color(0.0f));  // an alpha of 0.16
  EXPECT_NEAR(rough.roughness, 0.4f, 1e-6f);
  const Specularity diffuse = of(make_material(DiffuseShader{}));
  EXPECT_EQ(diffuse.albedo, Color(0.0f));
  EXPECT_EQ(diffuse.roughness, 1);
}

TEST(Specularity, fades_with_a_smooth_step_of_alpha) {
  const Vec3f wo = direction_at(20);
  const Bsdf bsdf = make_bsdf(make_material(GlossyShader{.color = Color(0.5f), .roughness = 0.3f}), make_point(), wo);
  const float t = 0.09f / 0.15f, share = 1 - t * t * (3 - 2 * t);
  EXPECT_NEAR(bsdf.specularity(wo).albedo.x, share * bsdf.albedo(wo, ScatterKind::glossy).x, 1e-6f);
}

TEST(Specularity, is_the_mean_of_lobes_by_what_they_return_but_for_the_transparent) {
  const Vec3f wo = direction_at(20);
  const GlossyShader mirror{.color = Color(0.6f), .roughness = 0};
  const Specularity half =
      make_bsdf(make_mix(0.5f, DiffuseShader{Color(0.2f)}, mirror), make_point(), wo).specularity(wo);
  EXPECT_NEAR(half.roughness, 0.25f, 1e-6f);
  EXPECT_NEAR(half.albedo.x, 0.3f, 1e-6f);
  const Specularity pane = make_bsdf(make_mix(0.5f, TransparentShader{}, mirror), make_point(), wo).specularity(wo);
  EXPECT_EQ(pane.roughness, 0);
  EXPECT_NEAR(pane.albedo.x, 0.3f, 1e-6f);
}

}  // namespace
}  // namespace basicrt::test
