// SPDX-License-Identifier: GPL-3.0-or-later
// Points and curves against testing everything, closed forms, and shapes with nothing to hit.
#include "bvh/round_trees.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "bvh/curve_reference.h"
#include "bvh/test_scenes.h"
#include "geometry/surface_point.h"
#include "support/effort.h"

namespace basicrt {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

Hit trace(const Tracer& tracer, const Ray& ray) {
  Hit hit;
  std::uint8_t occluded = 0;
  tracer.intersect({&ray, 1}, {&hit, 1});
  tracer.occluded({&ray, 1}, {&occluded, 1});
  EXPECT_EQ(occluded, hit.is_hit());
  return hit;
}

Tracer make_tracer(const Shape& shape) { return test::make_tracer({shape}, {test::place(0, {})}, {}); }

// Curves that wander about, thicker here and thinner there.
Curves random_curves(test::Random& rng, int count, float step, float radius, CurveForm form) {
  Curves curves;
  curves.form = form;
  for (int i = 0; i < count; ++i) {
    curves.firsts.push_back(static_cast<std::uint32_t>(curves.points.size()));
    Vec3f point = test::random_point(rng), direction = test::random_point(rng);
    const int points = std::uniform_int_distribution(2, 7)(rng);
    for (int k = 0; k < points; ++k) {
      curves.points.push_back(point);
      curves.radii.push_back(radius * test::uniform(rng, 0.3f, 1));
      direction = normalize(direction + test::random_point(rng, 0.6f));
      point += direction * step;
    }
  }
  return curves;
}

PointCloud random_points(test::Random& rng, int count) {
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    cloud.positions.push_back(test::random_point(rng));
    cloud.radii.push_back(i % 10 == 0 ? 0 : test::uniform(rng, 0.001f, 0.1f));
  }
  return cloud;
}

struct Comparison {
  int hits = 0, unlike = 0;
};

// Of the tree with the reference; what it says of rays that graze isn't compared.
Comparison compare(const Curves& curves, test::Random& rng, int rays) {
  const Tracer tracer = make_tracer(curves);
  Comparison result;
  for (int i = 0; i < rays; ++i) {
    const Ray ray = test::random_ray(rng);
    const auto expected = test::reference_hit(curves, transform_ray({}, ray));
    const Hit hit = trace(tracer, ray);
    if (expected && expected->depth < 1e-3) continue;
    result.hits += expected.has_value();
    if (expected.has_value() != hit.is_hit()) {
      ++result.unlike;
    } else if (expected) {
      const bool is_near = std::abs(double{hit.t} - expected->t) < 1e-6 * std::max(1.0, expected->t);
      result.unlike += !is_near;
    }
  }
  return result;
}

// One test for each step and radius, which can run side by side.
class RoundCurves : public testing::TestWithParam<std::pair<float, float>> {};

TEST_P(RoundCurves, agree_with_trying_all_places) {
  const auto [step, radius] = GetParam();
  test::Random rng(1);
  const int rays = test::tries(3000);
  const Comparison result = compare(random_curves(rng, 30, step, radius, CurveForm::round), rng, rays);
  EXPECT_GT(result.hits, rays / 50);
  EXPECT_LE(result.unlike, 1) << "of " << result.hits;  // that meets a bend twice
}

INSTANTIATE_TEST_SUITE_P(CurveTree, RoundCurves,
                         testing::Values(std::pair{0.15f, 0.03f}, std::pair{0.3f, 0.01f}, std::pair{0.05f, 0.04f}));

TEST(CurveTree, agrees_with_trying_all_places_on_ribbons) {
  test::Random rng(2);
  const int rays = test::tries(3000);
  const Comparison result = compare(random_curves(rng, 30, 0.2f, 0.03f, CurveForm::ribbon), rng, rays);
  EXPECT_GT(result.hits, rays / 30);
  EXPECT_EQ(result.unlike, 0) << result.hits;
}

// The ray against the cylinder and the spheres at its ends, in closed form.
std::optional<double> hit_capsule(const PreciseRay& ray, Vec3d begin, Vec3d end, float radius) {
  std::optional<double> nearest;
  const auto consider = [&](double t) {
    if (t >= ray.t_min && t <= ray.t_max && (!nearest || t < *nearest)) nearest = t;
  };
  const Vec3d axis = normalize(end - begin), from = ray.origin - begin;
  const Vec3d across = ray.direction - axis * dot(ray.direction, axis), off = from - axis * dot(from, axis);
  const double a = length_squared(across), b = dot(across, off), c = length_squared(off) - double{radius} * radius;
  if (const double discriminant = b * b - a * c; discriminant >= 0) {
    const double t = (-b - std::sqrt(discriminant)) / a, along = dot(from + ray.direction * t, axis);
    if (along >= 0 && along <= length(end - begin)) consider(t);
  }
  for (const Vec3d center : {begin, end}) {
    PreciseRay copy = ray;
    copy.t_max = std::numeric_limits<float>::max();
    const auto t = intersect_sphere(copy, Sphere{Vec3f(center), radius});
    // Not the far side of the sphere.
    if (t && dot(ray.direction, ray.origin + ray.direction * *t - center) < 0) consider(*t);
  }
  return nearest;
}

