// SPDX-License-Identifier: GPL-3.0-or-later
// Area lamps against Lambert's formula, and the energy of their spread.
#include "light/area.h"

#include <gtest/gtest.h>

#include "light/closed_forms.h"
#include "light/lamp_checks.h"

namespace basicrt {
namespace {

using namespace test;

double expected_irradiance(const Transform& to_world, Vec3f position) {
  std::vector<Vec3d> corners;
  for (const Vec2d c : {Vec2d{-0.5, -0.5}, Vec2d{0.5, -0.5}, Vec2d{0.5, 0.5}, Vec2d{-0.5, 0.5}})
    corners.push_back(TransformD(to_world).point(Vec3d{c.x, c.y, 0}) - Vec3d(position));
  return polygon_irradiance(corners, {0, 0, 1});
}

// Over the plane z = 0 and looking down at it.
Transform tilted_over(Vec3f scale, float height) {
  const float c = std::cos(0.3f), s = std::sin(0.3f);
  return translation({0.2f, -0.1f, height}) * Transform({{{c, 0, s, 0}, {0, 1, 0, 0}, {-s, 0, c, 0}}}) * scaling(scale);
}

TEST(AreaLight, rectangle_sheds_what_lamberts_formula_says) {
  // From pinholes to ceilings, near and far.
  for (const Vec3f scale : {Vec3f(1), Vec3f{2, 0.1f, 1}, Vec3f(1e-3f), Vec3f{5, 5, 3}})
    for (const float height : {2.0f, 20.0f, 2000.0f}) {
      const Transform to_world = tilted_over(scale, height);
      const double expected = expected_irradiance(to_world, {0, 0, 0});
      EXPECT_NEAR(sampled_irradiance(AreaLight{.to_world = to_world}, {0, 0, 0}, {0, 0, 1}) / expected, 1, 2e-3)
          << scale.x << " x " << scale.y << " at " << height;
    }
}

TEST(AreaLight, close_over_the_receiver_covers_its_sky) {
  for (const float height : {0.1f, 1e-3f, 1e-6f}) {
    const Transform to_world = translation({0.1f, -0.2f, height});
    const double expected = expected_irradiance(to_world, {0, 0, 0});
    EXPECT_NEAR(sampled_irradiance(AreaLight{.to_world = to_world}, {0, 0, 0}, {0, 0, 1}), expected, 5e-3) << height;
  }
}

TEST(AreaLight, sheared_sheds_what_lamberts_formula_says) {
  const Transform to_world =
      translation({0.3f, 0.2f, 1.5f}) * Transform({{{1, 0.6f, 0.2f, 0}, {0, 0.8f, 0.1f, 0}, {0.1f, 0.2f, 1, 0}}});
  EXPECT_NEAR(sampled_irradiance(AreaLight{.to_world = to_world}, {0, 0, 0}, {0, 0, 1}),
              expected_irradiance(to_world, {0, 0, 0}), 2e-3);
}

TEST(AreaLight, disc_on_its_axis_sheds_pi_r_squared_over_the_sum_of_squares) {
  for (const double radius : {0.05, 0.5, 3.0}) {
    const Light lamp =
        AreaLight{.to_world = translation({0, 0, 2}) * scaling(Vec3f(float(2 * radius))), .is_ellipse = true};
    const double expected = double(pi) * radius * radius / (radius * radius + 4);
    EXPECT_NEAR(sampled_irradiance(lamp, {0, 0, 0}, {0, 0, 1}) / expected, 1, 5e-3) << radius;
  }
}

TEST(AreaLight, emits_pi_radiance_area_whatever_its_spread) {
  const Transform to_world = tilted_over({2, 0.5f, 1}, 1);
  for (const float spread : {0.02f, 0.3f, 1.5f, 2.9f, 3.141593f})
    for (const bool is_ellipse : {false, true}) {
      const Light lamp =
          AreaLight{.to_world = to_world, .radiance = Color(3), .is_ellipse = is_ellipse, .spread = spread};
      const double expected = 3 * double(pi) * (is_ellipse ? double(pi) / 4 : 1);
      EXPECT_NEAR(sampled_power(lamp, {}, 1) / expected, 1, 5e-3) << spread;
      EXPECT_NEAR(power_estimate(lamp, 1) / expected, 1, 1e-5) << spread;
    }
}

TEST(AreaLight, spread_falls_with_the_tangent) {
  const float spread = 1.2f;
  const Light lamp = AreaLight{.to_world = scaling(Vec3f(1e-3f)), .spread = spread};
  const double a = spread / 2;
  for (double angle = 0; angle < 0.8; angle += 0.05) {
    const Vec3f place(Vec3d{std::sin(angle), 0, -std::cos(angle)});
    const auto hit = intersect_light(lamp, {.origin = place, .direction = -place});
    const double expected = std::max(0.0, 1 - std::tan(angle) / std::tan(a)) / (1 - a / std::tan(a));
    EXPECT_NEAR(hit ? hit->radiance.x : 0, expected, 1e-4) << angle;
  }
}

TEST(AreaLight, emission_and_sampling_describe_the_same_light) {
  for (const float spread : {3.141593f, 1.0f})
    for (const bool is_ellipse : {false, true}) {
      const Light lamp = AreaLight{.to_world = translation({0.2f, 0.1f, 1.5f}) * scaling({1, 0.7f, 1}),
                                   .is_ellipse = is_ellipse,
                                   .spread = spread};
      EXPECT_NEAR(watts_by_emission(lamp) / watts_by_sampling(lamp), 1, 0.02) << spread << is_ellipse;
    }
}

TEST(AreaLight, behind_it_there_is_nothing) {
  Rng rng(41);
  for (const float mirror : {1.0f, -1.0f})
    for (const bool is_ellipse : {false, true}) {
      const Light lamp = AreaLight{.to_world = scaling({mirror, 1, 1}), .is_ellipse = is_ellipse};
      for (int i = 0; i < 100; ++i) {
        Vec3f place = random_direction(rng) * 3;
        place.z = std::abs(place.z);  // it shines towards -z
        EXPECT_FALSE(sample_light(lamp, place, next_unit_vec2(rng)));
        EXPECT_FALSE(intersect_light(lamp, {.origin = place, .direction = -place}));
        place.z = -place.z - 0.01f;
        EXPECT_TRUE(sample_light(lamp, place, next_unit_vec2(rng)));
      }
    }
}

TEST(AreaLight, is_hit_where_the_shape_is_and_nowhere_else) {
  for (const bool is_ellipse : {false, true}) {
    const Light lamp = AreaLight{.to_world = scaling({2, 4, 1}), .is_ellipse = is_ellipse};
    const auto is_hit = [&](float x, float y) {
      return intersect_light(lamp, {.origin = {x, y, -1}, .direction = {0, 0, 1}}).has_value();
    };
    EXPECT_TRUE(is_hit(0.99f, 0));
    EXPECT_FALSE(is_hit(1.01f, 0));
    EXPECT_TRUE(is_hit(0, -1.99f));
    EXPECT_FALSE(is_hit(0, -2.01f));
    EXPECT_EQ(is_hit(0.9f, 1.8f), !is_ellipse);
  }
}

TEST(AreaLight, rectangles_sampled_by_solid_angle_have_one_density) {
  const Light lamp = AreaLight{.to_world = tilted_over({2, 3, 1}, 1)};
  Rng rng(42);
  const auto first = sample_light(lamp, {0, 0, 0}, {0.5f, 0.5f});
  ASSERT_TRUE(first);
  for (int i = 0; i < 100; ++i) {
    const auto sample = sample_light(lamp, {0, 0, 0}, next_unit_vec2(rng));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->pdf, first->pdf) << "seed 42";
  }
}

}  // namespace
}  // namespace basicrt
