// SPDX-License-Identifier: GPL-3.0-or-later
// The tracer against testing every primitive: the same hits, bit for bit, whatever the trees look like.
#include "bvh/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bvh/hit_fault.h"
#include "bvh/kernels/chosen_kernel.h"
#include "bvh/test_scenes.h"

namespace basicrt {
namespace {

struct NamedBuilder {
  BvhBuilder builder;
  const char* name;
};
constexpr NamedBuilder builders[] = {
    {BvhBuilder::median, "median"}, {BvhBuilder::binned_sah, "binned SAH"}, {BvhBuilder::split_sah, "split SAH"}};

// Every kernel that this machine has.
std::vector<const Kernel*> kernels() {
  std::vector<const Kernel*> result;
  for (const char* name : {"avx512", "avx2", "sse42", "scalar"})
    if (const Kernel* kernel = find_kernel(name)) result.push_back(kernel);
  return result;
}

// Compares `count` rays and returns how many hit anything, so that callers can see that the test tested something.
int compare_with_brute_force(const std::vector<Shape>& shapes, const std::vector<TracedInstance>& instances,
                             const std::vector<Ray>& rays, const std::string& name) {
  std::vector<Hit> expected;
  for (const Ray& ray : rays) expected.push_back(test::brute_force(shapes, instances, ray));
  for (const auto& [builder, builder_name] : builders) {
    Tracer tracer = test::make_tracer(shapes, instances, {.builder = builder});
    std::vector<Hit> first_hits;
    for (const Kernel* kernel : kernels()) {
      SCOPED_TRACE(name + ", " + builder_name + ", " + kernel->name);
      tracer.use(*kernel);
      std::vector<Hit> hits(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      tracer.intersect(rays, hits);
      tracer.occluded(rays, occluded);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(test::find_hit_fault(hits[i], expected[i], shapes, instances, rays[i]), "")
            << "ray " << i << ": t " << hits[i].t << " instead of " << expected[i].t << ", primitive "
            << hits[i].primitive << " instead of " << expected[i].primitive;
        EXPECT_EQ(occluded[i], hits[i].is_hit()) << "ray " << i;
        if (testing::Test::HasFailure()) return 0;
      }
      if (first_hits.empty()) first_hits = hits;
      for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_TRUE(test::is_identical(hits[i], first_hits[i])) << "ray " << i << " depends on the kernel";
    }
  }
  return static_cast<int>(std::count_if(expected.begin(), expected.end(), [](const Hit& hit) { return hit.is_hit(); }));
}

std::vector<Ray> random_rays(test::Random& rng, int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(test::random_ray(rng));
  return rays;
}

TEST(Tracer, agrees_with_brute_force_on_every_kind_of_shape) {
  test::Random rng(1);
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng)) {
    const int hits = compare_with_brute_force({shape}, {test::place(0, {})}, random_rays(rng, 2000), name);
    const bool is_visible = name != "empty mesh" && name != "denormal";
    EXPECT_GT(hits, is_visible ? 50 : -1) << name;
  }
}

TEST(Tracer, agrees_with_brute_force_on_rays_through_shared_corners_and_edges) {
  test::Random rng(2);
  const Mesh grid = test::flat_grid(16);
  std::vector<Ray> rays;
  for (const Vec3f& target : grid.positions) {
    const Vec3f origin = test::random_point(rng, 3) + Vec3f{0, 0, 4};
    rays.push_back({.origin = origin, .direction = target - origin});
    rays.push_back({.origin = {target.x, target.y, 1}, .direction = {0, 0, -1}});
    rays.push_back({.origin = {target.x, -2, 0}, .direction = {0, 1, 0}});  // in the plane
  }
  EXPECT_GT(compare_with_brute_force({grid}, {test::place(0, {})}, rays, "grid"), 500);
}

TEST(Tracer, agrees_with_brute_force_on_a_mesh_below_the_normal_floats) {
  test::Random rng(3);
  const Mesh mesh = test::denormal(rng);
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f origin = test::random_point(rng) * 3e-40f;
    rays.push_back({.origin = origin, .direction = test::random_point(rng) * 1e-40f - origin});
    rays.push_back({.origin = origin, .direction = test::random_point(rng)});
  }
  EXPECT_GT(compare_with_brute_force({mesh}, {test::place(0, {})}, rays, "denormal"), 500);
}

