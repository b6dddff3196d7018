// SPDX-License-Identifier: GPL-3.0-or-later
// Surface points against extended precision and finite differences, and the rays that leave them.
#include "geometry/surface_point.h"

#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <random>
#include <vector>

#include "geometry/kernels/chosen_point_kernel.h"
#include "geometry/sphere.h"
#include "geometry/triangle.h"

namespace basicrt {
namespace {

using Vec3l = Vec3<long double>;
using TransformL = Affine<long double>;

// A shape somewhere in the world, and a ray that hits it.
struct Situation {
  Shape shape;
  Placement placement;
  Ray ray{};
  Hit hit{};

  // With its derivatives.
  [[nodiscard]] SurfacePoint point() const {
    SurfacePoint result = make_surface_point(shape, placement, ray, hit);
    add_derivatives(result, shape, placement);
    return result;
  }
};

std::optional<Hit> find_hit(const Shape& shape, const TransformD& world_to_object, const Ray& ray) {
  PreciseRay local = transform_ray(world_to_object, ray);
  if (const Mesh* mesh = std::get_if<Mesh>(&shape)) {
    const auto hit = intersect_triangle(local, mesh->position(0, 0), mesh->position(0, 1), mesh->position(0, 2));
    if (!hit) return std::nullopt;
    return Hit{static_cast<float>(hit->t), 3, 0, static_cast<float>(hit->u), static_cast<float>(hit->v)};
  }
  const auto t = intersect_sphere(local, std::get<Sphere>(shape));
  if (!t) return std::nullopt;
  return Hit{.t = static_cast<float>(*t), .instance = 3, .primitive = 0};
}

class SurfacePointTest : public testing::Test {
 protected:
  std::mt19937 rng_{31};

  float uniform(float lower, float upper) { return std::uniform_real_distribution<float>(lower, upper)(rng_); }
  Vec3f random_point(float reach) {
    const float x = uniform(-reach, reach), y = uniform(-reach, reach), z = uniform(-reach, reach);
    return {x, y, z};
  }
  // Of any size from a millimetre to a kilometre.
  float random_size() { return std::exp(uniform(std::log(1e-3f), std::log(1e3f))); }

  TransformD random_transform(double scale) {
    TransformD m;
    do {
      for (auto& row : m.rows)
        for (double& x : row) x = double{uniform(-1, 1)} * scale;
    } while (std::abs(m.determinant()) < 0.05 * scale * scale * scale);
    return m;
  }
  // Every other one only moves.
  TransformD random_placement(float size, double scale) {
    if (std::uniform_int_distribution<int>(0, 1)(rng_)) return random_transform(scale);
    TransformD m;
    const Vec3f translation = random_point(size * uniform(0, 100));
    for (std::size_t axis = 0; axis < 3; ++axis) m.rows[axis][3] = double{translation[axis]};
    return m;
  }
  Mesh random_triangle(float size) {
    Mesh mesh;
    const Vec3f center = random_point(size * uniform(0, 100));
    for (int i = 0; i < 3; ++i) mesh.positions.push_back(center + random_point(size));
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  }
  void add_normals_and_uvs(Mesh& mesh) {
    const Vec3f normal = normalize(cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]));
    for (int i = 0; i < 3; ++i) {
      mesh.corner_normals.push_back(normalize(normal + random_point(0.4f)));
      const float u = uniform(0, 1), v = uniform(0, 1);
      mesh.uvs.push_back({u, v});
    }
  }
  // Sheared and scaled, but not so much that a small step on the surface is a large one in uv.
  TransformD mild_transform() {
    TransformD m;
    for (auto& row : m.rows)
      for (double& x : row) x += double{uniform(-0.25f, 0.25f)};
    return m;
  }
  // With uvs and corner normals, and mildly transformed, where derivatives are looked at.
  Situation random_situation(bool is_sphere, bool is_for_derivatives = false) {
    for (;;) {
      const float size = random_size();
      Situation s;
      if (is_sphere) {
        s.shape = Sphere{random_point(3 * size), size};
      } else {
        Mesh mesh = random_triangle(size);
        if (is_for_derivatives) add_normals_and_uvs(mesh);
        s.shape = mesh;
      }
      s.placement = Placement(is_for_derivatives ? mild_transform() : random_placement(size, double{uniform(0.5f, 2)}));
      const Bounds3f box = transform_bounds(Transform(s.placement.object_to_world), bounds(s.shape));
      s.ray.origin = box.center() + random_point(3 * max_component(box.extent()));
      const Vec3f target = box.lower + box.extent() * (random_point(0.5f) + Vec3f(0.5f));
      s.ray.direction = normalize(target - s.ray.origin);
      if (const auto hit = find_hit(s.shape, s.placement.world_to_object, s.ray)) {
        s.hit = *hit;
        return s;
      }
    }
  }
};

