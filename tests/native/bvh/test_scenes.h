// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes, rays and transforms for the bvh layer's tests, and the answer without any tree.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "base/overloaded.h"
#include "bvh/curve_reference.h"
#include "bvh/tracer.h"
#include "geometry/motion.h"
#include "geometry/sphere.h"
#include "geometry/triangle.h"

namespace basicrt::test {

using Random = std::mt19937;

inline float uniform(Random& rng, float lower, float upper) {
  return std::uniform_real_distribution<float>(lower, upper)(rng);
}
inline Vec3f random_point(Random& rng, float reach = 1) {
  const float x = uniform(rng, -reach, reach), y = uniform(rng, -reach, reach), z = uniform(rng, -reach, reach);
  return {x, y, z};
}

inline Mesh soup(Random& rng, int count, float size) {
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3f center = random_point(rng);
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(center + random_point(rng, size));
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// Axis-aligned, in the plane z = 0 over [-1, 1] squared.
inline Mesh flat_grid(std::uint32_t cells) {
  Mesh mesh;
  const auto at = [&](std::uint32_t i) { return 2 * static_cast<float>(i) / static_cast<float>(cells) - 1; };
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x) mesh.positions.push_back({at(x), at(y), 0});
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t corner = y * (cells + 1) + x;
      mesh.triangles.push_back({corner, corner + 1, corner + cells + 2});
      mesh.triangles.push_back({corner, corner + cells + 2, corner + cells + 1});
    }
  return mesh;
}

// The same triangles many times over.
inline Mesh coincident(Random& rng, int copies) {
  Mesh mesh = soup(rng, 1, 1);
  mesh.triangles.resize(static_cast<std::size_t>(copies), mesh.triangles[0]);
  return mesh;
}

// Points, lines and ordinary triangles mixed.
inline Mesh degenerate(Random& rng) {
  Mesh mesh = soup(rng, 60, 0.4f);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const std::uint32_t a = 3 * i;
    mesh.triangles[i] = i % 2 ? std::array{a, a, a} : std::array{a, a + 1, a};
    if (i % 4 == 0) {  // collinear, with three corners apart
      mesh.positions[a + 2] = mesh.positions[a] + (mesh.positions[a + 1] - mesh.positions[a]) * 2.0f;
      mesh.triangles[i] = {a, a + 1, a + 2};
    }
  }
  return mesh;
}

// Coordinates and sizes below the smallest normal float.
inline Mesh denormal(Random& rng) {
  Mesh mesh = soup(rng, 40, 0.5f);
  for (Vec3f& p : mesh.positions) p *= 1e-40f;
  return mesh;
}

struct NamedShape {
  std::string name;
  Shape shape;
};

inline std::vector<NamedShape> shapes_of_every_kind(Random& rng) {
  std::vector<NamedShape> shapes;
  shapes.push_back({"soup of small triangles", soup(rng, 700, 0.1f)});
  shapes.push_back({"soup of large triangles", soup(rng, 200, 1)});
  shapes.push_back({"flat grid", flat_grid(16)});
  shapes.push_back({"coincident", coincident(rng, 50)});
  shapes.push_back({"degenerate", degenerate(rng)});
  shapes.push_back({"denormal", denormal(rng)});
  shapes.push_back({"single triangle", soup(rng, 1, 1)});
  shapes.push_back({"three triangles", soup(rng, 3, 1)});
  shapes.push_back({"empty mesh", Mesh{}});
  shapes.push_back({"sphere", Sphere{{0.2f, -0.1f, 0.3f}, 0.5f}});
  PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    cloud.positions.push_back(random_point(rng));
    cloud.radii.push_back(uniform(rng, 0, 0.2f));
  }
  shapes.push_back({"point cloud", cloud});
  return shapes;
}

inline TracedInstance place(std::uint32_t shape, const TransformD& object_to_world) {
  return {.shape = shape, .object_to_world = object_to_world, .world_to_object = inverse(object_to_world)};
}

inline TracedInstance place_moving(std::uint32_t shape, std::vector<TransformD> keys) {
  TracedInstance instance = place(shape, keys.front());
  instance.motion = std::move(keys);
  return instance;
}
inline TransformD world_to_object(const TracedInstance& instance, float time) {
  return instance.motion.empty() ? instance.world_to_object : inverse(transform_at(instance.motion, time));
}

