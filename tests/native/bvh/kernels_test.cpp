// SPDX-License-Identifier: GPL-3.0-or-later
// What every kernel must hold: no ray slips between triangles, and none is hit by the triangle that it leaves.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <string>
#include <string_view>

#include "base/error.h"
#include "bvh/kernels/chosen_kernel.h"
#include "bvh/kernels/scratch.h"
#include "bvh/node_order.h"
#include "bvh/test_scenes.h"
#include "bvh/tree_access.h"
#include "geometry/kernels/chosen_point_kernel.h"
#include "geometry/surface_point.h"
#include "support/effort.h"

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

// A cube of [-1, 1]^3 around `center`, each face a grid. Closed: points on the cube's edges are the same from both faces.
Mesh closed_box(Vec3f center, std::uint32_t cells) {
  Mesh mesh;
  const Mesh face = test::flat_grid(cells);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const Vec3f& p : face.positions) {
        Vec3f position;
        position[axis] = side;
        position[(axis + 1) % 3] = p.x;
        position[(axis + 2) % 3] = p.y;
        mesh.positions.push_back(center + position);
      }
      for (const auto& [i, j, k] : face.triangles) mesh.triangles.push_back({first + i, first + j, first + k});
    }
  return mesh;
}

// From a point towards corners, edges, just beside edges and insides.
std::vector<Ray> rays_from_inside(test::Random& rng, const Mesh& mesh, Vec3f origin, int count) {
  std::vector<Ray> rays;
  std::uniform_int_distribution<std::size_t> pick(0, mesh.triangles.size() - 1);
  for (int i = 0; i < count; ++i) {
    const auto triangle = static_cast<std::uint32_t>(pick(rng));
    const Vec3f a = mesh.position(triangle, 0), b = mesh.position(triangle, 1), c = mesh.position(triangle, 2);
    Vec3f target = a;
    if (i % 5 == 1) target = (a + b) * 0.5f;
    if (i % 5 == 2) target = a + (b - a) * test::uniform(rng, 0, 1);
    if (i % 5 == 3) target = a + (b - a) * test::uniform(rng, 0, 1) + (c - a) * test::uniform(rng, 0, 1e-4f);
    if (i % 5 == 4) target = a + (b - a) * test::uniform(rng, 0, 0.5f) + (c - a) * test::uniform(rng, 0, 0.5f);
    rays.push_back({.origin = origin, .direction = target - origin});
  }
  return rays;
}

// Along the axes from inside a box of grids, through corners and along the lines of the grids that they meet.
std::vector<Ray> rays_along_axes(test::Random& rng, Vec3f center, std::uint32_t cells, int count) {
  std::vector<Ray> rays;
  std::uniform_int_distribution<std::uint32_t> line(0, cells);
  const auto on_a_line = [&] { return 2 * static_cast<float>(line(rng)) / static_cast<float>(cells) - 1; };
  for (int i = 0; i < count; ++i) {
    const auto axis = static_cast<std::size_t>(i % 3);
    Vec3f origin;
    origin[axis] = test::uniform(rng, -0.9f, 0.9f);
    origin[(axis + 1) % 3] = on_a_line();
    origin[(axis + 2) % 3] = i % 2 == 0 ? on_a_line() : test::uniform(rng, -1, 1);
    Ray ray{.origin = center + origin, .direction = {0, 0, 0}};
    ray.direction[axis] = i % 4 < 2 ? 1.0f : -1.0f;
    rays.push_back(ray);
  }
  return rays;
}