// The hit in extended precision.
Vec3l exact_position(const Situation& s) {
  const TransformL to_world(s.placement.object_to_world), to_object(s.placement.world_to_object);
  const Vec3l origin = to_object.point(Vec3l(s.ray.origin)), direction = to_object.vector(Vec3l(s.ray.direction));
  if (const Mesh* mesh = std::get_if<Mesh>(&s.shape)) {
    const Vec3l p0(mesh->positions[0]), e1 = Vec3l(mesh->positions[1]) - p0, e2 = Vec3l(mesh->positions[2]) - p0;
    const Vec3l normal = cross(e1, e2);
    return to_world.point(origin + direction * (dot(p0 - origin, normal) / dot(direction, normal)));
  }
  const Sphere& sphere = std::get<Sphere>(s.shape);
  const Vec3l from_center = origin - Vec3l(sphere.center);
  const long double a = length_squared(direction), b = dot(from_center, direction);
  const long double c = length_squared(from_center) - static_cast<long double>(sphere.radius) * sphere.radius;
  const long double root = std::sqrt(std::max(0.0L, b * b - a * c));
  const long double near_t = (-b - root) / a, far_t = (-b + root) / a;
  const bool is_near = std::abs(near_t - s.hit.t) < std::abs(far_t - s.hit.t);
  return to_world.point(origin + direction * (is_near ? near_t : far_t));
}

TEST_F(SurfacePointTest, position_is_within_its_error_bound) {
  for (const bool is_sphere : {false, true})
    for (int i = 0; i < 20000; ++i) {
      const Situation s = random_situation(is_sphere);
      const SurfacePoint point = s.point();
      const Vec3l exact = exact_position(s);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const long double error = std::abs(exact[axis] - static_cast<long double>(point.position[axis]));
        ASSERT_LE(error, static_cast<long double>(point.position_error[axis])) << i << (is_sphere ? " sphere" : "");
      }
    }
}

TEST_F(SurfacePointTest, the_error_bound_is_about_a_rounding) {
  for (const bool is_sphere : {false, true}) {
    int tight = 0;
    for (int i = 0; i < 1000; ++i) {
      const SurfacePoint point = random_situation(is_sphere).point();
      tight += max_component(point.position_error) <= 0x1p-22f * max_component(abs(point.position));
    }
    EXPECT_GT(tight, 990) << (is_sphere ? "sphere" : "triangle");
  }
}

// The tracer's answer may be off by its single precision: the point is not.
TEST_F(SurfacePointTest, a_rough_hit_gives_the_same_point) {
  for (const bool is_sphere : {false, true})
    for (int i = 0; i < 5000; ++i) {
      Situation s = random_situation(is_sphere);
      const SurfacePoint exact = s.point();
      s.hit.t *= 1 + uniform(-1, 1) * (is_sphere ? 1e-7f : 1.5e-5f);
      s.hit.u += uniform(-1, 1) * 1e-3f;
      s.hit.v += uniform(-1, 1) * 1e-3f;
      const SurfacePoint point = s.point();
      EXPECT_EQ(point.position, exact.position) << i;
      EXPECT_EQ(point.t, exact.t) << i;
    }
}

TEST_F(SurfacePointTest, t_is_the_distance_along_the_ray) {
  for (const bool is_sphere : {false, true})
    for (int i = 0; i < 5000; ++i) {
      const Situation s = random_situation(is_sphere);
      const SurfacePoint point = s.point();
      const Vec3d along_ray = Vec3d(s.ray.origin) + Vec3d(s.ray.direction) * double{point.t};
      const double reach = length(Vec3d(s.ray.origin)) + length(Vec3d(point.position)) + double{point.t};
      EXPECT_LT(length(along_ray - Vec3d(point.position)), 3e-7 * reach) << i << (is_sphere ? " sphere" : "");
    }
}