TEST(Tracer, agrees_with_brute_force_on_instances_under_any_transform) {
  test::Random rng(4);
  std::vector<Shape> shapes;
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng)) shapes.push_back(shape);
  std::vector<TracedInstance> instances;
  for (std::uint32_t shape = 0; shape < shapes.size(); ++shape)
    for (int copy = 0; copy < 3; ++copy) instances.push_back(test::place(shape, test::random_transform(rng)));
  const TransformD mirrored({{{-1, 0, 0, 0.5}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
  const TransformD sheared({{{1, 0.9, 0, 0}, {0, 1, 0.7, -0.2}, {0, 0, 1, 0}}});
  const TransformD nearly_flat({{{1, 0, 0, 0}, {0, 1e-6, 0, 0.1}, {0, 0, 1, 0}}});
  const TransformD far_away({{{1, 0, 0, 1000}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
  for (const TransformD& transform : {mirrored, sheared, nearly_flat, far_away})
    instances.push_back(test::place(0, transform));
  EXPECT_GT(compare_with_brute_force(shapes, instances, random_rays(rng, 2000), "instances"), 500);
}

std::vector<Ray> random_rays_over_time(test::Random& rng, int count) {
  std::vector<Ray> rays = random_rays(rng, count);
  for (Ray& ray : rays) ray.time = test::random_time(rng);
  return rays;
}

TEST(Tracer, agrees_with_brute_force_on_instances_that_move) {
  test::Random rng(10);
  std::vector<Shape> shapes;
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng)) shapes.push_back(shape);
  std::vector<TracedInstance> instances;
  for (std::uint32_t shape = 0; shape < shapes.size(); ++shape)
    for (const std::size_t keys : {2, 3, 5}) {
      std::vector<TransformD> motion;
      for (std::size_t key = 0; key < keys; ++key) motion.push_back(test::random_transform(rng));
      instances.push_back(test::place_moving(shape, motion));
    }
  TransformD moved;
  moved.rows[0][3] = 0.7;
  instances.push_back(test::place_moving(0, {TransformD{}, moved}));
  instances.push_back(test::place(1, test::random_transform(rng)));
  EXPECT_GT(compare_with_brute_force(shapes, instances, random_rays_over_time(rng, 2000), "moving"), 500);
}

TEST(Tracer, agrees_with_brute_force_on_meshes_that_deform) {
  test::Random rng(11);
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng)) {
    const auto* mesh = std::get_if<Mesh>(&shape);
    if (mesh == nullptr) continue;
    const float reach = name == "denormal" ? 1e-40f : 0.3f;
    const Mesh deforming = test::deforming(rng, *mesh, name == "flat grid" ? 4 : 1, reach);
    std::vector<Ray> rays = random_rays_over_time(rng, 1500);
    const int hits = compare_with_brute_force({deforming}, {test::place(0, {})}, rays, name);
    EXPECT_GT(hits, name != "empty mesh" && name != "denormal" ? 30 : -1) << name;
    const std::vector<TracedInstance> placed{
        test::place(0, test::random_transform(rng)),
        test::place_moving(0, {test::random_transform(rng), test::random_transform(rng)})};
    compare_with_brute_force({deforming}, placed, rays, name + ", placed");
  }
}

TEST(Tracer, finds_what_moves_only_where_it_is_at_the_ray_s_time) {
  TransformD aside;
  aside.rows[0][3] = 10;
  Mesh grid = test::flat_grid(1);
  std::vector<Vec3f> positions_aside = grid.positions;
  for (Vec3f& position : positions_aside) position.x += 10;
  Mesh deforming = grid;
  deforming.motion_positions = {positions_aside};
  const Tracer moving = test::make_tracer({grid}, {test::place_moving(0, {TransformD{}, aside})}, {});
  const Tracer deformed = test::make_tracer({deforming}, {test::place(0, {})}, {});
  for (const Tracer* tracer : {&moving, &deformed})
    for (const float time : {0.0f, 0.25f, 0.5f, 0.9f, 1.0f})
      for (int x = -2; x < 13; ++x) {
        const Ray ray{.origin = {static_cast<float>(x) + 0.25f, 0.5f, 2}, .direction = {0, 0, -1}, .time = time};
        Hit hit;
        tracer->intersect(std::span(&ray, 1), std::span(&hit, 1));
        EXPECT_EQ(hit.is_hit(), std::abs(ray.origin.x - 10 * time) < 1) << x << " at " << time;
      }
}

TEST(Tracer, gives_the_lowest_instance_and_primitive_of_equally_near_hits) {
  test::Random rng(5);
  const Mesh mesh = test::coincident(rng, 40);
  const Vec3f target = (mesh.positions[0] + mesh.positions[1] + mesh.positions[2]) * (1 / 3.0f);
  const std::vector<Ray> rays{{.origin = target + Vec3f{1, 2, 3}, .direction = {-1, -2, -3}}};
  for (const auto& [builder, builder_name] : builders) {
    SCOPED_TRACE(builder_name);
    const std::vector<TracedInstance> twice{test::place(0, {}), test::place(0, {})};
    const Tracer tracer = test::make_tracer({mesh}, twice, {.builder = builder});
    std::vector<Hit> hits(1);
    tracer.intersect(rays, hits);
    ASSERT_TRUE(hits[0].is_hit());
    EXPECT_EQ(hits[0].instance, 0u);
    EXPECT_EQ(hits[0].primitive, 0u);
  }
}

TEST(Tracer, honours_the_interval_at_both_ends) {
  const Tracer tracer = test::make_tracer({test::flat_grid(1)}, {test::place(0, {})}, {});
  const auto hits = [&](float t_min, float t_max) {
    const std::vector<Ray> rays{{.origin = {0.25f, 0.5f, 2}, .t_min = t_min, .direction = {0, 0, -1}, .t_max = t_max}};
    std::vector<std::uint8_t> result(1);
    std::vector<Hit> hit(1);
    tracer.occluded(rays, result);
    tracer.intersect(rays, hit);
    EXPECT_EQ(hit[0].is_hit(), result[0] == 1);
    return result[0] == 1;
  };
  EXPECT_TRUE(hits(0, 2));
  EXPECT_TRUE(hits(2, 2));
  EXPECT_TRUE(hits(2, infinity));
  EXPECT_TRUE(hits(-1, 3));
  EXPECT_FALSE(hits(0, std::nextafter(2.0f, 0.0f)));
  EXPECT_FALSE(hits(std::nextafter(2.0f, 3.0f), infinity));
  EXPECT_FALSE(hits(3, 1));
}

TEST(Tracer, sees_an_instance_only_with_rays_of_its_visibility) {
  TracedInstance instance = test::place(0, {});
  instance.visibility = ray_camera | ray_shadow;
  const Tracer tracer = test::make_tracer({test::flat_grid(1)}, {instance}, {});
  for (const std::uint32_t kind : {ray_camera, ray_diffuse, ray_glossy, ray_transmission, ray_volume, ray_shadow}) {
    const std::vector<Ray> rays{{.origin = {0.25f, 0.5f, 2}, .direction = {0, 0, -1}, .kinds = kind}};
    std::vector<Hit> hits(1);
    std::vector<std::uint8_t> occluded(1);
    tracer.intersect(rays, hits);
    tracer.occluded(rays, occluded);
    const bool is_seen = kind == ray_camera || kind == ray_shadow;
    EXPECT_EQ(hits[0].is_hit(), is_seen) << kind;
    EXPECT_EQ(occluded[0], is_seen) << kind;
  }
}

TEST(Tracer, rays_with_unusable_numbers_miss) {
  test::Random rng(6);
  Tracer tracer = test::make_tracer({test::soup(rng, 100, 1), Sphere{}},
                                    {test::place(0, {}), test::place(1, test::random_transform(rng))}, {});
  const Ray usable{.origin = {3, 0.1f, 0.2f}, .direction = {-1, 0, 0}};
  std::vector<Ray> kinds;
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      kinds.insert(kinds.end(), 2, usable);
      kinds.end()[-1].origin[axis] = bad;
      kinds.end()[-2].direction[axis] = bad;
    }
  kinds.insert(kinds.end(), 3, usable);
  kinds.end()[-1].t_min = std::numeric_limits<float>::quiet_NaN();
  kinds.end()[-2].t_max = std::numeric_limits<float>::quiet_NaN();
  kinds.end()[-3].direction = {0, 0, 0};
  std::vector<Ray> rays = kinds;
  for (const Ray& ray : kinds) rays.insert(rays.end(), 32, ray);  // neighbours may walk together
  for (const Kernel* kernel : kernels()) {
    tracer.use(*kernel);
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size(), 1);
    tracer.intersect(rays, hits);
    tracer.occluded(rays, occluded);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      EXPECT_FALSE(hits[i].is_hit()) << kernel->name << ", ray " << i;
      EXPECT_EQ(occluded[i], 0) << kernel->name << ", ray " << i;
    }
  }
}