// How many rays each kernel is given below: BASICRT_LEAK_RAYS, or as many as take about a second.
int leak_ray_count() {
  const char* count = std::getenv("BASICRT_LEAK_RAYS");
  return count == nullptr ? test::tries(500000) : std::atoi(count);
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
  void expect_no_leak(const Mesh& mesh, const std::vector<Ray>& rays, const TracedInstance& instance,
                      const std::string& name) const {
    expect_no_leak(make_tracer({mesh}, {instance}), rays, name);
  }
  static void expect_no_leak(const Tracer& tracer, const std::vector<Ray>& rays, const std::string& name) {
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    tracer.intersect(rays, hits);
    tracer.occluded(rays, occluded);
    const auto is_miss = [](const Hit& hit) { return !hit.is_hit(); };
    EXPECT_EQ(std::count_if(hits.begin(), hits.end(), is_miss), 0) << name;
    EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 0), 0) << name;
  }

  const Kernel* kernel_ = nullptr;
};

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh) {
  test::Random rng(1);
  struct Case {
    std::string name;
    Mesh mesh;
    Vec3f center;
    float radius;
  };
  const Vec3f far(1e4f);
  const std::vector<Case> cases{{"sphere", closed_sphere(Vec3f(0), 1, 64, 32), Vec3f(0), 1},
                                {"sphere far away", closed_sphere(far, 1, 64, 32), far, 1},
                                {"large sphere", closed_sphere(Vec3f(0), 1e4f, 200, 100), Vec3f(0), 1e4f},
                                {"tiny sphere", closed_sphere(Vec3f(0), 1e-6f, 64, 32), Vec3f(0), 1e-6f},
                                {"slivers", closed_sphere(Vec3f(0), 1, 2048, 16), Vec3f(0), 1},
                                {"box", closed_box(Vec3f(0), 64), Vec3f(0), 1},
                                {"box far away", closed_box(far, 64), far, 1}};
  constexpr int batch = 10000;
  const int rays_of_all = batch * static_cast<int>(cases.size());
  const int batches = (leak_ray_count() + rays_of_all - 1) / rays_of_all;
  for (const auto& [name, mesh, center, radius] : cases) {
    const Tracer tracer = make_tracer({mesh}, {test::place(0, {})});
    for (int i = 0; i < batches && !HasFailure(); ++i) {
      const bool is_along_axes = name.starts_with("box") && i % 2 == 0;
      const Vec3f origin = center + test::random_point(rng, 0.4f) * (i == 0 ? 0 : radius);
      const std::vector<Ray> rays =
          is_along_axes ? rays_along_axes(rng, center, 64, batch) : rays_from_inside(rng, mesh, origin, batch);
      expect_no_leak(tracer, rays, name + ", batch " + std::to_string(i));
    }
  }
  RecordProperty("rays", batches * rays_of_all);
}

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh_under_a_transform) {
  test::Random rng(2);
  const Mesh mesh = closed_sphere(Vec3f(0), 1, 64, 32);
  for (int i = 0; i < 8; ++i) {
    const TransformD transform = test::random_transform(rng);
    std::vector<Ray> rays = rays_from_inside(rng, mesh, Vec3f(0), 5000);
    for (Ray& ray : rays) {
      ray.origin = Vec3f(transform.point(Vec3d(ray.origin)));
      ray.direction = Vec3f(transform.vector(Vec3d(ray.direction)));
    }
    expect_no_leak(make_tracer({mesh}, {test::place(0, transform)}), rays, "transform " + std::to_string(i));
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
  const Vec3f middle = (now.positions.front() + now.positions[now.triangles.back()[1]]) * 0.5f;  // of the poles
  std::vector<Ray> rays = rays_from_inside(rng, now, middle, count);
  for (Ray& ray : rays) ray.time = time;
  return rays;
}

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh_that_deforms) {
  test::Random rng(6);
  const Mesh mesh = deforming_sphere({3, -100, 1e4f});
  for (int i = 0; i < test::tries(20); ++i)
    expect_no_leak(mesh, rays_at_moving_borders(rng, mesh, test::random_time(rng), 3000), test::place(0, {}),
                   "time " + std::to_string(i));
}

