// SPDX-License-Identifier: GPL-3.0-or-later
// Point lamps against closed forms.
#include "light/point.h"

#include <gtest/gtest.h>

#include "light/lamp_checks.h"

namespace basicrt {
namespace {

using namespace test;

TEST(PointLight, without_radius_sheds_intensity_times_cosine_over_squared_distance) {
  const Light lamp = PointLight{.position = {1, 2, 2}, .intensity = Color(5)};
  EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}, 1), 5 * (2.0 / 3) / 9, 1e-6);
}

TEST(PointLight, sphere_sheds_pi_radiance_times_the_square_of_its_sine) {
  // Facing a sphere, E = pi L (r / d)^2 = I / d^2: the radius does not matter.
  for (const float radius : {1e-6f, 0.01f, 0.5f, 1.9f}) {
    const Light lamp = PointLight{.position = {0, 0, 2}, .intensity = Color(5), .radius = radius};
    EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}), 5.0 / 4, 2e-3) << radius;
  }
}

TEST(PointLight, sphere_tilted_sheds_by_the_cosine_while_it_is_above_the_horizon) {
  const Light lamp = PointLight{.position = {1, 2, 2}, .intensity = Color(5), .radius = 1};
  EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}), 5 * (2.0 / 3) / 9, 1e-3);
}

TEST(PointLight, soft_disc_on_its_axis_sheds_intensity_over_the_sum_of_squares) {
  // pi L r^2 / (r^2 + d^2) with L = I / (pi r^2).
  for (const double radius : {0.01, 0.5, 2.0, 30.0}) {
    const Light lamp =
        PointLight{.position = {0, 0, 2}, .intensity = Color(5), .radius = float(radius), .is_soft = true};
    const double expected = 5 / (4 + radius * radius);
    EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}) / expected, 1, 2e-3) << radius;
  }
}

TEST(PointLight, from_within_the_sphere_every_direction_has_its_radiance) {
  const Light lamp = PointLight{.position = {0, 0, 2}, .intensity = Color(5), .radius = 3};
  const double radiance = 5 / (double(pi) * 9);
  EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}), double(pi) * radiance, 1e-3);
  EXPECT_NEAR(sampled_irradiance(lamp, {0.3f, 1, 1}, {1, 0, 0}), double(pi) * radiance, 1e-3);
}

TEST(PointLight, samples_lie_on_the_sphere_or_on_the_disc_that_faces_the_position) {
  Rng rng(61);
  const Vec3f center{0.5f, 0, 2};
  for (int i = 0; i < 1000; ++i) {
    const Vec3f outside = center + random_direction(rng) * (1 + 3 * next_unit_float(rng));
    const Vec2f u = next_unit_vec2(rng);
    const auto on_sphere = sample_light(PointLight{.position = center, .radius = 0.9f}, outside, u);
    const auto on_disc = sample_light(PointLight{.position = center, .radius = 0.9f, .is_soft = true}, outside, u);
    ASSERT_TRUE(on_sphere && on_disc);
    // The near side, where the normal and the way to the lamp are opposed.
    const Vec3f normal = (outside + on_sphere->wi * on_sphere->distance - center) / 0.9f;
    EXPECT_NEAR(length(normal), 1, 1e-4) << "seed 61";
    EXPECT_LT(dot(normal, on_sphere->wi), 1e-2) << "seed 61";
    const Vec3f offset = outside + on_disc->wi * on_disc->distance - center;
    EXPECT_LT(length(offset), 0.9f * 1.0001f) << "seed 61";
    EXPECT_NEAR(dot(offset, normalize(outside - center)), 0, 1e-4) << "seed 61";
    // From inside, the far side.
    const Vec3f inside = center + random_direction(rng) * (0.8f * next_unit_float(rng));
    const auto around = sample_light(PointLight{.position = center, .radius = 0.9f}, inside, u);
    ASSERT_TRUE(around);
    EXPECT_NEAR(length(inside + around->wi * around->distance - center), 0.9, 1e-5) << "seed 61";
  }
}

TEST(PointLight, emits_its_power) {
  for (const float radius : {0.0f, 0.5f})
    for (const bool is_soft : {false, true}) {
      const Light lamp = PointLight{.position = {0, 0, 2}, .intensity = Color(5), .radius = radius, .is_soft = is_soft};
      EXPECT_NEAR(sampled_power(lamp, {}, 1), 4 * double(pi) * 5, 1e-3);
      EXPECT_NEAR(power_estimate(lamp, 1), 4 * double(pi) * 5, 1e-3);
    }
}

TEST(PointLight, emission_and_sampling_describe_the_same_light) {
  // Watts on a square plate, by paths from the lamp and by samples towards it.
  const Light lamp = PointLight{.position = {0.2f, 0.1f, 1.5f}, .intensity = Color(5), .radius = 0.5f};
  EXPECT_NEAR(watts_by_emission(lamp) / watts_by_sampling(lamp), 1, 0.02);
}

}  // namespace
}  // namespace basicrt
