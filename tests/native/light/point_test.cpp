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
