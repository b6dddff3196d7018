// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh in object space.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/report.h"
#include "math/bounds.h"
#include "math/vec.h"

namespace basicrt {

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // Per corner, three for each triangle, or none at all: without normals the mesh is flat-shaded.
  std::vector<Vec3f> corner_normals;
  std::vector<Vec2f> uvs;
  // Which of the instance's materials each triangle has; none at all means 0 for every triangle.
  std::vector<std::uint32_t> material_slots;

  [[nodiscard]] Vec3f position(std::uint32_t triangle, int corner) const {
    return positions[triangles[triangle][corner]];
  }
};

[[nodiscard]] Bounds3f bounds(const Mesh& mesh);

[[nodiscard]] inline Bounds3f triangle_bounds(const Mesh& mesh, std::uint32_t triangle) {
  Bounds3f box;
  for (int corner = 0; corner < 3; ++corner) box.extend(mesh.position(triangle, corner));
  return box;
}

// Throws SceneError, naming `item`, when an index is out of range, a number is not finite or an array has the
// wrong length.
void validate(const Mesh& mesh, std::string_view item);

// The mesh without triangles that have no area (they can't be hit), which are counted in one warning.
[[nodiscard]] Mesh remove_degenerate_triangles(Mesh mesh, std::string_view item, Report& report);

}  // namespace basicrt