TEST_F(SurfacePointTest, many_hits_give_the_points_that_each_gives_alone) {
  for (const std::size_t count : {1u, 3u, 4u, 64u, 65u, 301u}) {
    std::vector<Situation> situations;
    for (std::size_t i = 0; i < count; ++i) situations.push_back(random_situation(i % 5 == 4, i % 3 == 0));
    std::vector<SurfacePoint> points(count);
    std::vector<SurfaceHit> hits;
    for (std::size_t i = 0; i < count; ++i) {
      const Situation& s = situations[i];
      points[i].derivatives.emplace();  // what was there before doesn't stay
      hits.push_back({&s.shape, &s.placement, &s.ray, &s.hit, &points[i]});
    }
    make_surface_points(hits);
    for (std::size_t i = 0; i < count; ++i) {
      const Situation& s = situations[i];
      const SurfacePoint alone = make_surface_point(s.shape, s.placement, s.ray, s.hit);
      EXPECT_EQ(points[i].position, alone.position);
      EXPECT_EQ(points[i].position_error, alone.position_error);
      EXPECT_EQ(points[i].geometric_normal, alone.geometric_normal);
      EXPECT_EQ(points[i].shading_normal, alone.shading_normal);
      EXPECT_EQ(points[i].uv, alone.uv);
      EXPECT_EQ(points[i].barycentrics, alone.barycentrics);
      EXPECT_EQ(points[i].t, alone.t);
      EXPECT_EQ(points[i].primitive, alone.primitive);
      EXPECT_EQ(points[i].instance, 3);
      EXPECT_EQ(points[i].is_backfacing, alone.is_backfacing);
      EXPECT_FALSE(points[i].derivatives.has_value());
    }
  }
}

TEST_F(SurfacePointTest, every_kernel_solves_hits_to_the_same_bits) {
  const PointKernel *avx2 = find_point_kernel("avx2"), *plain = find_point_kernel("plain");
  ASSERT_TRUE(plain);
  EXPECT_EQ(find_point_kernel("no such thing"), nullptr);
  if (!avx2) GTEST_SKIP() << "this machine has one kernel only";
  for (const std::size_t count : {1u, 2u, 5u, 64u}) {
    for (int i = 0; i < 200; ++i) {
      std::vector<Situation> situations;
      for (std::size_t j = 0; j < count; ++j) situations.push_back(random_situation(false, true));
      // Every fourth is in the plane of its triangle.
      if (i % 4 == 0)
        for (Situation& s : situations)
          s.ray.direction = Transform(s.placement.object_to_world)
                                .vector(std::get<Mesh>(s.shape).positions[1] - std::get<Mesh>(s.shape).positions[0]);
      std::vector<PointRequest> requests;
      for (const Situation& s : situations) {
        const Mesh& mesh = std::get<Mesh>(s.shape);
        requests.push_back({.corners = {&mesh.positions[0].x, &mesh.positions[1].x, &mesh.positions[2].x},
                            .corner_normals = &mesh.corner_normals[0].x,
                            .ray = &s.ray.origin.x,
                            .to_object = s.placement.world_to_object.rows[0].data(),
                            .to_world = s.placement.object_to_world.rows[0].data(),
                            .t = s.hit.t,
                            .u = s.hit.u,
                            .v = s.hit.v});
      }
      for (const bool is_translation : {false, true})
        for (const bool has_normals : {false, true}) {
          std::vector<PointResult> first(count), second(count);
          avx2->solve({is_translation, has_normals}, requests.data(), first.data(), count);
          plain->solve({is_translation, has_normals}, requests.data(), second.data(), count);
          EXPECT_EQ(std::memcmp(first.data(), second.data(), count * sizeof(PointResult)), 0) << count << " " << i;
        }
    }
  }
}

// Where the line of the ray doesn't say where it meets the triangle, the tracer's answer holds.
TEST_F(SurfacePointTest, a_ray_in_the_plane_of_the_triangle_keeps_the_hit) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Ray ray{.origin = {-1, 0.25f, 0}, .direction = {1, 0, 0}};
  const SurfacePoint point = make_surface_point(mesh, Placement(TransformD{}), ray,
                                                {.t = 1.5f, .instance = 0, .primitive = 0, .u = 0.5f, .v = 0.25f});
  EXPECT_EQ(point.position, Vec3f(0.5f, 0.25f, 0));
  EXPECT_EQ(point.t, 1.5f);
  EXPECT_LT(max_component(point.position_error), 1e-6f);
}

