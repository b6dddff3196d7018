// SPDX-License-Identifier: GPL-3.0-or-later
// Refraction at smooth surfaces against Snell's law and the mirror.
#include <gtest/gtest.h>

#include "bsdf/fixtures.h"

namespace basicrt {
namespace {

using test::direction_at;

BsdfSample refract(float eta, Vec3f wo, Vec3f normal = {0, 0, 1}) {
  const Material material = test::make_material(RefractionShader{Color(1.0f), eta, 0});
  const auto sample = test::make_bsdf(material, test::make_point(normal), wo).sample(wo, 0.5f, {0.5f, 0.5f});
  EXPECT_TRUE(sample);
  return sample.value_or(BsdfSample{});
}

TEST(Refraction, obeys_snell_on_entering_and_leaving) {
  const float eta = 2;
  for (const float degrees : {0.0f, 20.0f, 60.0f, 89.0f}) {
    const Vec3f wo = direction_at(degrees);
    const BsdfSample inside = refract(eta, wo);
    EXPECT_EQ(inside.kind, ScatterKind::transmission);
    EXPECT_LT(inside.wi.z, 0);
    EXPECT_NEAR(std::hypot(inside.wi.x, inside.wi.y), std::sin(degrees * pi / 180) / eta, 1e-6);
    EXPECT_NEAR(dot(cross(wo, inside.wi), {0, 0, 1}), 0, 1e-6);  // in the plane of incidence
    EXPECT_LE(inside.wi.x * wo.x, 0);                            // on the far side of the normal
    // Turned round, the ray goes back the way it came.
    EXPECT_LT(length(refract(eta, inside.wi).wi - wo), 2e-4f);
  }
}

TEST(Refraction, falls_back_to_the_mirror_past_the_critical_angle) {
  const float eta = 2;  // critical angle 30 degrees
  const Vec3f below = refract(eta, direction_at(180 - 29)).wi, above = refract(eta, direction_at(180 - 31)).wi;
  EXPECT_GT(below.z, 0);
  const Vec3f wo = direction_at(180 - 31);
  EXPECT_LT(length(above - Vec3f{-wo.x, -wo.y, wo.z}), 1e-6f);
  EXPECT_EQ(refract(eta, wo).kind, ScatterKind::glossy);
}

TEST(Refraction, is_black_past_the_critical_angle_where_total_reflection_is_lost) {
  const Material material = test::make_material(RefractionShader{Color(1.0f), 2, 0, FacetDistribution::ggx, false});
  const auto sample = [&](Vec3f wo) {
    return test::make_bsdf(material, test::make_point(), wo).sample(wo, 0.5f, {0.5f, 0.5f});
  };
  EXPECT_TRUE(sample(direction_at(180 - 29)));
  EXPECT_FALSE(sample(direction_at(180 - 31)));
}

TEST(Refraction, keeps_unit_length_over_many_surfaces) {
  Vec3f direction = direction_at(40);
  for (int i = 0; i < 1000; ++i) direction = -refract(1.5f, direction, {0, 0.1f, 1}).wi;
  EXPECT_NEAR(length(direction), 1, 1e-6);
}

TEST(Refraction, an_index_of_one_bends_nothing) {
  const Vec3f wo = direction_at(50);
  EXPECT_LT(length(refract(1, wo).wi + wo), 1e-6f);
  const Material rough = test::make_material(GlassShader{Color(1.0f), Color(1.0f), 1, 0.5f});
  const auto sample = test::make_bsdf(rough, test::make_point(), wo).sample(wo, 0.5f, {0.2f, 0.7f});
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->is_delta);
  EXPECT_LT(length(sample->wi + wo), 1e-6f);
}

TEST(Glass, divides_light_by_fresnel) {
  const Color reflect{0.5f, 0.6f, 0.7f}, transmit{0.9f, 0.8f, 0.3f};
  for (const float degrees : {0.0f, 56.31f, 80.0f, 150.0f}) {
    const Vec3f wo = direction_at(degrees);
    const float eta = wo.z > 0 ? 1.5f : 1 / 1.5f;
    const float f = fresnel_dielectric(std::abs(wo.z), eta).reflectance;
    const Bsdf bsdf =
        test::make_bsdf(test::make_material(GlassShader{reflect, transmit, 1.5f, 0}), test::make_point(), wo);
    // The mean of what the samples carry, and how often: over evenly spaced choices.
    Color reflected(0.0f), transmitted(0.0f);
    const int count = 10000;
    for (int i = 0; i < count; ++i) {
      const auto sample = bsdf.sample(wo, (static_cast<float>(i) + 0.5f) / count, {0.5f, 0.5f});
      ASSERT_TRUE(sample);
      (sample->kind == ScatterKind::glossy ? reflected : transmitted) += sample->weight * (1.0f / count);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(reflected[c], f * reflect[c], 1e-3) << degrees;
      EXPECT_NEAR(transmitted[c], (1 - f) * transmit[c], 1e-3) << degrees;
    }
  }
}

}  // namespace
}  // namespace basicrt
