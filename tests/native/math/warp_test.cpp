// SPDX-License-Identifier: GPL-3.0-or-later
// Every warp draws from the density that it claims.
#include "math/warp.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"

namespace basicrt {
namespace {

using test::Rng;

void expect_density(const std::function<Vec3f(Vec2f)>& warp, const std::function<double(Vec3f)>& pdf) {
  const auto result =
      test::chi_square_sphere([&](Rng& rng) -> std::optional<Vec3f> { return warp(test::next_unit_vec2(rng)); }, pdf);
  EXPECT_NEAR(result.mass, 1, 1e-3) << result.describe();
  EXPECT_GT(result.p_value, test::sidak_threshold(5)) << result.describe();
}

TEST(Warp, cosine_hemisphere_has_its_density) {
  expect_density(sample_cosine_hemisphere, [](Vec3f d) { return pdf_cosine_hemisphere(d.z); });
}

TEST(Warp, hemisphere_has_its_density) {
  expect_density(sample_hemisphere, [](Vec3f d) { return d.z > 0 ? pdf_hemisphere : 0; });
}

TEST(Warp, sphere_has_its_density) {
  expect_density(sample_sphere, [](Vec3f) { return pdf_sphere; });
}

TEST(Warp, cone_has_its_density) {
  for (const float one_minus_cos : {0.3f, 1e-3f})
    expect_density([=](Vec2f u) { return sample_cone(u, one_minus_cos); },
                   [=](Vec3f d) { return d.z >= 1 - one_minus_cos ? pdf_cone(one_minus_cos) : 0; });
}

TEST(Warp, narrow_cones_stay_inside_and_have_width) {
  const float angle = 0.00465f / 10;  // a tenth of the sun's disc, radians
  const float one_minus_cos = 2 * std::sin(angle / 2) * std::sin(angle / 2);
  Rng rng(7);
  double sum = 0;
  const int count = 10000;
  for (int i = 0; i < count; ++i) {
    const Vec3f d = sample_cone(test::next_unit_vec2(rng), one_minus_cos);
    EXPECT_LE(std::hypot(d.x, d.y), angle * 1.0001f);
    sum += d.x * d.x + d.y * d.y;
  }
  // Uniform on a disc of radius r, the mean of the squared distance is r^2 / 2.
  EXPECT_NEAR(sum / count, angle * angle / 2, 0.02 * angle * angle);
}

TEST(Warp, disk_is_uniform) {
  const auto result = test::chi_square_square(
      [](Rng& rng) -> std::optional<Vec2d> {
        return (Vec2d(sample_disk(test::next_unit_vec2(rng))) + Vec2d{1, 1}) * 0.5;
      },
      [](Vec2d p) {
        const Vec2d d = p * 2.0 - Vec2d{1, 1};
        return d.x * d.x + d.y * d.y < 1 ? 4 * pdf_disk : 0;
      });
  EXPECT_GT(result.p_value, 1e-3) << result.describe();
}

TEST(Warp, triangle_is_uniform) {
  const auto result = test::chi_square_square(
      [](Rng& rng) -> std::optional<Vec2d> { return Vec2d(sample_triangle(test::next_unit_vec2(rng))); },
      [](Vec2d p) { return p.x + p.y < 1 ? 2 : 0; });
  EXPECT_GT(result.p_value, 1e-3) << result.describe();
}

TEST(Warp, cosine_hemisphere_never_gives_a_direction_without_density) {
  for (const float x : {0.0f, 0.5f, one_minus_epsilon})
    for (const float y : {0.0f, 0.5f, one_minus_epsilon}) EXPECT_GT(sample_cosine_hemisphere({x, y}).z, 0);
}

}  // namespace
}  // namespace basicrt
