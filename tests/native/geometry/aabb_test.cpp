// SPDX-License-Identifier: GPL-3.0-or-later
// The slab test against the same test in extended precision: it may report a box that is barely missed, but never
// loses one that is touched.
#include "geometry/aabb.h"

#include <gtest/gtest.h>

#include <random>

namespace basicrt {
namespace {

struct ExactInterval {
  long double entry, exit;
  [[nodiscard]] bool is_empty() const { return !(entry <= exit); }
};

// Where origin + t * direction is inside the box: differences of floats are exact here, quotients nearly.
ExactInterval intersect_exactly(Vec3d origin, Vec3d direction, const Bounds3f& box, Interval range) {
  ExactInterval result{range.entry, range.exit};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const long double o = origin[axis], d = direction[axis], lower = box.lower[axis], upper = box.upper[axis];
    if (d == 0) {
      if (o < lower || o > upper) return {1, 0};
      continue;
    }
    result.entry = std::max(result.entry, std::min((lower - o) / d, (upper - o) / d));
    result.exit = std::min(result.exit, std::max((lower - o) / d, (upper - o) / d));
  }
  return result;
}

class BoxTest : public testing::Test {
 protected:
  std::mt19937 rng_{11};

  double number() {
    const double x = std::uniform_real_distribution<double>(-1, 1)(rng_);
    switch (std::uniform_int_distribution(0, 9)(rng_)) {
      case 0:
        return 0;
      case 1:
        return -0.0;
      case 2:
        return std::round(x * 4) / 4;  // often in the plane of a box
      case 3:
        return x * 1e-30;
      case 4:
        return x * 1e-42;
      case 5:
        return x * 1e6;
      default:
        return x;
    }
  }
  Vec3d point() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  // Half of them in floats exactly, as world-space rays are.
  Vec3d origin_or_direction(int index) { return index % 2 ? point() : Vec3d(Vec3f(point())); }
  Bounds3f box() {
    Bounds3f result;
    result.extend(Vec3f(point()));
    result.extend(Vec3f(point()));
    return result;
  }
};

TEST_F(BoxTest, never_loses_a_box_that_the_ray_touches) {
  int touched = 0;
  for (int i = 0; i < 400000; ++i) {
    const Bounds3f b = box();
    const Vec3d origin = origin_or_direction(i), direction = origin_or_direction(i / 2);
    const Interval range = i % 3 ? Interval{0, std::numeric_limits<float>::max()} : Interval{0.25f, 1.5f};
    const ExactInterval exact = intersect_exactly(origin, direction, b, range);
    const auto found = intersect_box(make_box_ray(origin, direction), b, range);
    if (exact.is_empty()) continue;
    ++touched;
    ASSERT_TRUE(found) << "ray " << i;
    EXPECT_LE(found->entry, exact.entry) << "ray " << i;
    EXPECT_GE(found->exit, exact.exit) << "ray " << i;
    EXPECT_GE(found->entry, range.entry);
    EXPECT_LE(found->exit, range.exit);
  }
  EXPECT_GT(touched, 10000);
}

TEST_F(BoxTest, reports_ordinary_boxes_exactly_but_for_a_few_parts_in_a_million) {
  std::uniform_real_distribution<float> u(-1, 1);
  const auto random_point = [&] { return Vec3f{u(rng_), u(rng_), u(rng_)}; };
  int touched = 0, reported_wrongly = 0;
  for (int i = 0; i < 100000; ++i) {
    Bounds3f b;
    b.extend(random_point());
    b.extend(random_point());
    const Vec3f origin = random_point() * 4.0f, direction = random_point() - origin;
    const Interval range{0, 100};
    const auto found = intersect_box(make_box_ray(origin, direction), b, range);
    const ExactInterval exact = intersect_exactly(Vec3d(origin), Vec3d(direction), b, range);
    reported_wrongly += exact.is_empty() && found;
    if (exact.is_empty() || !found) continue;
    ++touched;
    // The origin's rounding moves planes by 2^-22 of its size, which a shallow angle stretches.
    const double tolerance = 1e-5 * (1 + 4 / double{min_component(abs(direction))});
    EXPECT_NEAR(found->entry, static_cast<double>(exact.entry), tolerance);
    EXPECT_NEAR(found->exit, static_cast<double>(exact.exit), tolerance);
  }
  EXPECT_LT(reported_wrongly, 20);
  EXPECT_GT(touched, 5000);
}

TEST(Box, rays_in_the_plane_of_a_face_touch_it) {
  const Bounds3f box{{0, 0, 0}, {1, 1, 1}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float zero : {0.0f, -0.0f})
      for (const float plane : {0.0f, -0.0f, 1.0f}) {
        Vec3f origin(0.5f), direction(zero);
        origin[axis] = plane;
        origin[(axis + 1) % 3] = -1;
        direction[(axis + 1) % 3] = 1;
        const auto found = intersect_box(make_box_ray(origin, direction), box, {});
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->entry, 1, 1e-5);
        EXPECT_NEAR(found->exit, 2, 1e-5);
      }
}

TEST(Box, axis_parallel_rays_beside_a_box_miss_it) {
  const Bounds3f box{{0, 0, 0}, {1, 1, 1}};
  for (const float zero : {0.0f, -0.0f})
    for (const float beside : {-0.001f, 1.001f}) {
      const BoxRay ray = make_box_ray(Vec3f{beside, 0.5f, -1}, Vec3f{zero, zero, 1});
      EXPECT_FALSE(intersect_box(ray, box, {.entry = 0, .exit = std::numeric_limits<float>::max()}));
    }
}

TEST(Box, is_only_seen_within_the_interval) {
  const Bounds3f box{{0, 0, 2}, {1, 1, 3}};
  const BoxRay ray = make_box_ray(Vec3f{0.5f, 0.5f, 0}, Vec3f{0, 0, 1});
  EXPECT_TRUE(intersect_box(ray, box, {0, 2}));
  EXPECT_TRUE(intersect_box(ray, box, {3, 9}));
  EXPECT_FALSE(intersect_box(ray, box, {0, 1.999f}));
  EXPECT_FALSE(intersect_box(ray, box, {3.001f, 9}));
  const auto inside = intersect_box(ray, box, {2.5f, 2.75f});
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->entry, 2.5f);
  EXPECT_EQ(inside->exit, 2.75f);
}

TEST(Box, an_empty_box_is_never_touched_and_a_point_may_be) {
  const BoxRay ray = make_box_ray(Vec3f{0, 0, -1}, Vec3f{0, 0, 1});
  EXPECT_FALSE(intersect_box(ray, Bounds3f{}, {}));
  EXPECT_TRUE(intersect_box(ray, {{0, 0, 0}, {0, 0, 0}}, {}));
}

}  // namespace
}  // namespace basicrt
