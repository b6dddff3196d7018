// SPDX-License-Identifier: GPL-3.0-or-later
// What every kernel must hold: no ray slips between triangles, and none is hit by the triangle that it leaves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "bvh/kernels/chosen_kernel.h"
#include "bvh/test_scenes.h"
#include "geometry/surface_point.h"

namespace basicrt {
namespace {

// Rings of triangles from pole to pole. Closed: neighbours share their corners.
Mesh closed_sphere(Vec3f center, float radius, std::uint32_t slices, std::uint32_t rings) {
  Mesh mesh;
  const auto direction = [&](std::uint32_t ring, std::uint32_t slice) {
    const double polar = std::numbers::pi * ring / rings, azimuth = 2 * std::numbers::pi * slice / slices;
    return Vec3d{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
  };
  for (std::uint32_t ring = 0; ring <= rings; ++ring)
    for (std::uint32_t slice = 0; slice < slices; ++slice)
      mesh.positions.push_back(center + Vec3f(direction(ring, ring == 0 || ring == rings ? 0 : slice)) * radius);
  const auto at = [&](std::uint32_t ring, std::uint32_t slice) {
    return ring * slices + (ring == 0 || ring == rings ? 0 : slice % slices);
  };
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
      if (ring > 0) mesh.triangles.push_back({at(ring, slice), at(ring + 1, slice), at(ring, slice + 1)});
      if (ring + 1 < rings)
        mesh.triangles.push_back({at(ring, slice + 1), at(ring + 1, slice), at(ring + 1, slice + 1)});
    }
  return mesh;
}

// From a point towards corners, edges and just beside edges.
std::vector<Ray> rays_at_borders(test::Random& rng, const Mesh& mesh, Vec3f origin, int count) {
  std::vector<Ray> rays;
  std::uniform_int_distribution<std::size_t> pick(0, mesh.triangles.size() - 1);
  for (int i = 0; i < count; ++i) {
    const auto triangle = static_cast<std::uint32_t>(pick(rng));
    const Vec3f a = mesh.position(triangle, 0), b = mesh.position(triangle, 1), c = mesh.position(triangle, 2);
    Vec3f target = a;
    if (i % 4 == 1) target = (a + b) * 0.5f;
    if (i % 4 == 2) target = a + (b - a) * test::uniform(rng, 0, 1);
    if (i % 4 == 3) target = a + (b - a) * test::uniform(rng, 0, 1) + (c - a) * test::uniform(rng, 0, 1e-4f);
    rays.push_back({.origin = origin, .direction = target - origin});
  }
  return rays;
}

class EveryKernel : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    kernel_ = find_kernel(GetParam());
    if (kernel_ == nullptr) GTEST_SKIP() << "this machine has no " << GetParam();
  }
  Tracer make_tracer(const std::vector<Shape>& shapes, const std::vector<TracedInstance>& instances) const {
    Tracer tracer = test::make_tracer(shapes, instances, {});
    tracer.use(*kernel_);
    return tracer;
  }
  void expect_no_leak(const Mesh& mesh, const std::vector<Ray>& rays, const TransformD& transform = {}) const {
    expect_no_leak(mesh, rays, test::place(0, transform));
  }
  void expect_no_leak(const Mesh& mesh, const std::vector<Ray>& rays, const TracedInstance& instance) const {
    const Tracer tracer = make_tracer({mesh}, {instance});
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    tracer.intersect(rays, hits);
    tracer.occluded(rays, occluded);
    const auto is_miss = [](const Hit& hit) { return !hit.is_hit(); };
    EXPECT_EQ(std::count_if(hits.begin(), hits.end(), is_miss), 0);
    EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 0), 0);
  }

  const Kernel* kernel_ = nullptr;
};

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh) {
  test::Random rng(1);
  struct Case {
    Vec3f center;
    float radius;
    std::uint32_t slices, rings;
  };
  for (const auto& [center, radius, slices, rings] :
       {Case{Vec3f(0), 1, 64, 32}, Case{Vec3f(1e4f), 1, 64, 32}, Case{Vec3f(0), 1e4f, 200, 100},
        Case{Vec3f(0), 1, 2048, 16}, Case{Vec3f(0), 1e-6f, 64, 32}}) {
    const Mesh mesh = closed_sphere(center, radius, slices, rings);
    for (int i = 0; i < 4; ++i) {
      const Vec3f origin = center + test::random_point(rng, 0.4f) * (i == 0 ? 0 : radius);
      expect_no_leak(mesh, rays_at_borders(rng, mesh, origin, 20000));
    }
  }
}

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh_under_a_transform) {
  test::Random rng(2);
  const Mesh mesh = closed_sphere(Vec3f(0), 1, 64, 32);
  for (int i = 0; i < 8; ++i) {
    const TransformD transform = test::random_transform(rng);
    std::vector<Ray> rays = rays_at_borders(rng, mesh, Vec3f(0), 5000);
    for (Ray& ray : rays) {
      ray.origin = Vec3f(transform.point(Vec3d(ray.origin)));
      ray.direction = Vec3f(transform.vector(Vec3d(ray.direction)));
    }
    expect_no_leak(mesh, rays, transform);
  }
}

