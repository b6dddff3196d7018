// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against triangles and spheres: closed forms, limits, and agreement with extended precision.
#include "geometry/triangle.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/sphere.h"

namespace basicrt {
namespace {

constexpr Vec3f p0{0, 0, 0}, p1{1, 0, 0}, p2{0, 1, 0};

PreciseRay down_at(double x, double y) { return {.origin = {x, y, 2}, .direction = {0, 0, -1}, .t_max = 1e30}; }

TEST(Triangle, is_hit_inside_and_on_its_edges_only) {
  const auto is_hit = [](double x, double y) {
    PreciseRay ray = down_at(x, y);
    return intersect_triangle(ray, p0, p1, p2).has_value();
  };
  const double tiny = 1e-12;
  for (const auto& [x, y] :
       {std::pair{0.2, 0.3}, {0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.5, 0.5}, {0.0, 0.5}, {0.5, 0.0}})
    EXPECT_TRUE(is_hit(x, y)) << x << " " << y;
  for (const auto& [x, y] : {std::pair{-tiny, 0.5}, {0.5, -tiny}, {0.5 + tiny, 0.5}, {1 + tiny, 0.0}, {0.0, 1 + tiny}})
    EXPECT_FALSE(is_hit(x, y)) << x << " " << y;
}

TEST(Triangle, gives_distance_and_barycentrics_and_shrinks_the_ray) {
  PreciseRay ray = down_at(0.25, 0.5);
  const auto hit = intersect_triangle(ray, p0, p1, p2);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 2);
  EXPECT_EQ(hit->u, 0.25);
  EXPECT_EQ(hit->v, 0.5);
  EXPECT_EQ(ray.t_max, 2);
}

TEST(Triangle, counts_on_both_sides) {
  PreciseRay up{.origin = {0.25, 0.5, -1}, .direction = {0, 0, 1}, .t_max = 10};
  EXPECT_TRUE(intersect_triangle(up, p0, p1, p2));
}

TEST(Triangle, honours_both_ends_of_the_interval) {
  const auto is_hit = [](double t_min, double t_max) {
    PreciseRay ray = down_at(0.25, 0.5);
    ray.t_min = t_min;
    ray.t_max = t_max;
    return intersect_triangle(ray, p0, p1, p2).has_value();
  };
  EXPECT_TRUE(is_hit(2, 2));
  EXPECT_FALSE(is_hit(std::nextafter(2.0, 3.0), 9));
  EXPECT_FALSE(is_hit(0, std::nextafter(2.0, 0.0)));
}

TEST(Triangle, a_miss_leaves_the_ray_alone) {
  PreciseRay ray = down_at(2, 2);
  EXPECT_FALSE(intersect_triangle(ray, p0, p1, p2));
  EXPECT_EQ(ray.t_max, 1e30);
}

TEST(Triangle, parallel_rays_lines_and_points_are_no_hit) {
  PreciseRay in_plane{.origin = {-1, 0.25, 0}, .direction = {1, 0, 0}, .t_max = 10};
  EXPECT_FALSE(intersect_triangle(in_plane, p0, p1, p2));
  PreciseRay ray = down_at(0, 0);
  EXPECT_FALSE(intersect_triangle(ray, p0, p0, p0));
  EXPECT_FALSE(intersect_triangle(ray, p0, p1, {2, 0, 0}));
  PreciseRay nan = down_at(std::numeric_limits<double>::quiet_NaN(), 0.2);
  EXPECT_FALSE(intersect_triangle(nan, p0, p1, p2));
}

// The point of the hit computed along the ray and from the barycentrics must be the same.
TEST(Triangle, distance_and_barycentrics_agree_on_the_point) {
  std::mt19937 rng(21);
  std::uniform_real_distribution<float> u(-1, 1);
  const auto random_point = [&] { return Vec3f{u(rng), u(rng), u(rng)}; };
  int hits = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f a = random_point(), b = random_point(), c = random_point();
    const Vec3d origin = Vec3d(random_point()) * 3.0;
    PreciseRay ray{.origin = origin, .direction = Vec3d(random_point()) - origin, .t_max = 100};
    const auto hit = intersect_triangle(ray, a, b, c);
    if (!hit) continue;
    ++hits;
    const Vec3d along = ray.origin + ray.direction * hit->t;
    const Vec3d across = Vec3d(a) * (1 - hit->u - hit->v) + Vec3d(b) * hit->u + Vec3d(c) * hit->v;
    const Vec3d normal = cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
    const double conditioning = length(normal) * length(ray.direction) / std::abs(dot(ray.direction, normal));
    EXPECT_LT(length(along - across), 1e-13 * conditioning / length(normal)) << i;
  }
  EXPECT_GT(hits, 1000);
}