TEST(CurveTree, a_straight_curve_is_a_cylinder_with_round_ends) {
  test::Random rng(3);
  const Vec3f begin{-0.5f, 0.25f, 0}, end{0.5f, -0.25f, 0.5f};
  Curves curves;
  for (int i = 0; i <= 4; ++i) curves.points.push_back(begin + (end - begin) * (static_cast<float>(i) / 4));
  curves.radii.assign(5, 0.25f);
  curves.firsts = {0};
  const Tracer tracer = make_tracer(curves);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray = test::random_ray(rng);
    if (length(ray.origin) < 1) continue;  // not from inside
    ray.t_min = 0;
    const auto expected = hit_capsule(transform_ray({}, ray), Vec3d(begin), Vec3d(end), 0.25f);
    const Hit hit = trace(tracer, ray);
    ASSERT_EQ(hit.is_hit(), expected.has_value()) << i;
    if (!expected) continue;
    ++hits;
    EXPECT_NEAR(double{hit.t}, *expected, 1e-6 * std::max(1.0, *expected)) << i;
  }
  EXPECT_GT(hits, 2000);
}

TEST(CurveTree, rays_between_two_segments_find_no_gap) {
  Curves curves{
      .points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, .radii = {0.1f, 0.1f, 0.1f, 0.1f}, .firsts = {0}};
  for (const CurveForm form : {CurveForm::round, CurveForm::ribbon}) {
    curves.form = form;
    const Tracer tracer = make_tracer(curves);
    for (int i = 1; i < 300; ++i) {
      const float x = static_cast<float>(i) / 100;
      EXPECT_TRUE(trace(tracer, {.origin = {x, 0.05f, 5}, .direction = {0, 0, -1}}).is_hit()) << x;
    }
  }
}

TEST(CurveTree, a_ribbon_faces_the_ray_and_tells_where_across_it_was_hit) {
  const Curves curves{
      .points = {{0, 0, 0}, {4, 0, 0}}, .radii = {0.5f, 0.5f}, .firsts = {0}, .form = CurveForm::ribbon};
  const Tracer tracer = make_tracer(curves);
  for (const float y : {-0.45f, -0.2f, 0.1f, 0.4f}) {
    const Ray ray{.origin = {2, y, 5}, .direction = {0, 0, -1}};
    const Hit hit = trace(tracer, ray);
    ASSERT_TRUE(hit.is_hit());
    EXPECT_FLOAT_EQ(hit.t, 5);
    EXPECT_NEAR(std::abs(hit.v), std::abs(y) / 0.5f, 1e-6f);
    const SurfacePoint point = make_surface_point(curves, Placement(), ray, hit);
    EXPECT_NEAR(point.shading_normal.y, y / 0.5f, 1e-5f);  // as on a cylinder
  }
  EXPECT_FALSE(trace(tracer, {.origin = {2, 0.51f, 5}, .direction = {0, 0, -1}}).is_hit());
}

TEST(CurveTree, rays_that_leave_a_curve_never_meet_it_again_where_it_is_straight) {
  test::Random rng(4);
  const Curves curves{
      .points = {{100, 3, 0}, {100.5f, 3.25f, 0}, {101, 3.5f, 0}}, .radii = {0.02f, 0.02f, 0.02f}, .firsts = {0}};
  const Tracer tracer = make_tracer(curves);
  int tried = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f origin = test::random_point(rng, 2) + Vec3f{100.5f, 3.25f, 0};
    const Vec3f target = Vec3f{100.5f, 3.25f, 0} + test::random_point(rng, 0.1f);
    const Ray ray{.origin = origin, .direction = normalize(target - origin)};
    const Hit hit = trace(tracer, ray);
    if (!hit.is_hit()) continue;
    const SurfacePoint point = make_surface_point(curves, Placement(), ray, hit);
    // To either side: rays that go inside leave freely.
    const Vec3f direction = normalize(test::random_point(rng));
    ++tried;
    EXPECT_FALSE(trace(tracer, {.origin = offset_origin(point, direction), .direction = direction}).is_hit()) << i;
  }
  EXPECT_GT(tried, 1000);
}