// A sphere that grows, is stretched and bent, and flies off by each of the shifts in turn.
Mesh deforming_sphere(std::initializer_list<float> shifts) {
  const Mesh sphere = closed_sphere(Vec3f(0), 1, 64, 32);
  Mesh mesh = sphere;
  for (const float shift : shifts) {
    std::vector<Vec3f>& positions = mesh.motion_positions.emplace_back(sphere.positions);
    for (Vec3f& p : positions) p = {2 * p.x + shift, p.y + 0.3f * p.x * p.x - shift, 0.5f * p.z + shift};
  }
  return mesh;
}

// From inside the mesh, as it is at the time.
std::vector<Ray> rays_at_moving_borders(test::Random& rng, const Mesh& mesh, float time, int count) {
  Mesh now = mesh;
  for (std::uint32_t triangle = 0; triangle < now.triangles.size(); ++triangle)
    for (int corner = 0; corner < 3; ++corner)
      now.positions[now.triangles[triangle][corner]] = mesh.position_at(triangle, corner, time);
  const Vec3f middle = (now.positions.front() + now.positions.back()) * 0.5f;  // of the poles
  std::vector<Ray> rays = rays_at_borders(rng, now, middle, count);
  for (Ray& ray : rays) ray.time = time;
  return rays;
}

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh_that_deforms) {
  test::Random rng(6);
  const Mesh mesh = deforming_sphere({3, -100, 1e4f});
  for (int i = 0; i < 20; ++i) expect_no_leak(mesh, rays_at_moving_borders(rng, mesh, test::random_time(rng), 3000));
}

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh_that_deforms_and_moves) {
  test::Random rng(7);
  const Mesh mesh = deforming_sphere({0.5f, -2});
  for (int i = 0; i < 20; ++i) {
    const float time = test::random_time(rng);
    const std::vector<TransformD> keys{test::random_transform(rng), test::random_transform(rng)};
    const TransformD transform = transform_at(keys, time);
    if (std::abs(transform.determinant()) < 0.05) continue;  // all but flat: the origin may be rounded out of it
    std::vector<Ray> rays = rays_at_moving_borders(rng, mesh, time, 3000);
    for (Ray& ray : rays) {
      ray.origin = Vec3f(transform.point(Vec3d(ray.origin)));
      ray.direction = Vec3f(transform.vector(Vec3d(ray.direction)));
    }
    expect_no_leak(mesh, rays, test::place_moving(0, keys));
  }
}

TEST_P(EveryKernel, rays_along_the_axes_hit_corners_and_edges_of_a_grid) {
  const Mesh grid = test::flat_grid(64);
  std::vector<Ray> rays;
  for (int y = -31; y < 32; ++y)
    for (int x = -31; x < 32; ++x)
      for (const float shift : {0.0f, 0.3f / 32, 0.5f / 32})
        for (const float direction : {-1.0f, 1.0f})
          rays.push_back({.origin = {static_cast<float>(x) / 32 + shift, static_cast<float>(y) / 32, -2 * direction},
                          .direction = {0, 0, direction}});
  expect_no_leak(grid, rays);
}