// A hit that the tracer's rounding found beside the triangle.
TEST_F(SurfacePointTest, a_hit_beside_the_triangle_is_on_its_edge) {
  int beside = 0;
  for (int i = 0; i < 5000; ++i) {
    Situation s = random_situation(false, true);
    Mesh& mesh = std::get<Mesh>(s.shape);
    mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
    // Towards a place just outside of an edge or a corner.
    const float u = uniform(-0.2f, 1.2f), v = uniform(-0.2f, 1.2f);
    const Vec3f target = mesh.positions[0] * (1 - u - v) + mesh.positions[1] * u + mesh.positions[2] * v;
    s.ray.direction = Transform(s.placement.object_to_world).point(target) - s.ray.origin;
    s.hit = {.t = 1, .instance = 3, .primitive = 0, .u = u, .v = v};
    const SurfacePoint point = s.point();
    beside += u < 0 || v < 0 || u + v > 1;
    EXPECT_TRUE(point.uv.x >= 0 && point.uv.y >= 0 && point.uv.x + point.uv.y <= 1 + 1e-6f) << u << " " << v;
    EXPECT_TRUE(is_finite(point.shading_normal));
    EXPECT_NEAR(point.t, 1, 1e-2);
  }
  EXPECT_GT(beside, 1000);
}

// The ray that leaves must not find the surface it left, wherever it goes.
TEST_F(SurfacePointTest, rays_that_leave_do_not_meet_their_own_surface) {
  for (const bool is_sphere : {false, true}) {
    int self_hits = 0;
    for (int i = 0; i < 50000; ++i) {
      const Situation s = random_situation(is_sphere);
      const SurfacePoint point = s.point();
      Vec3f direction = normalize(random_point(1));
      // From inside a sphere the far side is met, and rightly so.
      if (is_sphere && dot(direction, point.geometric_normal) < 0) direction = -direction;
      const Ray next{.origin = offset_origin(point, direction), .direction = direction};
      self_hits += find_hit(s.shape, s.placement.world_to_object, next).has_value();
    }
    EXPECT_EQ(self_hits, 0) << (is_sphere ? "sphere" : "triangle");
  }
}

TEST_F(SurfacePointTest, rays_into_a_sphere_meet_only_its_far_side) {
  for (int i = 0; i < 20000; ++i) {
    const Situation s = random_situation(true);
    const SurfacePoint point = s.point();
    const Vec3f direction = normalize(random_point(1));
    const float cosine = -dot(direction, point.geometric_normal);
    if (cosine < 0.01f) continue;
    const auto hit = find_hit(s.shape, s.placement.world_to_object,
                              {.origin = offset_origin(point, direction), .direction = direction});
    ASSERT_TRUE(hit) << i;
    const Vec3d crossed = Vec3d(direction) * double{hit->t};
    const double radius = double{std::get<Sphere>(s.shape).radius};
    EXPECT_GT(length(s.placement.world_to_object.vector(crossed)), 1e-3 * radius) << i;
  }
}

TEST_F(SurfacePointTest, rays_that_leave_meet_a_surface_close_by) {
  int found = 0, tried = 0;
  for (int i = 0; i < 20000; ++i) {
    Situation s = random_situation(false);
    const SurfacePoint point = s.point();
    const Vec3f normal = point.geometric_normal;
    // The same triangle, moved away by a few times the error and pushed against by a ray along the normal.
    const float gap = 8 * dot(abs(normal), point.position_error) + 4e-7f * max_component(abs(point.position));
    TransformD moved = s.placement.object_to_world;
    for (std::size_t axis = 0; axis < 3; ++axis) moved.rows[axis][3] += double{normal[axis] * gap};
    ++tried;
    const Ray next{.origin = offset_origin(point, normal), .direction = normal};
    const auto hit = find_hit(s.shape, inverse(moved), next);
    found += hit.has_value();
    EXPECT_TRUE(!hit || hit->t <= gap);
  }
  // Points within a gap of the triangle's edges may pass by.
  EXPECT_GT(found, tried * 999 / 1000);
}

TEST_F(SurfacePointTest, the_offset_goes_to_the_side_of_the_direction_and_no_farther_than_a_few_roundings) {
  for (int i = 0; i < 1000; ++i) {
    const SurfacePoint point = random_situation(false).point();
    const Vec3d normal(point.geometric_normal);
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f origin = offset_origin(point, point.geometric_normal * side);
      const double moved = dot(Vec3d(origin) - Vec3d(point.position), normal) * double{side};
      EXPECT_GT(moved, 0);
      EXPECT_LT(moved, 4 * double{length(point.position_error)} + 1e-6 * double{length(point.position)});
    }
  }
}

