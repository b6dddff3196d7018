// SPDX-License-Identifier: GPL-3.0-or-later
// One small function for each part of a scene. Few bytes make many triangles and rays, so that what fuzzers change matters.
#include "fuzz/scene_of_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <variant>

#include "bvh/test_scenes.h"

namespace basicrt::fuzz {
namespace {

constexpr std::uint32_t most_shapes = 3, most_instances = 4, most_triangles = 24, most_copies = 6, most_rays = 64;

// How a mesh's or a transform's numbers are made.
class Numbers {
 public:
  explicit Numbers(ByteReader& bytes) : bytes_(bytes), kind_(bytes.below(4)) {
    if (kind_ >= 2) exponent_ = bytes.signed_byte();
  }
  float next() {
    if (kind_ == 0) return bytes_.small_number();
    if (kind_ == 1) return bytes_.any_finite_float();
    if (kind_ == 2) return bytes_.number_of_any_size(std::clamp(exponent_, -149, 120));
    return bytes_.small_number() + std::ldexp(1.0f, exponent_ % 24);  // small things far from the origin
  }
  Vec3f next_three() {
    const float x = next(), y = next(), z = next();
    return {x, y, z};
  }

 private:
  ByteReader& bytes_;
  std::uint32_t kind_;
  int exponent_ = 0;
};

// Any triangles over any positions, and copies of all that further along.
Mesh make_any_mesh(ByteReader& bytes) {
  Mesh mesh;
  Numbers numbers(bytes);
  const std::uint32_t position_count = 1 + bytes.below(most_triangles), triangle_count = bytes.below(most_triangles);
  for (std::uint32_t i = 0; i < position_count; ++i) mesh.positions.push_back(numbers.next_three());
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    const std::uint32_t a = bytes.below(position_count), b = bytes.below(position_count);
    mesh.triangles.push_back({a, b, bytes.below(position_count)});
  }
  const std::uint32_t copies = bytes.below(most_copies);
  const Vec3f step = copies > 0 ? numbers.next_three() : Vec3f(0);
  for (std::uint32_t copy = 1; copy <= copies; ++copy) {
    for (std::uint32_t i = 0; i < position_count; ++i) {
      const Vec3f moved = mesh.positions[i] + step * static_cast<float>(copy);
      mesh.positions.push_back(std::isfinite(moved.x + moved.y + moved.z) ? moved : mesh.positions[i]);
    }
    for (std::uint32_t i = 0; i < triangle_count; ++i) {
      auto triangle = mesh.triangles[i];
      for (std::uint32_t& corner : triangle) corner += copy * position_count;
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

// Rings around the origin, each corner as far out as the bytes say, in [0.5, 1.5). Closed, whatever they are.
Mesh make_closed_mesh(ByteReader& bytes) {
  const std::uint32_t slices = 4 + bytes.below(9), rings = 4 + bytes.below(5);
  const bool is_round = bytes.below(2) == 0;
  Mesh mesh;
  const auto add = [&](std::uint32_t ring, std::uint32_t slice) {
    const double polar = std::numbers::pi * ring / rings, azimuth = 2 * std::numbers::pi * slice / slices;
    const double radius = is_round ? 1 : 0.5 + bytes.byte() / 256.0;
    mesh.positions.emplace_back(
        Vec3d{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)} * radius);
  };
  add(0, 0);
  for (std::uint32_t ring = 1; ring < rings; ++ring)
    for (std::uint32_t slice = 0; slice < slices; ++slice) add(ring, slice);
  add(rings, 0);
  const auto at = [&](std::uint32_t ring, std::uint32_t slice) {
    if (ring == 0) return 0u;
    if (ring == rings) return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    return 1 + (ring - 1) * slices + slice % slices;
  };
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
      if (ring > 0) mesh.triangles.push_back({at(ring, slice), at(ring + 1, slice), at(ring, slice + 1)});
      if (ring + 1 < rings)
        mesh.triangles.push_back({at(ring, slice + 1), at(ring + 1, slice), at(ring + 1, slice + 1)});
    }
  return mesh;
}

Shape make_shape(ByteReader& bytes) {
  const std::uint32_t kind = bytes.below(4);
  if (kind == 0) return make_closed_mesh(bytes);
  if (kind < 3) return make_any_mesh(bytes);
  Numbers numbers(bytes);
  const Vec3f center = numbers.next_three();
  const float radius = std::abs(numbers.next());
  return Sphere{.center = center, .radius = radius > 0 ? radius : 1};
}

TransformD make_any_transform(ByteReader& bytes) {
  const std::uint32_t kind = bytes.below(5);
  TransformD m;
  if (kind == 0) return m;
  if (kind == 1) {  // moved
    Numbers numbers(bytes);
    for (auto& row : m.rows) row[3] = static_cast<double>(numbers.next());
  } else if (kind == 2) {  // scaled along the axes: mirrored and nearly flat ones among them
    for (std::size_t i = 0; i < 3; ++i) m.rows[i][i] = static_cast<double>(bytes.number_of_any_size(-bytes.below(40)));
  } else {
    for (auto& row : m.rows)
      for (double& number : row)
        number = static_cast<double>(kind == 3 ? bytes.small_number() : bytes.any_finite_float());
  }
  return m;
}

// As scenes are checked: neither flat nor reaching out too far.
bool is_allowed(const TransformD& m, const Bounds3f& bounds) {
  const double size = length(m.column(0)) * length(m.column(1)) * length(m.column(2));
  if (!std::isfinite(size) || !(std::abs(m.determinant()) > 1e-9 * size)) return false;
  bool is_finite = true;
  for_each_number(inverse(m), [&](double number) { is_finite = is_finite && std::isfinite(number); });
  const auto box = transform_bounds(m, Bounds3<double>{Vec3d(bounds.lower), Vec3d(bounds.upper)});
  return is_finite && (box.is_empty() || max_component(max(abs(box.lower), abs(box.upper))) <= 1e15);
}

bool is_allowed(const TransformD& m, const Shape& shape) { return is_allowed(m, bounds(shape)); }

Vec3f point_on(const FuzzScene& scene, std::uint32_t instance, std::uint32_t triangle, float u, float v) {
  const TracedInstance& placed = scene.instances[instance];
  const Shape& shape = scene.shapes[placed.shape];
  Vec3d point;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    point = Vec3d(sphere->center) + Vec3d{1 - double{u} - double{v}, double{u}, double{v}} * double{sphere->radius};
  } else if (const Mesh& mesh = std::get<Mesh>(shape); !mesh.triangles.empty()) {
    const auto corner = [&](int i) { return Vec3d(mesh.position(triangle, i)); };
    point = corner(0) * (1 - double{u} - double{v}) + corner(1) * double{u} + corner(2) * double{v};
  }
  return Vec3f(placed.object_to_world.point(point));
}

std::uint32_t pick_triangle(ByteReader& bytes, const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh == nullptr || mesh->triangles.empty() ? 0
                                                    : bytes.below(static_cast<std::uint32_t>(mesh->triangles.size()));
}

// On a corner, on an edge or inside.
Vec3f pick_point(ByteReader& bytes, const FuzzScene& scene, std::uint32_t instance, std::uint32_t triangle) {
  constexpr std::array<std::array<float, 2>, 8> places{
      {{0, 0}, {1, 0}, {0, 1}, {0.5f, 0}, {0, 0.5f}, {0.5f, 0.5f}, {0.25f, 0.25f}, {0, 0}}};
  const std::uint32_t place = bytes.below(places.size());
  auto [u, v] = places[place];
  if (place == 7) u = static_cast<float>(bytes.byte()) / 256, v = static_cast<float>(bytes.byte()) / 256 * (1 - u);
  return point_on(scene, instance, triangle, u, v);
}

Ray make_any_ray(ByteReader& bytes, const FuzzScene& scene) {
  Ray ray;
  const std::uint32_t kind = bytes.below(6);
  const auto any_three = [&] {
    const float x = bytes.any_float(), y = bytes.any_float(), z = bytes.any_float();
    return Vec3f{x, y, z};
  };
  const auto small_three = [&] {
    const float x = bytes.small_number(), y = bytes.small_number(), z = bytes.small_number();
    return Vec3f{x, y, z};
  };
  if (kind == 0 || scene.instances.empty()) {
    ray.origin = any_three();
    ray.direction = any_three();
    ray.t_min = bytes.any_float();
    ray.t_max = bytes.any_float();
    return ray;
  }
  const std::uint32_t instance = bytes.below(static_cast<std::uint32_t>(scene.instances.size()));
  const Shape& shape = scene.shapes[scene.instances[instance].shape];
  const std::uint32_t triangle = pick_triangle(bytes, shape);
  const Vec3f point = pick_point(bytes, scene, instance, triangle);
  if (kind == 1) {  // from anywhere to there
    ray.origin = any_three();
    ray.direction = point - ray.origin;
  } else if (kind == 2) {  // from near the origin
    ray.origin = small_three();
    ray.direction = point - ray.origin;
    if (bytes.below(4) == 0) ray.t_max = 1;
  } else if (kind == 3) {  // along an axis
    const std::uint32_t axis = bytes.below(3);
    ray.direction[axis] = std::ldexp(bytes.below(2) ? -1.0f : 1.0f, bytes.signed_byte() / 2);
    ray.origin = point;
    ray.origin[axis] = bytes.small_number();
  } else {  // on from there
    ray.origin = point;
    ray.direction = small_three();
    const auto* mesh = std::get_if<Mesh>(&shape);
    if (kind == 4 && mesh != nullptr && !mesh->triangles.empty()) {
      ray.from_instance = instance;
      ray.from_primitive = triangle;
    }
  }
  return ray;
}

// From near the middle of the closed mesh, which the instance places.
Ray make_ray_from_inside(ByteReader& bytes, const FuzzScene& scene) {
  const Vec3f point = pick_point(bytes, scene, 0, pick_triangle(bytes, scene.shapes[0]));
  const auto near_middle = [&] { return static_cast<double>(bytes.signed_byte()) / 8192; };
  const double x = near_middle(), y = near_middle(), z = near_middle();
  const Vec3f origin(scene.instances[0].object_to_world.point(Vec3d{x, y, z}));
  Ray ray{.origin = origin, .direction = point - origin};
  if (bytes.below(4) == 0) ray.direction[bytes.below(3)] = 0;
  // Of shorter directions the distance to the mesh may be more than a float holds.
  if (max_component(abs(ray.direction)) < 1e-30f) ray.direction.x = 1;
  return ray;
}

// Up to most_rays, many of them as neighbours that point much the same way, since those walk together.
template <class MakeRay>
void add_rays(ByteReader& bytes, FuzzScene& scene, const MakeRay& make_ray) {
  const std::uint32_t groups = 1 + bytes.below(12);
  for (std::uint32_t group = 0; group < groups && scene.rays.size() < most_rays; ++group) {
    Ray ray = make_ray();
    ray.time = 0;
    const std::uint32_t neighbours = bytes.below(4) == 0 ? bytes.below(40) : 0;
    const Vec3f step{bytes.small_number() / 64, bytes.small_number() / 64, bytes.small_number() / 64};
    for (std::uint32_t i = 0; i <= neighbours && scene.rays.size() < most_rays; ++i) {
      scene.rays.push_back(ray);
      ray.direction += step;
      if (ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0) break;
    }
  }
}

FuzzScene make_closed_scene(ByteReader& bytes) {
  FuzzScene scene{.shapes = {make_closed_mesh(bytes)}, .instances = {}, .rays = {}, .is_closed = true};
  TransformD m = make_any_transform(bytes);
  // What rounding may do to it is small beside the mesh.
  double reach = 0, size = 1;
  for (int i = 0; i < 3; ++i) size *= length(m.column(i));
  for_each_number(m, [&](double number) { reach = std::max(reach, std::abs(number)); });
  if (!(reach <= 8192) || !(std::abs(m.determinant()) > 0.05 * size) || !(size > 0.01)) m = {};
  const std::uint32_t copies = 1 + bytes.below(2);  // used twice, it has a tree of its own
  scene.instances.assign(copies, test::place(0, m));
  add_rays(bytes, scene, [&] { return make_ray_from_inside(bytes, scene); });
  return scene;
}

}  // namespace