// The ray goes on from a hit as paths do, in a direction away from the sphere: it must not meet the sphere again.
TEST_P(EveryKernel, a_ray_that_leaves_a_convex_mesh_never_hits_it) {
  test::Random rng(3);
  const Mesh mesh = closed_sphere({3, -2, 5}, 1, 48, 24);
  for (const TransformD& transform : {TransformD{}, test::random_transform(rng)}) {
    const TracedInstance instance = test::place(0, transform);
    const Tracer tracer = make_tracer({mesh}, {instance});
    const Vec3f middle(transform.point(Vec3d(3, -2, 5)));
    std::vector<Ray> rays;
    for (int i = 0; i < 20000; ++i) {
      const Vec3f origin = middle + test::random_point(rng, 8);
      rays.push_back({.origin = origin, .direction = middle + test::random_point(rng, 0.2f) - origin});
    }
    std::vector<Hit> hits(rays.size());
    tracer.intersect(rays, hits);
    std::vector<Ray> leaving;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].is_hit()) continue;
      const SurfacePoint point = make_surface_point(mesh, Placement(instance.object_to_world), rays[i], hits[i]);
      const Vec3f outwards = point.is_backfacing ? -point.geometric_normal : point.geometric_normal;
      Vec3f direction = test::random_point(rng);
      if (dot(direction, outwards) < 0) direction = -direction;
      if (i % 3 == 0) direction += outwards * (0.001f - dot(direction, outwards));  // nearly along the surface
      if (!(dot(direction, outwards) > 0) || point.is_backfacing) continue;
      leaving.push_back({.origin = offset_origin(point, direction),
                         .direction = direction,
                         .from_instance = hits[i].instance,
                         .from_primitive = hits[i].primitive});
    }
    ASSERT_GT(leaving.size(), 5000u);
    std::vector<std::uint8_t> occluded(leaving.size());
    tracer.occluded(leaving, occluded);
    EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 1), 0) << "of " << leaving.size();
  }
}

TEST_P(EveryKernel, leaves_out_the_triangle_that_a_ray_starts_on) {
  const Tracer tracer = make_tracer({test::flat_grid(1)}, {test::place(0, {})});
  Ray ray{.origin = {0.25f, 0.5f, 2}, .direction = {0, 0, -1}};
  std::vector<Hit> hit(1);
  tracer.intersect(std::span(&ray, 1), hit);
  ASSERT_TRUE(hit[0].is_hit());
  ray.from_instance = hit[0].instance;
  ray.from_primitive = hit[0].primitive;
  tracer.intersect(std::span(&ray, 1), hit);
  EXPECT_FALSE(hit[0].is_hit());
  ray.from_primitive = 1 - ray.from_primitive;
  tracer.intersect(std::span(&ray, 1), hit);
  EXPECT_TRUE(hit[0].is_hit());
}

TEST_P(EveryKernel, gives_each_ray_the_same_answer_in_any_company) {
  test::Random rng(4);
  std::vector<Shape> shapes;
  std::vector<TracedInstance> instances;
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng)) {
    instances.push_back(test::place(static_cast<std::uint32_t>(shapes.size()), test::random_transform(rng)));
    shapes.push_back(shape);
  }
  instances.push_back(test::place(0, test::random_transform(rng)));
  instances.push_back(test::place_moving(0, {test::random_transform(rng), test::random_transform(rng)}));
  instances.push_back(test::place(static_cast<std::uint32_t>(shapes.size()), test::random_transform(rng)));
  shapes.emplace_back(test::deforming(rng, test::soup(rng, 100, 0.4f), 2, 0.2f));
  const Tracer tracer = make_tracer(shapes, instances);
  std::vector<Ray> rays;
  for (int i = 0; i < 1000; ++i) {
    rays.push_back(test::random_ray(rng));
    rays.back().time = test::random_time(rng);
  }
  std::vector<Hit> together(rays.size());
  tracer.intersect(rays, together);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit alone;
    tracer.intersect(std::span(&rays[i], 1), std::span(&alone, 1));
    EXPECT_TRUE(test::is_identical(alone, together[i])) << i;
  }
}