TEST_P(EveryKernel, no_ray_leaves_a_closed_mesh_that_deforms_and_moves) {
  test::Random rng(7);
  const Mesh mesh = deforming_sphere({0.5f, -2});
  for (int i = 0; i < test::tries(20); ++i) {
    const float time = test::random_time(rng);
    const std::vector<TransformD> keys{test::random_transform(rng), test::random_transform(rng)};
    const TransformD transform = transform_at(keys, time);
    if (std::abs(transform.determinant()) < 0.05) continue;  // all but flat: the origin may be rounded out of it
    std::vector<Ray> rays = rays_at_moving_borders(rng, mesh, time, 3000);
    for (Ray& ray : rays) {
      ray.origin = Vec3f(transform.point(Vec3d(ray.origin)));
      ray.direction = Vec3f(transform.vector(Vec3d(ray.direction)));
    }
    expect_no_leak(mesh, rays, test::place_moving(0, keys), "motion " + std::to_string(i));
  }
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

// Each ray must meet alone what it meets among the others.
void expect_same_hits_alone(const Tracer& tracer, std::span<const Ray> rays, const std::string& name) {
  std::vector<Hit> together(rays.size());
  tracer.intersect(rays, together);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit alone;
    tracer.intersect(rays.subspan(i, 1), std::span(&alone, 1));
    EXPECT_TRUE(test::is_identical(alone, together[i])) << name << " ray " << i;
  }
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
  expect_same_hits_alone(tracer, rays, "");
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

// Of hits so near that single precision can't order them the company must not decide either.
TEST_P(EveryKernel, gives_neighbours_the_same_answer_as_each_alone_where_many_triangles_are_near) {
  test::Random rng(6);
  for (int picture = 0; picture < 40; ++picture) {
    const Vec3f center = test::random_point(rng, 2);
    Mesh mesh;
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Vec3f a = test::random_point(rng), b = test::random_point(rng);
      for (const Vec3f& corner : {a, b, -(a + b)}) mesh.positions.push_back(center + corner);
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const Tracer tracer = make_tracer({mesh}, {test::place(0, {})});
    const Vec3f direction = test::random_point(rng);
    std::vector<Ray> rays;
    for (int i = 0; i < 64; ++i)
      rays.push_back({.origin = center, .direction = direction + test::random_point(rng) * 1e-3f});
    expect_same_hits_alone(tracer, rays, "picture " + std::to_string(picture));
  }
}

// Seen from their two sides, the zero comes out with both signs.
TEST_P(EveryKernel, gives_hits_at_the_origin_no_negative_distance) {
  Mesh mesh = test::flat_grid(1);
  mesh.triangles = {{0, 1, 3}, {0, 3, 1}, {0, 1, 3}, {0, 3, 1}};
  for (const TransformD& transform : {TransformD{}, TransformD({{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}})}) {
    const Tracer tracer = make_tracer({mesh, mesh}, {test::place(0, transform), test::place(1, {})});
    for (const float z : {-1.0f, 1.0f}) {
      const std::vector<Ray> rays(32, {.origin = {-0.25f, -0.5f, 0}, .direction = {0.1f, 0.2f, z}});
      std::vector<Hit> together(rays.size()), alone(rays.size());
      tracer.intersect(rays, together);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        tracer.intersect(std::span(&rays[i], 1), std::span(&alone[i], 1));
        ASSERT_TRUE(alone[i].is_hit());
        EXPECT_FALSE(std::signbit(alone[i].t));
        EXPECT_TRUE(test::is_identical(alone[i], together[i]));
      }
    }
  }
}

