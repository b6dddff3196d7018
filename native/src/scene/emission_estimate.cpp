// SPDX-License-Identifier: GPL-3.0-or-later
// Shades both sides at points that are spread evenly over each triangle.
#include "scene/emission_estimate.h"

#include <algorithm>

#include "base/overloaded.h"
#include "base/parallel_for.h"
#include "math/warp.h"
#include "sampling/sobol.h"
#include "scene/shade_point.h"

namespace basicrt {
namespace {

using Estimate = EmissiveInstance::Estimate;

// Many for few triangles, which may have a whole picture on each.
std::uint32_t points_of_triangle(std::size_t triangles) {
  constexpr std::size_t most_in_all = 4096, least = 4, most = 256;
  return static_cast<std::uint32_t>(std::clamp(most_in_all / triangles, least, most));
}

float emitted(const PreparedScene& scene, const Ray& ray, const Hit& hit) {
  const SurfacePoint point = surface_point_at(scene, ray, hit);
  const Color emission =
      shade_at(scene, point, -ray.direction, [&] { return shading_context(scene, point, 0); }).emission;
  const float result = luminance(emission);
  return result < infinity ? std::max(result, 0.0f) : 0;
}

// From both sides of a place in object space whose normal this is.
void add_both_sides(const PreparedScene& scene, std::uint32_t instance, std::uint32_t primitive, Vec3d place,
                    Vec3d normal, Vec2f uv, float share, Estimate& sum) {
  const TransformD& object_to_world = scene.instances[instance].placement.object_to_world;
  const double height = length(normal);
  const auto along = [&](double side) {
    const Vec3d begin = object_to_world.point(place + normal * side), way = object_to_world.vector(normal * -side);
    const double distance = length(way);
    const Ray ray{.origin = Vec3f(begin), .direction = Vec3f(way / distance)};
    return emitted(scene, ray, {float(distance), instance, primitive, uv.x, uv.y}) * share;
  };
  if (!(height > 0)) return;
  sum.front += along(1);
  sum.back += along(-1);
}

Estimate of_triangle(const PreparedScene& scene, std::uint32_t instance, const Mesh& mesh, std::uint32_t triangle,
                     std::uint32_t points) {
  const auto corner = [&](int i) { return Vec3d(mesh.position_at(triangle, i, 0)); };
  const Vec3d a = corner(0), b = corner(1), c = corner(2);
  const Vec3d across = cross(b - a, c - a);
  const Vec3d normal = across / std::sqrt(std::max(length(across), 1e-300));  // about as long as the triangle is wide
  Estimate sum;
  for (std::uint32_t i = 0; i < points; ++i) {
    const Vec2f at = sample_triangle(sobol_2d(i, triangle * 2 + 1, triangle * 2 + 2));
    const Vec3d place = a + (b - a) * double(at.x) + (c - a) * double(at.y);
    add_both_sides(scene, instance, triangle, place, normal, at, 1.0f / float(points), sum);
  }
  return sum;
}

Estimate of_sphere(const PreparedScene& scene, std::uint32_t instance, const Sphere& sphere) {
  constexpr std::uint32_t points = 256;
  Estimate sum;
  for (std::uint32_t i = 0; i < points; ++i) {
    const Vec3d normal = Vec3d(sample_sphere(sobol_2d(i, 1, 2))) * double(sphere.radius);
    add_both_sides(scene, instance, Hit::none, Vec3d(sphere.center) + normal, normal, {}, 1.0f / points, sum);
  }
  return sum;
}

// One in twenty samples goes to triangles that look dark.
void raise_darkest(std::vector<Estimate>& estimates) {
  constexpr double share = 0.05;
  const auto raise = [&](float Estimate::* side) {
    double sum = 0;
    for (const Estimate& estimate : estimates) sum += double(estimate.*side);
    const auto least = static_cast<float>(share * sum / double(estimates.size()));
    for (Estimate& estimate : estimates) estimate.*side = std::max(estimate.*side, least);
  };
  raise(&Estimate::front);
  raise(&Estimate::back);
}

}  // namespace

std::vector<Estimate> estimate_emission(const PreparedScene& scene, std::uint32_t instance, int threads) {
  constexpr std::size_t at_once = 256;
  const auto of_mesh = [&](const Mesh& mesh) {
    std::vector<Estimate> estimates(mesh.triangles.size());
    const std::uint32_t points = points_of_triangle(estimates.size());
    parallel_for((estimates.size() + at_once - 1) / at_once, threads, [&](std::size_t chunk) {
      const std::size_t end = std::min(estimates.size(), (chunk + 1) * at_once);
      for (std::size_t i = chunk * at_once; i < end; ++i)
        estimates[i] = of_triangle(scene, instance, mesh, static_cast<std::uint32_t>(i), points);
    });
    raise_darkest(estimates);
    return estimates;
  };
  const auto of_ball = [&](const Sphere& sphere) { return std::vector{of_sphere(scene, instance, sphere)}; };
  const auto of_other = [](const auto& /*shape*/) { return std::vector<Estimate>{}; };  // those aren't sampled
  return std::visit(Overloaded{of_mesh, of_ball, of_other}, scene.shapes[scene.instances[instance].shape]);
}

}  // namespace basicrt
