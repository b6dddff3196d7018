// SPDX-License-Identifier: GPL-3.0-or-later
// Rays that leave a surface name the triangle that they start on.
#include "integrator/hit_shading.h"

#include <gtest/gtest.h>

namespace basicrt {
namespace {

SurfacePoint point_on_triangle() {
  SurfacePoint point;
  point.geometric_normal = {0, 0, 1};
  point.instance = 7;
  point.primitive = 3;
  return point;
}

TEST(HitShading, a_ray_names_the_triangle_it_leaves) {
  const SurfacePoint point = point_on_triangle();
  for (const Ray& ray : {spawn_ray(point, {0, 0, 1}, ray_diffuse, 0), spawn_shadow_ray(point, {0, 0, 1}, 2, 0)}) {
    EXPECT_EQ(ray.from_instance, 7u);
    EXPECT_EQ(ray.from_primitive, 3u);
  }
}

TEST(HitShading, a_ray_that_leaves_a_sphere_may_hit_it_again) {
  SurfacePoint point = point_on_triangle();
  point.primitive = Hit::none;
  const Ray ray = spawn_ray(point, {0, 0, 1}, ray_diffuse, 0);
  EXPECT_EQ(ray.from_instance, Hit::none);
  EXPECT_EQ(ray.from_primitive, Hit::none);
}

TEST(HitShading, a_ray_that_goes_on_names_what_it_leaves_behind_and_never_goes_back) {
  const Vec3f origin{1, 2, 3};
  Ray ray{.origin = origin, .t_min = 0.5f};
  continue_behind(ray, {.t = 2}, point_on_triangle());
  EXPECT_EQ(ray.origin, origin);
  EXPECT_GT(ray.t_min, 2);
  EXPECT_EQ(ray.from_primitive, 3u);
  // A tracer that rounds may find the next surface a little before the last one.
  const float t_min = ray.t_min;
  continue_behind(ray, {.t = 1.99999f}, point_on_triangle());
  EXPECT_GT(ray.t_min, t_min);
}

}  // namespace
}  // namespace basicrt