// Neighbours that point the same way walk together; what they meet must not depend on it, whether they meet edges, instances or nothing.
TEST_P(EveryKernel, gives_neighbours_the_same_answer_as_each_alone) {
  test::Random rng(5);
  std::vector<Shape> shapes;
  std::vector<TracedInstance> instances;
  for (const auto& [name, shape] : test::shapes_of_every_kind(rng)) {
    const auto index = static_cast<std::uint32_t>(shapes.size());
    instances.push_back(test::place(index, index % 2 ? TransformD{} : test::random_transform(rng)));
    instances.push_back(test::place(index, test::random_transform(rng)));
    shapes.push_back(shape);
  }
  instances[3].visibility = ray_shadow;
  instances.push_back(test::place_moving(0, {test::random_transform(rng), test::random_transform(rng)}));
  instances.push_back(test::place_moving(2, {TransformD{}, test::random_transform(rng)}));
  Mesh deforming = test::deforming(rng, test::flat_grid(4), 2, 0.3f);
  const Tracer with_deforming = make_tracer({deforming, test::flat_grid(16)}, {test::place(0, {}), test::place(1, {})});
  const Tracer all_kinds = make_tracer(shapes, instances);
  const Tracer only_grid = make_tracer({test::flat_grid(16)}, {test::place(0, {})});
  for (const Tracer* tracer : {&all_kinds, &only_grid, &with_deforming}) {
    int hit_count = 0;
    for (int picture = 0; picture < 12; ++picture) {
      const Vec3f origin = test::random_point(rng, 3), target = test::random_point(rng, 0.3f);
      const Vec3f right = test::random_point(rng) * 0.01f, up = test::random_point(rng) * 0.01f;
      std::vector<Ray> rays;
      for (int i = 0; i < 1000; ++i) {
        const auto x = static_cast<float>(i % 32 - 16), y = static_cast<float>(i / 32 - 16);
        Ray ray{.origin = origin, .direction = target + right * x + up * y - origin};
        if (picture % 3 == 1) std::swap(ray.origin, ray.direction);  // from many points
        if (picture % 3 == 1) ray.direction = target - ray.origin;   // to one
        if (picture % 3 == 2)
          ray.direction = Vec3f{std::round(x) / 16, y / 16, 0} - origin;  // through corners of the grid
        ray.time = picture % 2 == 0 ? 0.25f : test::uniform(rng, 0, 1);
        if (picture % 4 == 3) ray.t_max = 1 + test::uniform(rng, 0, 0.1f);
        rays.push_back(ray);
      }
      std::vector<Hit> together(rays.size());
      std::vector<std::uint8_t> occluded(rays.size());
      tracer->intersect(rays, together);
      tracer->occluded(rays, occluded);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit alone;
        tracer->intersect(std::span(&rays[i], 1), std::span(&alone, 1));
        ASSERT_TRUE(test::is_identical(alone, together[i])) << "picture " << picture << ", ray " << i;
        ASSERT_EQ(occluded[i], alone.is_hit()) << "picture " << picture << ", ray " << i;
        std::uint8_t occluded_alone = 2;
        tracer->occluded(std::span(&rays[i], 1), std::span(&occluded_alone, 1));
        ASSERT_EQ(occluded_alone, alone.is_hit()) << "picture " << picture << ", ray " << i;
        hit_count += alone.is_hit();
      }
    }
    EXPECT_GT(hit_count, 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, EveryKernel, testing::Values("avx512", "avx2", "sse42", "scalar"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Kernels, are_found_by_name) {
  EXPECT_NE(find_kernel("scalar"), nullptr);
  EXPECT_NE(find_kernel(""), nullptr);
  EXPECT_EQ(find_kernel("avx1024"), nullptr);
  EXPECT_STREQ(find_kernel("scalar")->name, "scalar");
}

}  // namespace
}  // namespace basicrt
