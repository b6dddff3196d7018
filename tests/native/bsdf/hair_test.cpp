// SPDX-License-Identifier: GPL-3.0-or-later
// Hair: nothing is lost where nothing absorbs, and colours are those that were asked for. test::all_materials() has hair
// too, so that lobes_test.cpp holds its sampling against its density.
#include <gtest/gtest.h>

#include "bsdf/fixtures.h"

namespace basicrt {
namespace {

constexpr float angles[] = {0, 35, 70};

TEST(Hair, without_pigment_gives_back_all_light) {
  for (const float roughness : {0.1f, 0.3f, 0.9f})
    for (const float coat : {0.0f, 0.7f}) {
      PrincipledHairShader node;
      node.parametrization = HairParametrization::absorption;
      node.absorption = Color(0.0f);
      node.roughness = node.radial_roughness = roughness;
      node.coat = coat;
      const Material material = test::make_material(node);
      for (const float degrees : angles) {
        const Vec3f wo = test::direction_at(degrees);
        const Bsdf bsdf = test::make_bsdf(material, test::make_point(), wo);
        const Vec3d albedo = test::directional_albedo(bsdf, wo, 50000);
        EXPECT_NEAR(albedo.x, 1, 0.01) << roughness << " " << coat << " " << degrees;
      }
    }
}

// By integration over all directions, which knows nothing of sampling.
TEST(Hair, has_a_density_of_one_in_all) {
  test::Rng rng(1);
  PrincipledHairShader node;
  node.roughness = 0.4f;
  node.radial_roughness = 0.5f;
  const Material material = test::make_material(node);
  for (const float degrees : angles) {
    const Vec3f wo = test::direction_at(degrees);
    const Bsdf bsdf = test::make_bsdf(material, test::make_point(), wo);
    double sum = 0;
    constexpr int count = 400000;
    for (int i = 0; i < count; ++i) {
      const Vec3f wi = sample_sphere(test::next_unit_vec2(rng));
      sum += static_cast<double>(bsdf.eval(wo, wi).pdf);
    }
    EXPECT_NEAR(sum * 4 * static_cast<double>(pi) / count, 1, 0.02) << degrees;
  }
}

TEST(Hair, more_pigment_is_darker_and_redder_hair_is_redder) {
  const auto albedo = [](float melanin, float redness) {
    PrincipledHairShader node;
    node.parametrization = HairParametrization::melanin;
    node.melanin = melanin;
    node.melanin_redness = redness;
    const Vec3f wo = test::direction_at(20);
    return test::directional_albedo(test::make_bsdf(test::make_material(node), test::make_point(), wo), wo, 20000);
  };
  const Vec3d fair = albedo(0.2f, 0.5f), dark = albedo(0.9f, 0.5f), red = albedo(0.5f, 1), black = albedo(0.5f, 0);
  EXPECT_GT(fair.x, dark.x);
  EXPECT_GT(fair.z, dark.z);
  EXPECT_GT(red.x / red.z, black.x / black.z);
}

TEST(Hair, simple_hair_gives_back_all_light) {
  for (const HairComponent component : {HairComponent::reflection, HairComponent::transmission})
    for (const float around : {0.1f, 0.6f, 1.0f}) {
      const Material material = test::make_material(HairShader{component, Color(1.0f), 0.1f, 0.2f, around});
      for (const float degrees : angles) {
        const Vec3f wo = test::direction_at(degrees);
        const Bsdf bsdf = test::make_bsdf(material, test::make_point(), wo);
        EXPECT_NEAR(test::directional_albedo(bsdf, wo, 50000).x, 1, 0.01) << around << " " << degrees;
      }
    }
}

}  // namespace
}  // namespace basicrt
