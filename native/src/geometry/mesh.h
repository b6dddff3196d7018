// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh in object space.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "base/report.h"
#include "geometry/motion.h"
#include "math/bounds.h"
#include "math/vec.h"

namespace basicrt {

// What the values of a mesh's attribute belong to.
enum class AttributeDomain : std::uint8_t { vertex, corner, face };
template <>
inline constexpr std::array enum_names<AttributeDomain> = std::to_array<std::string_view>({"vertex", "corner", "face"});

// Three numbers for each vertex, each corner of the triangles, or each triangle; a single number is there thrice.
struct MeshAttribute {
  std::string name;
  AttributeDomain domain = AttributeDomain::vertex;
  std::vector<Vec3f> values;
};

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // Per corner, three for each triangle, or none at all: without normals the mesh is flat-shaded.
  std::vector<Vec3f> corner_normals;
  std::vector<Vec2f> uvs;
  // Which of the instance's materials each triangle has; none at all means 0 for every triangle.
  std::vector<std::uint32_t> material_slots;
  // Of a mesh that deforms: the positions, and the corner normals where it has any, at further times. These are equally
  // spaced; the arrays above are of time 0, the last ones of time 1, and between two of them all is linear.
  std::vector<std::vector<Vec3f>> motion_positions, motion_corner_normals;

  // For the pass Vector: where the vertices were one frame before and will be one frame after. None, or these two.
  std::vector<std::vector<Vec3f>> adjacent_positions;

  std::vector<MeshAttribute> attributes;  // those that materials ask for
  std::vector<Vec3f> rest_positions;      // of a displaced mesh: where its vertices were, at time 0
  // Where the generated coordinates are 0, and how far from there they are 1.
  Vec3f texture_space_min{0.0f}, texture_space_size{1.0f};

  [[nodiscard]] bool is_deforming() const { return !motion_positions.empty(); }
  // Spans of time between two keys; 0 where it doesn't deform.
  [[nodiscard]] std::uint32_t motion_intervals() const { return static_cast<std::uint32_t>(motion_positions.size()); }
  // Key 0 is at time 0.
  [[nodiscard]] const std::vector<Vec3f>& positions_of_key(std::size_t key) const {
    return key == 0 ? positions : motion_positions[key - 1];
  }
  [[nodiscard]] const std::vector<Vec3f>& corner_normals_of_key(std::size_t key) const {
    return key == 0 ? corner_normals : motion_corner_normals[key - 1];
  }

  // At time 0.
  [[nodiscard]] Vec3f position(std::uint32_t triangle, int corner) const {
    return positions[triangles[triangle][corner]];
  }
  [[nodiscard]] Vec3f position_at(std::uint32_t triangle, int corner, float time) const {
    const std::uint32_t vertex = triangles[triangle][corner];
    if (!is_deforming()) return positions[vertex];
    const auto [first, fraction] = key_interval(motion_intervals(), time);
    return interpolate(positions_of_key(first)[vertex], positions_of_key(first + 1)[vertex], fraction);
  }
  // Of any length. `corner` counts all triangles' corners.
  [[nodiscard]] Vec3f corner_normal_at(std::size_t corner, float time) const {
    if (!is_deforming()) return corner_normals[corner];
    const auto [first, fraction] = key_interval(motion_intervals(), time);
    return interpolate(corner_normals_of_key(first)[corner], corner_normals_of_key(first + 1)[corner], fraction);
  }
};

[[nodiscard]] Bounds3f bounds(const Mesh& mesh);  // at all times

// At time 0.
[[nodiscard]] inline Bounds3f triangle_bounds(const Mesh& mesh, std::uint32_t triangle) {
  Bounds3f box;
  for (int corner = 0; corner < 3; ++corner) box.extend(mesh.position(triangle, corner));
  return box;
}

// Throws SceneError, naming `item`, when an index is out of range, a number is not finite or an array has the
// wrong length.
void validate(const Mesh& mesh, std::string_view item);

// The triangles that remove_degenerate_triangles() leaves, in their order.
[[nodiscard]] std::vector<std::uint32_t> usable_triangles(const Mesh& mesh);

// The mesh without triangles that have no area (they can't be hit), which are counted in one warning. One that deforms
// stays as it is: they may have one at another time.
[[nodiscard]] Mesh remove_degenerate_triangles(Mesh mesh, std::string_view item, Report& report);

}  // namespace basicrt