// What the two rays a step back and a step ahead find: their difference is free of second-order terms.
struct Neighbours {
  SurfacePoint behind, ahead;

  [[nodiscard]] Vec3d position_change() const { return Vec3d(ahead.position) - Vec3d(behind.position); }
  [[nodiscard]] Vec3d normal_change() const { return Vec3d(ahead.shading_normal) - Vec3d(behind.shading_normal); }
  [[nodiscard]] Vec2d uv_change() const { return Vec2d(ahead.uv) - Vec2d(behind.uv); }
};

std::optional<SurfacePoint> find_neighbour(Situation s, Vec3f origin_step, Vec3f direction_step) {
  s.ray.origin += origin_step;
  s.ray.direction += direction_step;
  const auto hit = find_hit(s.shape, s.placement.world_to_object, s.ray);
  if (!hit) return std::nullopt;
  s.hit = *hit;
  return s.point();
}

std::optional<Neighbours> find_neighbours(const Situation& s, Vec3f origin_step, Vec3f direction_step) {
  const auto behind = find_neighbour(s, -origin_step, -direction_step);
  const auto ahead = find_neighbour(s, origin_step, direction_step);
  if (!behind || !ahead) return std::nullopt;
  return Neighbours{*behind, *ahead};
}

// Steps of a thousandth of the shape, seen fairly flat on from some way off, away from the seam and poles of a sphere's uv.
std::optional<Neighbours> find_neighbours(const Situation& s, const SurfacePoint& point, Vec3f towards) {
  const bool is_sphere = std::holds_alternative<Sphere>(s.shape);
  if (std::abs(dot(s.ray.direction, point.geometric_normal)) < 0.5f) return std::nullopt;
  if (is_sphere && (std::abs(point.uv.y - 0.5f) > 0.4f || std::abs(point.uv.x - 0.5f) > 0.49f)) return std::nullopt;
  const Bounds3f box = transform_bounds(Transform(s.placement.object_to_world), bounds(s.shape));
  const float size = max_component(box.extent());
  if (s.hit.t < 0.01f * size) return std::nullopt;  // a step would cross the surface
  return find_neighbours(s, towards * (1e-3f * size), Vec3f(0));
}

// Of differences of floats of this size.
double rounding_of(const SurfacePoint& point) {
  return 2.5e-7 * (length(Vec3d(point.position)) + length(Vec3d(point.derivatives->dpdu)) +
                   length(Vec3d(point.derivatives->dpdv)));
}

TEST_F(SurfacePointTest, dpdu_and_dpdv_are_the_change_of_position_with_uv) {
  for (const bool is_sphere : {false, true}) {
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
      const Situation s = random_situation(is_sphere, true);
      const SurfacePoint point = s.point();
      const auto near_by = find_neighbours(s, point, random_point(1));
      if (!near_by) continue;
      const Vec3d expected = near_by->position_change();
      const Vec3d predicted = Vec3d(point.derivatives->dpdu) * near_by->uv_change().x +
                              Vec3d(point.derivatives->dpdv) * near_by->uv_change().y;
      EXPECT_LT(length(expected - predicted), 1e-3 * length(expected) + rounding_of(point))
          << i << (is_sphere ? " sphere" : " triangle");
      ++compared;
    }
    EXPECT_GT(compared, 1000);
  }
}

TEST_F(SurfacePointTest, dndu_and_dndv_are_the_change_of_the_shading_normal_with_uv) {
  for (const bool is_sphere : {false, true}) {
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
      const Situation s = random_situation(is_sphere, true);
      const SurfacePoint point = s.point();
      const auto near_by = find_neighbours(s, point, random_point(1));
      if (!near_by) continue;
      const Vec3d expected = near_by->normal_change();
      if (length(expected) > 1) continue;  // shading normals turn over where they pass under the surface
      const Vec2d uv_change = near_by->uv_change();
      const Vec3d predicted =
          Vec3d(point.derivatives->dndu) * uv_change.x + Vec3d(point.derivatives->dndv) * uv_change.y;
      const double rounding =
          2.5e-7 * (1 + length(Vec3d(point.derivatives->dndu)) + length(Vec3d(point.derivatives->dndv)));
      EXPECT_LT(length(expected - predicted), 1e-3 * length(expected) + rounding)
          << i << (is_sphere ? " sphere" : " triangle");
      ++compared;
    }
    EXPECT_GT(compared, 1000);
  }
}