TEST(Tracer, misses_everything_in_an_empty_scene) {
  test::Random rng(7);
  const std::vector<Ray> rays = random_rays(rng, 40);
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size(), 1);
  const auto expect_misses = [&](Tracer tracer) {
    for (const Kernel* kernel : kernels()) {
      tracer.use(*kernel);
      tracer.intersect(rays, hits);
      tracer.occluded(rays, occluded);
      for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_TRUE(!hits[i].is_hit() && occluded[i] == 0);
    }
    EXPECT_TRUE(tracer.bounds().is_empty());
  };
  expect_misses(Tracer{});
  expect_misses(test::make_tracer({}, {}, {}));
  expect_misses(test::make_tracer({Mesh{}}, {test::place(0, {})}, {}));
}

TEST(Tracer, gives_its_trees_back_ready_for_the_next) {
  test::Random rng(8);
  const std::vector<Shape> shapes{test::soup(rng, 100, 0.5f), Sphere{}};
  Tracer tracer = test::make_tracer(shapes, {test::place(0, {}), test::place(1, {})}, {});
  std::vector<ShapeTree> trees = tracer.take_trees();
  ASSERT_EQ(trees.size(), 2u);
  EXPECT_TRUE(tracer.bounds().is_empty());

  const std::vector<TracedInstance> moved{test::place(0, test::random_transform(rng))};
  const Tracer again(std::move(trees), moved, {});
  const std::vector<Ray> rays = random_rays(rng, 500);
  std::vector<Hit> hits(rays.size());
  again.intersect(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i)
    EXPECT_EQ(hits[i].primitive, test::brute_force(shapes, moved, rays[i]).primitive);
}

