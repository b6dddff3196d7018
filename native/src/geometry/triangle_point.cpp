// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives on a mesh's triangles.
#include <array>
#include <cmath>

#include "geometry/local_point.h"

namespace basicrt {
namespace {

using Corners = std::array<Vec3d, 3>;

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

LocalDerivatives derivatives_on_triangle(const Mesh& mesh, std::uint32_t triangle, Vec2f barycentrics, float time) {
  const std::size_t first_corner = 3 * std::size_t{triangle};
  Corners positions;
  for (int i = 0; i < 3; ++i) positions[i] = Vec3d(mesh.position_at(triangle, i, time));

  // Without texture coordinates, or where they are all on a line, the barycentrics parametrise the triangle.
  UvEdges edges({Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{0, 1}});
  if (!mesh.uvs.empty()) {
    std::array<Vec2d, 3> uv;
    for (std::size_t i = 0; i < 3; ++i) uv[i] = Vec2d(mesh.uvs[first_corner + i]);
    const UvEdges given(uv);
    if (given.is_usable()) edges = given;
  }
  const Derivatives position_change = edges.derivatives(positions);
  LocalDerivatives result{.dpdu = position_change.du, .dpdv = position_change.dv};
  if (mesh.corner_normals.empty()) return result;

  Corners normals;
  for (std::size_t i = 0; i < 3; ++i) normals[i] = Vec3d(mesh.corner_normal_at(first_corner + i, time));
  const Derivatives normal_change = edges.derivatives(normals);
  const double u = barycentrics.x, v = barycentrics.y;
  result.normal = normals[0] * (1 - u - v) + normals[1] * u + normals[2] * v;
  result.dndu = normal_change.du;
  result.dndv = normal_change.dv;
  return result;
}

}  // namespace basicrt