TEST_F(SurfacePointTest, differentials_are_the_change_to_a_neighbouring_ray) {
  for (const bool is_sphere : {false, true}) {
    int compared = 0;
    for (int i = 0; i < 4000; ++i) {
      const Situation s = random_situation(is_sphere, true);
      const Bounds3f box = transform_bounds(Transform(s.placement.object_to_world), bounds(s.shape));
      const float size = max_component(box.extent()), angle = std::min(1.0f, size / s.hit.t);
      const RayDifferentials differentials{.origin_dx = random_point(size),
                                           .origin_dy = random_point(size),
                                           .direction_dx = random_point(angle),
                                           .direction_dy = random_point(angle)};
      SurfacePoint point = s.point();
      add_pixel_change(point, s.ray, differentials);
      if (!find_neighbours(s, point, Vec3f(0))) continue;  // seen flat on
      const auto compare = [&](Vec3f origin_change, Vec3f direction_change, Vec3f dp, Vec2f duv) {
        constexpr float step = 1e-3f;
        const auto near_by = find_neighbours(s, origin_change * step, direction_change * step);
        if (!near_by) return;
        const Vec3d expected = near_by->position_change();
        EXPECT_LT(length(expected - Vec3d(dp) * 2e-3), 1e-2 * length(expected) + rounding_of(point))
            << i << (is_sphere ? " sphere" : " triangle");
        // The difference in uv, taken to space.
        const Vec2d uv_error = near_by->uv_change() - Vec2d(duv) * 2e-3;
        const Vec3d in_space =
            Vec3d(point.derivatives->dpdu) * uv_error.x + Vec3d(point.derivatives->dpdv) * uv_error.y;
        EXPECT_LT(length(in_space), 2e-2 * length(expected) + rounding_of(point))
            << i << (is_sphere ? " sphere" : " triangle");
        ++compared;
      };
      compare(differentials.origin_dx, differentials.direction_dx, point.derivatives->dpdx, point.derivatives->duvdx);
      compare(differentials.origin_dy, differentials.direction_dy, point.derivatives->dpdy, point.derivatives->duvdy);
    }
    EXPECT_GT(compared, 1000);
  }
}

TEST_F(SurfacePointTest, normals_are_perpendicular_to_the_surface_and_of_unit_length) {
  for (const bool is_sphere : {false, true})
    for (int i = 0; i < 1000; ++i) {
      const SurfacePoint point = random_situation(is_sphere, true).point();
      EXPECT_NEAR(length(point.geometric_normal), 1, 1e-6);
      EXPECT_NEAR(length(point.shading_normal), 1, 1e-6);
      EXPECT_NEAR(dot(point.geometric_normal, normalize(point.derivatives->dpdu)), 0, 1e-5);
      EXPECT_NEAR(dot(point.geometric_normal, normalize(point.derivatives->dpdv)), 0, 1e-5);
      EXPECT_GE(dot(point.geometric_normal, point.shading_normal), 0);
    }
}

// A triangle in the plane z = 0, wound so that its normal is +z, seen from z = 2.
Situation simple_situation(const TransformD& object_to_world) {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}};
  mesh.triangles = {{0, 1, 2}};
  Situation s{.shape = mesh, .placement = Placement(object_to_world)};
  s.ray = {.origin = {0.25f, 0.5f, 2}, .direction = {0, 0, -1}};
  s.hit = find_hit(s.shape, s.placement.world_to_object, s.ray).value();
  return s;
}

TEST(SurfacePointSides, a_mirrored_surface_keeps_its_outward_side) {
  const TransformD mirrored({{{-1, 0, 0, 0.5}, {0, 1, 0, 0}, {0, 0, 1, 0}}});
  const TransformD flipped({{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 0}}});
  EXPECT_EQ(simple_situation({}).point().geometric_normal, Vec3f(0, 0, 1));
  EXPECT_EQ(simple_situation(mirrored).point().geometric_normal, Vec3f(0, 0, 1));
  EXPECT_EQ(simple_situation(flipped).point().geometric_normal, Vec3f(0, 0, -1));
  EXPECT_FALSE(simple_situation(mirrored).point().is_backfacing);
  EXPECT_TRUE(simple_situation(flipped).point().is_backfacing);
}