TEST(SphereIntersection, finds_the_nearer_then_the_farther_point) {
  const Sphere sphere{{0, 0, 5}, 2};
  PreciseRay ray{.origin = {0, 0, 0}, .direction = {0, 0, 2}, .t_max = 100};
  EXPECT_EQ(intersect_sphere(ray, sphere), 1.5);
  EXPECT_EQ(ray.t_max, 1.5);
  PreciseRay later{.origin = {0, 0, 0}, .direction = {0, 0, 2}, .t_min = 1.6, .t_max = 100};
  EXPECT_EQ(intersect_sphere(later, sphere), 3.5);
  PreciseRay inside{.origin = {0, 0, 5}, .direction = {0, 0, 2}, .t_max = 100};
  EXPECT_EQ(intersect_sphere(inside, sphere), 1);
  PreciseRay past{.origin = {0, 0, 8}, .direction = {0, 0, 2}, .t_max = 100};
  EXPECT_FALSE(intersect_sphere(past, sphere));
  PreciseRay short_of_it{.origin = {0, 0, 0}, .direction = {0, 0, 2}, .t_max = 1.4};
  EXPECT_FALSE(intersect_sphere(short_of_it, sphere));
}

TEST(SphereIntersection, hits_lie_on_the_sphere_even_when_it_is_small_and_far) {
  std::mt19937 rng(22);
  std::normal_distribution<double> gauss;
  for (const double distance : {2.0, 1e3, 1e6}) {
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d from = normalize(Vec3d{gauss(rng), gauss(rng), gauss(rng)});
      const Vec3d aim = Vec3d{gauss(rng), gauss(rng), gauss(rng)} * 0.4;
      PreciseRay ray{.origin = from * distance, .direction = aim - from * distance, .t_max = 2};
      const auto t = intersect_sphere(ray, Sphere{{0, 0, 0}, 1});
      const Vec3d d = ray.direction;
      const double miss = length(cross(d, ray.origin)) / length(d);
      const bool is_clear = std::abs(miss - 1) > 1e-9;
      EXPECT_TRUE(!is_clear || t.has_value() == (miss < 1));
      if (!t) continue;
      ++hits;
      const double cosine = std::sqrt(std::max(1e-9, 1 - miss * miss));
      EXPECT_NEAR(length(ray.origin + d * *t), 1, 1e-14 * distance / cosine);
    }
    EXPECT_GT(hits, 1000);
  }
}

TEST(SphereIntersection, rays_with_nan_or_no_direction_miss) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec3d direction : {Vec3d(0), Vec3d{nan, 0, 1}}) {
    PreciseRay ray{.origin = {0, 0, -3}, .direction = direction, .t_max = 100};
    EXPECT_FALSE(intersect_sphere(ray, Sphere{}));
  }
}

TEST(SphereUv, is_longitude_and_latitude_with_poles_on_z) {
  EXPECT_EQ(sphere_uv({1, 0, 0}), Vec2d(0, 0.5));
  EXPECT_EQ(sphere_uv({0, 1, 0}), Vec2d(0.25, 0.5));
  EXPECT_EQ(sphere_uv({-1, 0, 0}), Vec2d(0.5, 0.5));
  EXPECT_EQ(sphere_uv({0, -1, 0}), Vec2d(0.75, 0.5));
  EXPECT_EQ(sphere_uv({0, 0, 1}).y, 1);
  EXPECT_EQ(sphere_uv({0, 0, -1}).y, 0);
}

}  // namespace
}  // namespace basicrt