TEST(CurveTree, degenerate_curves_are_hit_where_something_is_left_of_them) {
  const Ray ray{.origin = {0, 0, 5}, .direction = {0, 0, -1}};
  const auto hit = [&](std::vector<Vec3f> points, std::vector<float> radii, std::vector<std::uint32_t> firsts) {
    const Curves curves{.points = std::move(points), .radii = std::move(radii), .firsts = std::move(firsts)};
    validate(curves, "curves");
    return trace(make_tracer(curves), ray);
  };
  EXPECT_FALSE(hit({}, {}, {}).is_hit());
  EXPECT_FALSE(hit({{0, 0, 0}}, {1}, {0}).is_hit());                             // of one point
  EXPECT_FALSE(hit({{0, 0, 0}, {1, 0, 0}}, {0, 0}, {0}).is_hit());               // as thin as a line
  EXPECT_FLOAT_EQ(hit({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {1, 1, 1}, {0}).t, 4);  // a sphere
  EXPECT_FLOAT_EQ(hit({{0, 0, 0}, {0, 0, 1}}, {0.5f, 0.5f}, {0}).t, 3.5f);       // along the ray
  EXPECT_FLOAT_EQ(hit({{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {3, 0, 1}}, {1, 1, 1, 1}, {0}).t,
                  4);  // stands still for a while
  EXPECT_TRUE(hit({{0, 0, 0}, {9, 9, 9}, {0, 0, 0}, {0, 0, 1}}, {1, 1, 1, 1}, {0, 2}).is_hit());
}

TEST(CurveTree, odd_rays_miss) {
  const Curves curves{.points = {{0, 0, 0}, {1, 0, 0}}, .radii = {1, 1}, .firsts = {0}};
  PointCloud cloud{.positions = {{0, 0, 0}}, .radii = {1}};
  for (const Shape& shape : {Shape(curves), Shape(cloud)}) {
    const Tracer tracer = make_tracer(shape);
    EXPECT_FALSE(trace(tracer, {.origin = {nan, 0, 5}, .direction = {0, 0, -1}}).is_hit());
    EXPECT_FALSE(trace(tracer, {.origin = {0, 0, 5}, .direction = {0, nan, -1}}).is_hit());
    EXPECT_FALSE(trace(tracer, {.origin = {0, 0, 5}, .direction = {0, 0, 0}}).is_hit());
    EXPECT_FALSE(trace(tracer, {.origin = {0, 0, 5}, .direction = {0, 0, -infinity}}).is_hit());
    EXPECT_FALSE(trace(tracer, {.origin = {0, 0, 5}, .direction = {0, 0, 1}}).is_hit());
    EXPECT_FALSE(trace(tracer, {.origin = {0, 0, 5}, .direction = {0, 0, -1}, .t_max = 3}).is_hit());
    EXPECT_TRUE(trace(tracer, {.origin = {0, 0, 5}, .direction = {0, 0, -1}}).is_hit());
  }
}

TEST(PointTree, has_the_hits_of_single_spheres) {
  test::Random rng(5);
  const PointCloud cloud = random_points(rng, 300);
  std::vector<Shape> shapes;
  std::vector<TracedInstance> instances;
  for (std::uint32_t i = 0; i < cloud.positions.size(); ++i) {
    if (cloud.radii[i] == 0) continue;
    instances.push_back(test::place(static_cast<std::uint32_t>(shapes.size()), {}));
    shapes.emplace_back(Sphere{cloud.positions[i], cloud.radii[i]});
  }
  const Tracer together = make_tracer(cloud), alone = test::make_tracer(shapes, instances, {});
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = test::random_ray(rng);
    const Hit hit = trace(together, ray), expected = trace(alone, ray);
    ASSERT_EQ(hit.is_hit(), expected.is_hit());
    if (!hit.is_hit()) continue;
    ++hits;
    EXPECT_EQ(hit.t, expected.t);
    EXPECT_EQ(hit.u, expected.u);
    EXPECT_EQ(hit.v, expected.v);
    const SurfacePoint point = make_surface_point(cloud, Placement(), ray, hit);
    const SurfacePoint of_sphere = make_surface_point(shapes[expected.instance], Placement(), ray, expected);
    EXPECT_EQ(point.position, of_sphere.position);
    EXPECT_EQ(point.shading_normal, of_sphere.shading_normal);
    EXPECT_EQ(point.primitive, hit.primitive);
  }
  EXPECT_GT(hits, 500);
}

TEST(PointTree, of_equal_points_the_first_is_hit) {
  PointCloud cloud;
  cloud.positions.assign(50, {0.25f, 0, 0});
  cloud.radii.assign(50, 0.5f);
  const Hit hit = trace(make_tracer(cloud), {.origin = {0, 0, 5}, .direction = {0, 0, -1}});
  EXPECT_EQ(hit.primitive, 0u);
}

TEST(RoundTrees, are_the_same_for_all_builders_and_any_number_of_threads) {
  test::Random rng(6);
  const Shape shapes[] = {Shape(random_points(rng, 400)), Shape(random_curves(rng, 60, 0.2f, 0.02f, CurveForm::round)),
                          Shape(random_curves(rng, 60, 0.2f, 0.02f, CurveForm::ribbon))};
  for (const Shape& shape : shapes) {
    const TracedInstance placed = test::place(0, test::random_transform(rng));
    const Tracer first = test::make_tracer({shape}, {placed}, {.threads = 1});
    for (const BvhConfig config :
         {BvhConfig{.builder = BvhBuilder::median}, BvhConfig{.builder = BvhBuilder::split_sah},
          BvhConfig{.threads = 3}, BvhConfig{.leaf_size = 1}}) {
      const Tracer other = test::make_tracer({shape}, {placed}, config);
      for (int i = 0; i < 1000; ++i) {
        const Ray ray = test::random_ray(rng);
        EXPECT_TRUE(test::is_identical(trace(first, ray), trace(other, ray))) << i;
      }
    }
  }
}

}  // namespace
}  // namespace basicrt
