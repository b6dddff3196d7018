// SPDX-License-Identifier: GPL-3.0-or-later
// Solid angles of rectangles and triangles: closed forms, each other, and additivity.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "light/lamp_checks.h"
#include "light/spherical_rectangle.h"
#include "light/spherical_triangle.h"

namespace basicrt {
namespace {

using namespace test;

double two_triangles(Vec2d min, Vec2d max, double height) {
  const Vec3d a{min.x, min.y, height}, b{max.x, min.y, height}, c{max.x, max.y, height}, d{min.x, max.y, height};
  return SphericalTriangle(a, b, c).solid_angle() + SphericalTriangle(a, c, d).solid_angle();
}

TEST(SphericalRectangle, a_cubes_face_fills_a_sixth_of_the_sphere) {
  EXPECT_NEAR(SphericalRectangle({-1, -1}, {1, 1}, 1).solid_angle(), 4 * std::numbers::pi / 6, 1e-14);
}

TEST(SphericalRectangle, is_as_large_as_its_two_triangles) {
  Rng rng(51);
  for (int i = 0; i < 1000; ++i) {
    const auto number = [&] { return 4.0 * next_unit_float(rng) - 2; };
    const Vec2d min{number(), number()}, max{min.x + 1e-3 + std::abs(number()), min.y + 1e-3 + std::abs(number())};
    const double height = std::pow(10.0, 3 * next_unit_float(rng) - 2);
    EXPECT_NEAR(SphericalRectangle(min, max, height).solid_angle(), two_triangles(min, max, height), 1e-12)
        << "seed 51";
  }
}

TEST(SphericalRectangle, keeps_its_digits_from_touching_to_far_away) {
  // Straight over a square of half width one: 4 asin(1 / (1 + h^2)), written so that it does not cancel.
  for (const double height : {1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const double squared = height * height;
    const double expected = 4 * std::atan2(1, height * std::sqrt(2 + squared));
    EXPECT_NEAR(SphericalRectangle({-1, -1}, {1, 1}, height).solid_angle(), expected, 1e-14) << height;
  }
  // Beside it and all but in its plane, it is seen edge on.
  EXPECT_NEAR(SphericalRectangle({5, 5}, {6, 6}, 1e-20).solid_angle(), 0, 1e-14);
}

TEST(SphericalRectangle, samples_lie_on_it_whatever_its_shape) {
  Rng rng(52);
  for (int i = 0; i < 20000; ++i) {
    const auto number = [&] { return std::pow(10.0, 8 * next_unit_float(rng) - 4) * (rng() & 1 ? 1 : -1); };
    const Vec2d min{number(), number()}, max{min.x + std::abs(number()), min.y + std::abs(number())};
    const SphericalRectangle rectangle(min, max, std::abs(number()));
    const Vec2d p = rectangle.sample(next_unit_vec2(rng));
    ASSERT_TRUE(p.x >= min.x && p.x <= max.x && p.y >= min.y && p.y <= max.y) << p.x << " " << p.y << ", seed 52";
  }
}

TEST(SphericalTriangle, an_octant_fills_an_eighth_of_the_sphere) {
  EXPECT_NEAR(SphericalTriangle({2, 0, 0}, {0, 1, 0}, {0, 0, 5}).solid_angle(), std::numbers::pi / 2, 1e-14);
}

TEST(SphericalTriangle, samples_lie_in_it) {
  Rng rng(53);
  for (int i = 0; i < 5000; ++i) {
    const Vec3d a(random_direction(rng)), b(random_direction(rng)), c(random_direction(rng));
    const SphericalTriangle triangle(a, b, c);
    if (triangle.solid_angle() < 1e-3) continue;
    const Vec3d p = triangle.sample(next_unit_vec2(rng));
    EXPECT_NEAR(length(p), 1, 1e-9) << "seed 53";
    const double side = dot(a, cross(b, c)) < 0 ? -1 : 1;
    EXPECT_GT(side * dot(p, cross(a, b)), -1e-7) << "seed 53";
    EXPECT_GT(side * dot(p, cross(b, c)), -1e-7) << "seed 53";
    EXPECT_GT(side * dot(p, cross(c, a)), -1e-7) << "seed 53";
  }
}

}  // namespace
}  // namespace basicrt
