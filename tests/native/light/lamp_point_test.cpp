// SPDX-License-Identifier: GPL-3.0-or-later
// What a lamp's material sees of it: the normals and uv coordinates of each kind.
#include "light/lamp_point.h"

#include <gtest/gtest.h>

#include "math/constants.h"

namespace basicrt {
namespace {

void expect_near(Vec3f a, Vec3f b) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5f) << "component " << i;
}

void expect_uv(const SurfacePoint& point, float u, float v) {
  EXPECT_NEAR(point.uv.x, u, 1e-5f);
  EXPECT_NEAR(point.uv.y, v, 1e-5f);
  // As Parametric has it: the share of the first corner and that of the second.
  EXPECT_NEAR(1 - point.barycentrics.x - point.barycentrics.y, u, 1e-5f);
  EXPECT_NEAR(point.barycentrics.x, v, 1e-5f);
}

SurfacePoint seen_from(const Lamp& lamp, Vec3f position, Vec3f place) {
  const Vec3f way = place - position;
  return lamp_point(lamp, position, normalize(way), length(way), 0.25f);
}

TEST(LampPoint, of_an_area_lamp_is_on_its_plate) {
  Transform wide;
  wide.rows = {{{4, 0, 0, 1}, {0, 2, 0, 0}, {0, 0, 1, 3}}};
  const SurfacePoint point = seen_from(AreaLight{.to_world = wide}, {1, 0, 0}, {2, -0.5f, 3});
  expect_near(point.position, {2, -0.5f, 3});
  expect_near(point.geometric_normal, {0, 0, -1});
  expect_uv(point, 0.75f, 0.25f);
  EXPECT_FALSE(point.is_backfacing);
  EXPECT_EQ(point.time, 0.25f);
  EXPECT_NEAR(point.t, std::sqrt(1 + 0.25f + 9), 1e-5f);
}

TEST(LampPoint, of_a_sphere_has_the_sphere_s_normal_and_of_others_whoever_looks) {
  const PointLight sphere{.position = {0, 0, 2}, .radius = 0.5f};
  expect_near(seen_from(sphere, {3, 0, 2}, {0.5f, 0, 2}).geometric_normal, {1, 0, 0});
  PointLight disc = sphere;
  disc.is_soft = true;
  const Vec3f towards = normalize(Vec3f{3, 0, -0.3f});
  expect_near(seen_from(disc, {3, 0, 2}, {0, 0, 2.3f}).geometric_normal, towards);
  expect_near(seen_from(PointLight{.position = {0, 0, 2}}, {0, 0, 0}, {0, 0, 2}).geometric_normal, {0, 0, -1});
}

TEST(LampPoint, within_a_sphere_is_on_its_back) {
  const PointLight sphere{.position = {0, 0, 0}, .radius = 2};
  const SurfacePoint point = seen_from(sphere, {0.5f, 0, 0}, {2, 0, 0});
  EXPECT_TRUE(point.is_backfacing);
  expect_near(point.geometric_normal, {1, 0, 0});
}

TEST(LampPoint, uv_of_a_point_lamp_goes_round_its_object) {
  const PointLight lamp{.position = {0, 0, 0}};
  // Longitude from -y towards +x, latitude from -z up.
  expect_uv(seen_from(lamp, {0, 1, 0}, {0, 0, 0}), 0.5f, 0.5f);
  expect_uv(seen_from(lamp, {1, 0, 0}, {0, 0, 0}), 0.25f, 0.5f);
  EXPECT_NEAR(seen_from(lamp, {0, 0, -1}, {0, 0, 0}).uv.y, 0, 1e-5f);
  PointLight turned = lamp;
  turned.object_to_world.rows = {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}};  // its y axis is -x
  expect_uv(seen_from(turned, {-1, 0, 0}, {0, 0, 0}), 0.5f, 0.5f);
}

TEST(LampPoint, uv_of_a_spot_is_the_picture_that_fills_its_cone) {
  const SpotLight lamp{.to_world = {}, .angle = 1};
  const float edge = std::tan(0.5f);
  expect_uv(seen_from(lamp, {0, 0, -2}, {0, 0, 0}), 0.5f, 0.5f);
  expect_uv(seen_from(lamp, {2 * edge, 0, -2}, {0, 0, 0}), 1, 0.5f);
  expect_uv(seen_from(lamp, {0, -2 * edge, -2}, {0, 0, 0}), 0.5f, 0);
}

TEST(LampPoint, of_a_sun_is_the_direction_of_its_light) {
  const SunLight lamp{.direction = {0, 0, -1}, .angle = 0.4f};
  const Vec3f edge{std::sin(0.2f), 0, std::cos(0.2f)};
  const SurfacePoint point = lamp_point(lamp, {5, 6, 7}, edge, infinity, 0);
  expect_near(point.position, -edge);
  expect_near(point.geometric_normal, -edge);
  EXPECT_TRUE(std::isfinite(point.t));
  expect_uv(point, 1, 0.5f);
  expect_uv(lamp_point(lamp, {}, {0, 0, 1}, infinity, 0), 0.5f, 0.5f);
  expect_uv(lamp_point(SunLight{.direction = {0, 0, -1}}, {}, {0, 0, 1}, infinity, 0), 0.5f, 0.5f);
}

}  // namespace
}  // namespace basicrt