TEST(SurfacePointSides, normals_keep_the_surfaces_side_whichever_side_was_hit) {
  Situation s = simple_situation({});
  s.ray = {.origin = {0.25f, 0.5f, -2}, .direction = {0, 0, 1}};
  const SurfacePoint point = s.point();
  EXPECT_EQ(point.geometric_normal, Vec3f(0, 0, 1));
  EXPECT_EQ(point.shading_normal, Vec3f(0, 0, 1));
  EXPECT_TRUE(point.is_backfacing);
}

TEST(SurfacePointSides, the_winding_decides_and_corner_normals_follow) {
  Situation s = simple_situation({});
  std::get<Mesh>(s.shape).corner_normals.assign(3, normalize(Vec3f{0.3f, 0, -1}));
  const SurfacePoint point = s.point();
  EXPECT_EQ(point.geometric_normal, Vec3f(0, 0, 1));
  EXPECT_LT(length(point.shading_normal - normalize(Vec3f{-0.3f, 0, 1})), 1e-6f);
}

TEST(SurfacePointSides, corner_normals_that_cancel_leave_the_geometric_normal) {
  Situation s = simple_situation({});
  std::get<Mesh>(s.shape).corner_normals.assign(3, Vec3f(0));
  EXPECT_EQ(s.point().shading_normal, Vec3f(0, 0, 1));
}

TEST(SurfacePointSides, sphere_normals_point_outward_under_any_transform) {
  for (const double sign : {1.0, -1.0}) {
    const TransformD squashed({{{sign * 2, 0, 0, 1}, {0, 0.5, 0, 0}, {0, 0, 1, 0}}});
    Situation s{.shape = Sphere{}, .placement = Placement(squashed)};
    s.ray = {.origin = {2, 0.1f, 5}, .direction = {0, 0, -1}};
    s.hit = find_hit(s.shape, s.placement.world_to_object, s.ray).value();
    const SurfacePoint point = s.point();
    // The gradient of (x-1)^2/4 + 4 y^2 + z^2.
    const Vec3f p = point.position;
    EXPECT_LT(length(point.geometric_normal - normalize(Vec3f{(p.x - 1) / 4, 4 * p.y, p.z})), 1e-6f);
    EXPECT_FALSE(point.is_backfacing);
  }
}

TEST(SurfacePointUv, is_interpolated_or_barycentric_and_survives_a_degenerate_mapping) {
  Situation s = simple_situation({});
  EXPECT_NEAR(s.point().uv.x, 1.25f / 3, 1e-6);
  EXPECT_NEAR(s.point().uv.y, 0.5f, 1e-6);
  Mesh& mesh = std::get<Mesh>(s.shape);
  mesh.uvs = {{-1, -1}, {2, -1}, {-1, 2}};
  EXPECT_NEAR(s.point().uv.x, 0.25f, 1e-6);
  EXPECT_LT(length(s.point().derivatives->dpdu - Vec3f{1, 0, 0}), 1e-6f);
  EXPECT_LT(length(s.point().derivatives->dpdv - Vec3f{0, 1, 0}), 1e-6f);
  mesh.uvs.assign(3, {0.5f, 0.25f});
  const SurfacePoint point = s.point();
  EXPECT_EQ(point.uv, Vec2f(0.5f, 0.25f));
  EXPECT_GT(length(cross(point.derivatives->dpdu, point.derivatives->dpdv)), 0.1f);
}

TEST(SurfacePointData, carries_instance_primitive_and_material_slot) {
  Situation s = simple_situation({});
  EXPECT_EQ(s.point().material_slot, 0u);
  std::get<Mesh>(s.shape).material_slots = {5};
  s.hit.instance = 7;
  const SurfacePoint point = s.point();
  EXPECT_EQ(point.material_slot, 5u);
  EXPECT_EQ(point.instance, 7u);
  EXPECT_EQ(point.primitive, 0u);
}

TEST(SurfacePointData, a_sphere_has_no_triangle) {
  Situation s = simple_situation({});
  s.shape = Sphere{};
  s.hit = find_hit(s.shape, s.placement.world_to_object, s.ray).value();
  EXPECT_EQ(s.point().instance, 3u);
  EXPECT_EQ(s.point().primitive, Hit::none);
}

}  // namespace
}  // namespace basicrt