// Gives the mesh so many keys more, with its vertices anywhere near where they were.
inline Mesh deforming(Random& rng, Mesh mesh, int further_keys, float reach) {
  for (int key = 0; key < further_keys; ++key) {
    std::vector<Vec3f>& positions = mesh.motion_positions.emplace_back(mesh.positions);
    for (Vec3f& position : positions) position += random_point(rng, reach);
  }
  return mesh;
}

// Any time, and sometimes exactly that of a key.
inline float random_time(Random& rng) {
  const float time = uniform(rng, 0, 1);
  return std::uniform_int_distribution(0, 3)(rng) == 0 ? std::round(time * 4) / 4 : time;
}

inline TransformD random_transform(Random& rng) {
  TransformD m;
  do {
    for (auto& row : m.rows)
      for (double& x : row) x = static_cast<double>(uniform(rng, -1, 1));
  } while (std::abs(m.determinant()) < 0.05);
  return m;
}

// From anywhere around towards the middle; some along the axes, some from a plane's height, some with an interval.
inline Ray random_ray(Random& rng) {
  const Vec3f origin = random_point(rng, 2);
  Ray ray{.origin = origin, .direction = random_point(rng, 0.7f) - origin};
  const int kind = std::uniform_int_distribution(0, 7)(rng);
  const auto axis = std::uniform_int_distribution<std::size_t>(0, 2)(rng);
  if (kind == 0) ray.direction[axis] = 0.0f;
  if (kind == 1) ray.direction[axis] = -0.0f;
  if (kind == 2) {
    ray.direction = Vec3f(0);
    ray.direction[axis] = uniform(rng, -1, 1);
  }
  if (kind == 3) ray.origin[axis] = 0;
  if (kind == 4) ray.direction[axis] *= 1e-39f;
  if (kind == 5) {
    ray.t_min = uniform(rng, 0, 2);
    ray.t_max = ray.t_min + uniform(rng, 0, 2);
  }
  if (kind == 6) ray.direction *= 1e10f;
  return ray;
}

// The nearest hit by testing everything, with the tracer's rule for equal distances.
inline Hit brute_force(const std::vector<Shape>& shapes, const std::vector<TracedInstance>& instances, const Ray& ray) {
  Hit best;
  auto nearest = std::tuple{std::numeric_limits<double>::infinity(), Hit::none, Hit::none};
  const auto consider = [&](double t, double u, double v, std::uint32_t instance, std::uint32_t primitive) {
    if (std::tuple{t, instance, primitive} >= nearest) return;
    nearest = {t, instance, primitive};
    best = {static_cast<float>(t), instance, primitive, static_cast<float>(u), static_cast<float>(v)};
  };
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    if (!(instances[i].visibility & ray.kinds)) continue;
    const PreciseRay local = transform_ray(world_to_object(instances[i], ray.time), ray);
    const auto test_mesh = [&](const Mesh& mesh) {
      for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        if (i == ray.from_instance && triangle == ray.from_primitive) continue;
        PreciseRay copy = local;
        const auto corner = [&](int i_corner) { return mesh.position_at(triangle, i_corner, ray.time); };
        const auto hit = intersect_triangle(copy, corner(0), corner(1), corner(2));
        if (hit) consider(hit->t, hit->u, hit->v, i, triangle);
      }
    };
    const auto test_sphere = [&](const Sphere& sphere) {
      PreciseRay copy = local;
      if (const auto t = intersect_sphere(copy, sphere)) consider(*t, 0, 0, i, 0);
    };
    const auto test_points = [&](const PointCloud& cloud) {
      for (std::uint32_t point = 0; point < cloud.positions.size(); ++point) {
        PreciseRay copy = local;
        if (!(cloud.radii[point] > 0)) continue;
        if (const auto t = intersect_sphere(copy, sphere_of(cloud, point))) consider(*t, 0, 0, i, point);
      }
    };
    const auto test_curves = [&](const Curves& curves) {
      if (const auto hit = reference_hit(curves, local)) consider(hit->t, hit->u, 0, i, hit->segment);
    };
    std::visit(Overloaded{test_mesh, test_sphere, test_points, test_curves}, shapes[instances[i].shape]);
  }
  return best;
}

inline bool is_identical(const Hit& a, const Hit& b) {
  using Words = std::array<std::uint32_t, 5>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

inline Tracer make_tracer(const std::vector<Shape>& shapes, const std::vector<TracedInstance>& instances,
                          const BvhConfig& config) {
  std::vector<ShapeTree> trees;
  for (const Shape& shape : shapes) trees.push_back(build_shape_tree(shape, config));
  return Tracer(std::move(trees), instances, config);
}

}  // namespace basicrt::test