// An array of any size, of which only the elements that are asked for take memory.
template <class T>
class SparseArray {
 public:
  explicit SparseArray(std::size_t size)
      : bytes_(size * sizeof(T)),
        memory_(mmap(nullptr, bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {}
  ~SparseArray() {
    if (is_there()) munmap(memory_, bytes_);
  }
  SparseArray(const SparseArray&) = delete;
  SparseArray& operator=(const SparseArray&) = delete;

  [[nodiscard]] bool is_there() const { return memory_ != MAP_FAILED; }
  [[nodiscard]] T* data() const { return static_cast<T*>(memory_); }
  [[nodiscard]] T& at(std::size_t index) const {
    constexpr std::uintptr_t page = 4096;
    const auto begin = reinterpret_cast<std::uintptr_t>(data() + index) / page * page;
    const auto end = reinterpret_cast<std::uintptr_t>(data() + index + 1);
    EXPECT_EQ(mprotect(reinterpret_cast<void*>(begin), end - begin, PROT_READ | PROT_WRITE), 0);
    return data()[index];
  }

 private:
  std::size_t bytes_;
  void* memory_;
};

// A tree of a single node, block and instance, as far from the start of their arrays as references reach: offsets in bytes need more than 32 bits.
TEST_P(EveryKernel, walks_trees_with_the_largest_indices) {
  constexpr std::uint32_t last = reference_index - 2, last_instance = (1u << 29) + 7;
  const SparseArray<TreeNode> nodes(last + 1), world_nodes(last + 1);
  const SparseArray<TriangleBlock> blocks(last + 1);
  const SparseArray<KernelInstance> instances(last_instance + 1);
  if (!nodes.is_there() || !world_nodes.is_there() || !blocks.is_there() || !instances.is_there())
    GTEST_SKIP() << "the system gives no such address space";

  Mesh mesh = test::flat_grid(1);
  mesh.triangles.push_back(mesh.triangles[0]);
  const MeshTree small = build_mesh_tree(mesh, {});
  ASSERT_EQ(small.blocks.size(), 1u);
  TriangleBlock& block = blocks.at(last) = small.blocks[0];
  for (std::uint32_t& primitive : block.primitives) primitive += 0x7FFF'FFFEu;  // on both sides of 2^31
  const auto make_node = [](TreeReference child, const Bounds3f& box) {
    TreeNode node{};
    for (std::size_t i = 0; i < 8; ++i) {
      node.children[i] = i == 0 ? child : no_reference;
      set_child_bounds(node, i, i == 0 ? box : Bounds3f());
    }
    set_order(node);
    return node;
  };
  nodes.at(last) = make_node(triangles_mark | last, small.tree.bounds);
  world_nodes.at(last) = make_node(instance_mark | last_instance, small.tree.bounds);
  KernelInstance instance{};
  for (int i = 0; i < 3; ++i) instance.world_to_object[i][i] = 1;
  instance.nodes = nodes.data();
  instance.blocks = blocks.data();
  instance.root = last;
  instance.visibility = ray_all;
  instance.space = KernelInstance::Space::world;
  instance.reach = 1;
  instance.first_merged = no_reference;
  instances.at(last_instance) = instance;

  KernelScene scene{};
  scene.nodes = world_nodes.data();
  scene.root = last;
  scene.instances = instances.data();
  std::vector<Ray> rays(40, {.origin = {0.5f, -0.25f, 2}, .direction = {0, 0, -1}});  // the first 32 may walk together
  for (std::size_t i = 32; i < rays.size(); ++i) rays[i].direction.y = i % 2 ? 0.5f : -0.5f;
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> occluded(rays.size());
  void* scratch = kernel_scratch(kernel_->scratch_size);
  kernel_->intersect(scene, rays.data(), hits.data(), rays.size(), scratch);
  kernel_->occluded(scene, rays.data(), occluded.data(), rays.size(), scratch);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool is_inside = i < 32 || i % 2;  // the others leave the grid
    EXPECT_EQ(hits[i].is_hit(), is_inside) << i;
    EXPECT_EQ(occluded[i], is_inside) << i;
    if (!is_inside) continue;
    EXPECT_EQ(hits[i].t, 2) << i;
    EXPECT_EQ(hits[i].instance, last_instance) << i;
  }
  EXPECT_EQ(hits[0].primitive, 0x7FFF'FFFEu);  // of triangles 0 and 2, which coincide
}

INSTANTIATE_TEST_SUITE_P(Kernels, EveryKernel, testing::Values("avx512", "avx2", "sse42", "scalar"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Kernels, are_found_by_name) {
  EXPECT_NE(find_kernel("scalar"), nullptr);
  EXPECT_NE(find_kernel(""), nullptr);
  EXPECT_EQ(find_kernel("avx1024"), nullptr);
  EXPECT_STREQ(find_kernel("scalar")->name, "scalar");
}

TEST(Kernels, can_be_chosen_while_a_program_runs) {
  const std::string first = chosen_kernel().name, first_for_points = chosen_point_kernel().name;
  for (const std::string_view name : kernel_names()) {
    choose_kernel(name);
    EXPECT_EQ(chosen_kernel().name, name);
    EXPECT_STREQ(chosen_point_kernel().name, name.starts_with("avx") ? "avx2" : "plain");
  }
  EXPECT_EQ(kernel_names().back(), "scalar");
  EXPECT_THROW(choose_kernel("avx1024"), SceneError);
  EXPECT_STREQ(chosen_kernel().name, "scalar");
  choose_kernel("");
  EXPECT_EQ(chosen_kernel().name, first);
  EXPECT_EQ(chosen_point_kernel().name, first_for_points);
}

}  // namespace
}  // namespace basicrt
