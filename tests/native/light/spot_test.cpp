// SPDX-License-Identifier: GPL-3.0-or-later
// Spot lamps against their profile and closed forms.
#include "light/spot.h"

#include <gtest/gtest.h>

#include "light/lamp_checks.h"

namespace basicrt {
namespace {

using namespace test;

// Blender's profile, straight from its formula.
double expected_share(double angle, double size, double blend) {
  const double edge = std::cos(size / 2);
  const double t = std::clamp((std::cos(angle) - edge) / ((1 - edge) * blend), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double sampled_share(const Light& lamp, double angle) {
  const Vec3f place(Vec3d{std::sin(angle), 0, -std::cos(angle)});
  const auto sample = sample_light(lamp, place, {0.5f, 0.5f});
  return sample ? sample->radiance.x : 0;
}

TEST(SpotLight, fades_by_smoothstep_of_the_cosine) {
  for (const float size : {0.02f, 0.8f, 2.0f, 3.1f})
    for (const float blend : {0.05f, 0.15f, 1.0f}) {
      const Light lamp = SpotLight{.to_world = {}, .angle = size, .blend = blend};
      for (double share = 0; share < 1.2; share += 0.07) {
        const double angle = share * size / 2;
        EXPECT_NEAR(sampled_share(lamp, angle), expected_share(angle, size, blend), 1e-3)
            << "size " << size << ", blend " << blend << ", angle " << angle;
      }
    }
}

TEST(SpotLight, without_blend_ends_abruptly) {
  const Light lamp = SpotLight{.to_world = {}, .angle = 1, .blend = 0};
  EXPECT_EQ(sampled_share(lamp, 0.499), 1);
  EXPECT_EQ(sampled_share(lamp, 0.501), 0);
}

TEST(SpotLight, measures_its_cone_in_the_scaled_frame) {
  // Twice as wide along x: the edge's tangent doubles there and stays along y.
  const float size = 1;
  const Light lamp = SpotLight{.to_world = scaling({2, 1, 1}), .angle = size, .blend = 0};
  const double edge = std::tan(0.5);
  const auto is_lit = [&](double x, double y) {
    return sample_light(lamp, Vec3f(Vec3d{x, y, -1}), {0.5f, 0.5f}).has_value();
  };
  EXPECT_TRUE(is_lit(1.99 * edge, 0));
  EXPECT_FALSE(is_lit(2.01 * edge, 0));
  EXPECT_TRUE(is_lit(0, 0.99 * edge));
  EXPECT_FALSE(is_lit(0, 1.01 * edge));
}

TEST(SpotLight, on_its_axis_has_the_whole_intensity_whatever_its_cone) {
  for (const float size : {0.1f, 1.0f, 3.0f})
    EXPECT_NEAR(sampled_irradiance(SpotLight{.to_world = translation({0, 0, 2}), .intensity = Color(8), .angle = size},
                                   {0, 0, 0}, {0, 0, 1}, 1),
                2, 1e-5);
}

TEST(SpotLight, emits_the_integral_of_its_profile) {
  for (const float radius : {0.0f, 0.4f})
    for (const float blend : {0.0f, 0.3f, 1.0f}) {
      const Light lamp = SpotLight{.to_world = scaling(Vec3f(3)), .radius = radius, .angle = 1.2f, .blend = blend};
      double integral = 0;
      constexpr int n = 20000;
      for (int i = 0; i < n; ++i) {
        const double angle = 0.6 * (i + 0.5) / n;
        integral += expected_share(angle, 1.2, std::max(1e-9f, blend)) * std::sin(angle) * 0.6 / n;
      }
      integral *= 2 * double(pi);
      EXPECT_NEAR(sampled_power(lamp, {}, 1) / integral, 1, 5e-3) << blend;
      EXPECT_NEAR(power_estimate(lamp, 1) / integral, 1, 1e-3) << blend;
    }
}

TEST(SpotLight, emission_and_sampling_describe_the_same_light_in_a_stretched_frame) {
  const Transform to_world = translation({0.2f, 0.1f, 1.5f}) * scaling({1.5f, 0.6f, 1});
  for (const float radius : {0.0f, 0.3f}) {
    const Light lamp =
        SpotLight{.to_world = to_world, .intensity = Color(5), .radius = radius, .angle = 1, .blend = 0.5f};
    EXPECT_NEAR(watts_by_emission(lamp) / watts_by_sampling(lamp), 1, 0.02) << radius;
  }
}

}  // namespace
}  // namespace basicrt
