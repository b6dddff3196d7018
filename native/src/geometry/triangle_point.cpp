// SPDX-License-Identifier: GPL-3.0-or-later
// Surface points on a mesh's triangles.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/error_bounds.h"
#include "geometry/local_point.h"
#include "geometry/triangle.h"

namespace basicrt {
namespace {

using Corners = std::array<Vec3d, 3>;

Vec3d interpolate(const Corners& corners, const std::array<double, 3>& weights) {
  return corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
}

// By the hit where the line of the ray doesn't say, and inside the triangle.
TriangleHit solve_again(const TriangleHit& exact, const Hit& hit) {
  const bool is_usable = std::isfinite(exact.t) && std::isfinite(exact.u) && std::isfinite(exact.v);
  const TriangleHit solved = is_usable ? exact : TriangleHit{hit.t, hit.u, hit.v};
  const double u = std::clamp(solved.u, 0.0, 1.0);
  return {solved.t, u, std::clamp(solved.v, 0.0, 1 - u)};
}

// At least the length of v, without a root.
double length_bound(Vec3d v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

// Three parts: interpolation; the barycentrics, which a grazing ray leaves uncertain along the plane; and the plane
// that the next ray's test will see, which is uncertain where the triangle is a sliver.
Vec3d position_error(const Corners& p, const std::array<double, 3>& weights, Vec3d position, const PreciseRay& ray) {
  const Vec3d edge1 = p[1] - p[0], edge2 = p[2] - p[0], from_p0 = ray.origin - p[0];
  const Vec3d edge_sum = abs(edge1) + abs(edge2);
  const Vec3d interpolation = (abs(p[0] * weights[0]) + abs(p[1] * weights[1]) + abs(p[2] * weights[2])) * gamma(6);
  const Vec3d cross_product = cross(edge1, edge2);
  const double area = max_component(abs(cross_product)), determinant = std::abs(dot(ray.direction, cross_product));
  const double coordinates = length_bound(ray.direction) *
                             (length_bound(from_p0) + length_bound(p[0]) + length_bound(ray.origin)) *
                             length_bound(edge_sum);
  const double uncertainty = determinant > 0 ? gamma(16) * coordinates / determinant : 0;
  const double product = length_bound(edge1) * length_bound(edge2);
  const double plane = area > 0 ? gamma(16) * length_bound(position - p[0]) * product / area : 0;
  return interpolation + edge_sum * uncertainty + Vec3d(plane);
}

struct Derivatives {
  Vec3d du, dv;
};

// Of a quantity that is linear over the triangle, from its differences along the edges. `is_usable` is false where
// the uvs don't span the plane.
struct UvEdges {
  Vec2d first, second;
  double inverse_determinant;

  explicit UvEdges(const std::array<Vec2d, 3>& uv)
      : first(uv[1] - uv[0]),
        second(uv[2] - uv[0]),
        inverse_determinant(1 / (first.x * second.y - first.y * second.x)) {}
  [[nodiscard]] bool is_usable() const { return std::isfinite(inverse_determinant); }
  [[nodiscard]] Derivatives derivatives(const Corners& values) const {
    const Vec3d along1 = values[1] - values[0], along2 = values[2] - values[0];
    return {(along1 * second.y - along2 * first.y) * inverse_determinant,
            (along2 * first.x - along1 * second.x) * inverse_determinant};
  }
};

}  // namespace

LocalPoint local_point_on_triangle(const Mesh& mesh, const PreciseRay& ray, const Hit& hit) {
  const std::uint32_t triangle = hit.primitive;
  const std::size_t first_corner = 3 * std::size_t{triangle};
  const Vec3f p0 = mesh.position(triangle, 0), p1 = mesh.position(triangle, 1), p2 = mesh.position(triangle, 2);
  const Corners positions{Vec3d(p0), Vec3d(p1), Vec3d(p2)};
  const TriangleHit solved = solve_again(intersect_triangle_plane(ray, p0, p1, p2), hit);
  const std::array weights{1 - solved.u - solved.v, solved.u, solved.v};
  const Vec3d position = interpolate(positions, weights);

  // Without texture coordinates, or where they are all on a line, the barycentrics parametrise the triangle.
  std::array<Vec2d, 3> uv{Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{0, 1}};
  UvEdges edges(uv);
  if (!mesh.uvs.empty()) {
    for (std::size_t i = 0; i < 3; ++i) uv[i] = Vec2d(mesh.uvs[first_corner + i]);
    const UvEdges given(uv);
    if (given.is_usable()) edges = given;
  }
  const Derivatives position_change = edges.derivatives(positions);

  Vec3d shading_normal;
  Derivatives normal_change;
  if (!mesh.corner_normals.empty()) {
    Corners normals;
    for (std::size_t i = 0; i < 3; ++i) normals[i] = Vec3d(mesh.corner_normals[first_corner + i]);
    shading_normal = interpolate(normals, weights);
    normal_change = edges.derivatives(normals);
  }
  return {.t = solved.t,
          .position = position,
          .error = position_error(positions, weights, position, ray),
          .normal = cross(positions[1] - positions[0], positions[2] - positions[0]),
          .shading_normal = shading_normal,
          .uv = uv[0] * weights[0] + uv[1] * weights[1] + uv[2] * weights[2],
          .dpdu = position_change.du,
          .dpdv = position_change.dv,
          .dndu = normal_change.du,
          .dndv = normal_change.dv,
          .material_slot = mesh.material_slots.empty() ? 0 : mesh.material_slots[triangle]};
}

}  // namespace basicrt