FuzzScene make_scene(ByteReader& bytes) {
  if (bytes.below(4) == 0) return make_closed_scene(bytes);
  FuzzScene scene;
  const std::uint32_t shape_count = bytes.below(most_shapes + 1);
  for (std::uint32_t i = 0; i < shape_count; ++i) scene.shapes.push_back(make_shape(bytes));
  const std::uint32_t instance_count = shape_count > 0 ? bytes.below(most_instances + 1) : 0;
  for (std::uint32_t i = 0; i < instance_count; ++i) {
    const std::uint32_t shape = bytes.below(shape_count);
    const TransformD transform = make_any_transform(bytes);
    TracedInstance instance = test::place(shape, transform);
    if (bytes.below(8) == 0) instance.visibility = bytes.byte();
    if (is_allowed(transform, scene.shapes[shape])) scene.instances.push_back(instance);
  }
  add_rays(bytes, scene, [&] {
    Ray ray = make_any_ray(bytes, scene);
    if (bytes.below(8) == 0) ray.kinds = bytes.byte();
    return ray;
  });
  return scene;
}

Mesh make_moved(ByteReader& bytes, Mesh mesh) {
  Numbers numbers(bytes);
  for (Vec3f& position : mesh.positions) position = numbers.next_three();
  return mesh;
}

}  // namespace basicrt::fuzz
