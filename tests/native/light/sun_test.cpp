// SPDX-License-Identifier: GPL-3.0-or-later
// Suns against closed forms.
#include "light/sun.h"

#include <gtest/gtest.h>

#include "light/lamp_checks.h"

namespace basicrt {
namespace {

using namespace test;

TEST(SunLight, sheds_its_irradiance_on_a_surface_that_faces_it_whatever_its_angle) {
  for (const float angle : {0.0f, 1e-5f, 0.00918f, 0.5f, 2.0f, 3.141593f})
    for (const Vec3f place : {Vec3f{0, 0, 0}, Vec3f{1e4f, -3, 20}}) {
      const Light lamp = SunLight{.direction = {0, 0, -3}, .irradiance = Color(4), .angle = angle};
      EXPECT_NEAR(sampled_irradiance(lamp, place, {0, 0, 1}), 4, 5e-3) << angle;
    }
}

TEST(SunLight, tilted_sheds_by_the_cosine_while_it_is_above_the_horizon) {
  for (const float angle : {0.0f, 0.5f}) {
    const Light lamp = SunLight{.direction = {0, -1, -1}, .irradiance = Color(4), .angle = angle};
    EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}), 4 * std::sqrt(0.5), 5e-3) << angle;
  }
}

TEST(SunLight, disc_has_the_radiance_of_its_projected_solid_angle) {
  const Light lamp = SunLight{.direction = {0, 0, -1}, .irradiance = Color(4), .angle = 0.5f};
  const auto hit = intersect_light(lamp, {.origin = {1, 2, 3}, .direction = {0, 0, 2}});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->radiance.x, 4 / (double(pi) * std::pow(std::sin(0.25), 2)), 1e-3);
  EXPECT_FALSE(intersect_light(lamp, {.origin = {1, 2, 3}, .direction = {0, 0.27f, 1}}));
  EXPECT_TRUE(intersect_light(lamp, {.origin = {1, 2, 3}, .direction = {0, 0.24f, 1}}));
}

TEST(SunLight, emits_what_passes_through_the_scenes_outline) {
  const double outline = double(pi) * 9;
  EXPECT_NEAR(sampled_power(SunLight{.irradiance = Color(4)}, {1, 2, 3}, 3), 4 * outline, 1e-3);
  EXPECT_NEAR(power_estimate(SunLight{.irradiance = Color(4)}, 3), 4 * outline, 1e-3);
  // A wide sun's outline faces each direction: radiance times solid angle times area.
  const double cone = 1 - std::cos(0.5), sine = std::sin(0.5);
  const Light wide = SunLight{.irradiance = Color(4), .angle = 1};
  EXPECT_NEAR(sampled_power(wide, {1, 2, 3}, 3) / (4 / (double(pi) * sine * sine) * 2 * double(pi) * cone * outline), 1,
              1e-4);
}

TEST(SunLight, rays_start_outside_the_scene_and_cross_it) {
  Rng rng(31);
  const Light lamp = SunLight{.direction = {1, 2, -1}, .angle = 0.3f};
  const Vec3f center{1, 2, 3};
  for (int i = 0; i < 1000; ++i) {
    const Vec2f u = next_unit_vec2(rng);
    const auto sample = sample_emission(lamp, u, next_unit_vec2(rng), center, 2);
    ASSERT_TRUE(sample);
    const Vec3f to_center = center - sample->ray.origin;
    EXPECT_GE(length(to_center), 2 * (1 - 1e-5f));
    EXPECT_LE(length(cross(to_center, sample->ray.direction)), 2 * (1 + 1e-5f));
    EXPECT_GT(dot(to_center, sample->ray.direction), 0);
  }
}

}  // namespace
}  // namespace basicrt