TEST(Tracer, hits_small_meshes_too_far_away_or_too_small_for_single_precision) {
  const Mesh grid = test::flat_grid(1);
  const TransformD far_away({{{1e6, 0, 0, 0}, {0, 1e6, 0, 0}, {0, 0, 1, 4e12}}});
  const TransformD tiny({{{1e-14, 0, 0, 0}, {0, 1e-14, 0, 0}, {0, 0, 1, 0}}});
  for (const TransformD& transform : {far_away, tiny}) {
    const Tracer tracer = test::make_tracer({grid, grid}, {test::place(0, transform), test::place(1, transform)}, {});
    const std::vector<Ray> rays(32, {.origin = {1e-15f, 2e-15f, -1}, .direction = {0, 0, 1}});
    std::vector<Hit> hits(rays.size());
    tracer.intersect(rays, hits);
    for (const Hit& hit : hits) EXPECT_EQ(hit.instance, 0u);
  }
}

TEST(Tracer, agrees_with_brute_force_on_rays_too_long_or_too_far_for_single_precision) {
  test::Random rng(10);
  const std::vector<Shape> shapes{test::soup(rng, 20, 1), test::soup(rng, 400, 1), test::soup(rng, 20, 1)};
  std::vector<TracedInstance> instances;
  for (std::uint32_t shape = 0; shape < shapes.size(); ++shape)
    instances.push_back(test::place(shape, test::random_transform(rng)));
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) {
    const Vec3f origin = test::random_point(rng, 2), target = test::random_point(rng, 0.3f);
    rays.push_back({.origin = origin, .direction = (target - origin) * 1e15f});
    rays.push_back({.origin = origin, .direction = (target - origin) * 1e-15f});
  }
  EXPECT_GT(compare_with_brute_force(shapes, instances, rays, "long and short rays"), 200);
}

// Merged with others, too small for kernels, and met by a ray too long for them.
TEST(Tracer, leaves_out_the_triangle_that_a_ray_starts_on_whoever_solves_the_hit) {
  const Mesh grid = test::flat_grid(1);
  const TransformD tiny({{{1e-14, 0, 0, 0}, {0, 1e-14, 0, 0}, {0, 0, 1, 5}}});
  const std::vector<Shape> shapes{grid, grid};
  const std::vector<TracedInstance> instances{test::place(0, tiny), test::place(1, {})};
  std::vector<Ray> rays;
  for (const float speed : {1.0f, 1e20f})
    for (const std::uint32_t instance : {0u, 1u})
      for (const std::uint32_t primitive : {0u, 1u})
        rays.push_back({.origin = {2e-15f, 1e-15f, 6},
                        .direction = {0, 0, -speed},
                        .from_instance = instance,
                        .from_primitive = primitive});
  EXPECT_EQ(compare_with_brute_force(shapes, instances, rays, "rays from triangles"), 8);
  const Tracer tracer = test::make_tracer(shapes, instances, {});
  std::vector<Hit> hits(rays.size());
  tracer.intersect(rays, hits);
  std::vector<std::uint32_t> met;
  for (const Hit& hit : hits) met.push_back(hit.instance);
  EXPECT_EQ(met, (std::vector<std::uint32_t>{1, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(Tracer, bounds_hold_every_instance) {
  test::Random rng(9);
  const Mesh mesh = test::soup(rng, 50, 0.5f);
  const TransformD transform = test::random_transform(rng);
  const Bounds3f box = test::make_tracer({mesh}, {test::place(0, transform)}, {}).bounds();
  for (const Vec3f& p : mesh.positions) {
    const Vec3d q = transform.point(Vec3d(p));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LE(double{box.lower[axis]}, q[axis]);
      EXPECT_GE(double{box.upper[axis]}, q[axis]);
    }
  }
}

}  // namespace
}  // namespace basicrt
