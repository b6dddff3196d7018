// SPDX-License-Identifier: GPL-3.0-or-later
// Checks meshes and drops triangles without area.
#include "geometry/mesh.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "geometry/check_arrays.h"

namespace basicrt {
namespace {

// To within what double precision can tell.
bool has_area(const Mesh& mesh, std::uint32_t triangle) {
  const Vec3d p0(mesh.position(triangle, 0));
  const Vec3d edge1 = Vec3d(mesh.position(triangle, 1)) - p0, edge2 = Vec3d(mesh.position(triangle, 2)) - p0;
  const double noise = 4 * std::numeric_limits<double>::epsilon() * length(edge1) * length(edge2);
  return length(cross(edge1, edge2)) > noise;
}

// Keeps the entries of the triangles in `kept`, `width` for each; an array that is absent stays absent.
template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept, std::size_t width) {
  if (values.empty()) return;
  std::vector<T> result;
  result.reserve(kept.size() * width);
  for (const std::size_t triangle : kept)
    for (std::size_t i = 0; i < width; ++i) result.push_back(values[triangle * width + i]);
  values = std::move(result);
}

void check_key_length(std::string_view item, std::string_view array, std::size_t key, std::size_t length,
                      std::size_t expected) {
  if (length != expected)
    throw SceneError(array_entry(item, array, key),
                     "has " + std::to_string(length) + " vectors, but at time 0 there are " + std::to_string(expected));
}

void validate_motion(const Mesh& mesh, std::string_view item) {
  const std::size_t keys = mesh.motion_positions.size(), normal_keys = mesh.motion_corner_normals.size();
  const std::size_t expected_normal_keys = mesh.corner_normals.empty() ? 0 : keys;
  if (normal_keys != expected_normal_keys)
    throw SceneError(std::string(item) + ".motion_corner_normals",
                     "must have as many keys as motion_positions where there are corner_normals, else none (" +
                         std::to_string(expected_normal_keys) + "), has " + std::to_string(normal_keys));
  for (std::size_t key = 0; key < keys; ++key) {
    check_key_length(item, "motion_positions", key, mesh.motion_positions[key].size(), mesh.positions.size());
    check_finite(item, "motion_positions[" + std::to_string(key) + "]", mesh.motion_positions[key]);
  }
  for (std::size_t key = 0; key < normal_keys; ++key) {
    check_key_length(item, "motion_corner_normals", key, mesh.motion_corner_normals[key].size(),
                     mesh.corner_normals.size());
    check_finite(item, "motion_corner_normals[" + std::to_string(key) + "]", mesh.motion_corner_normals[key]);
  }
}

void validate_adjacent(const Mesh& mesh, std::string_view item) {
  const std::size_t count = mesh.adjacent_positions.size();
  if (count != 0 && count != 2)
    throw SceneError(
        std::string(item) + ".adjacent_positions",
        "must be those of two frames, the one before and the one after, or none, has " + std::to_string(count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t length = mesh.adjacent_positions[i].size();
    if (length != mesh.positions.size())
      throw SceneError(array_entry(item, "adjacent_positions", i),
                       "has " + std::to_string(length) + " vectors, but there are " +
                           std::to_string(mesh.positions.size()) + " positions");
    check_finite(item, "adjacent_positions[" + std::to_string(i) + "]", mesh.adjacent_positions[i]);
  }
}

}  // namespace

Bounds3f bounds(const Mesh& mesh) {
  Bounds3f result;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle)
      for (std::size_t key = 0; key <= mesh.motion_intervals(); ++key) result.extend(mesh.positions_of_key(key)[index]);
  return result;
}

void validate(const Mesh& mesh, std::string_view item) {
  const std::size_t count = mesh.triangles.size();
  constexpr std::size_t limit = std::numeric_limits<std::uint32_t>::max();
  if (count >= limit || mesh.positions.size() >= limit)
    throw SceneError(item, "must have fewer than 2^32 - 1 positions and triangles");
  check_length(item, "corner_normals", mesh.corner_normals.size(), 3 * count, "three for each triangle");
  check_length(item, "uvs", mesh.uvs.size(), 3 * count, "three for each triangle");
  check_length(item, "material_slots", mesh.material_slots.size(), count, "one for each triangle");
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t index : mesh.triangles[i])
      if (index >= mesh.positions.size())
        throw SceneError(array_entry(item, "triangles", i), "index " + std::to_string(index) + ", but the mesh has " +
                                                                std::to_string(mesh.positions.size()) + " positions");
  check_finite(item, "positions", mesh.positions);
  check_finite(item, "corner_normals", mesh.corner_normals);
  check_finite(item, "uvs", mesh.uvs);
  validate_motion(mesh, item);
  validate_adjacent(mesh, item);
  for (const MeshAttribute& attribute : mesh.attributes) {
    const std::size_t expected = attribute.domain == AttributeDomain::vertex ? mesh.positions.size()
                                 : attribute.domain == AttributeDomain::face ? count
                                                                             : 3 * count;
    const std::string name = "attributes[\"" + attribute.name + "\"]";
    if (attribute.values.size() != expected)
      throw SceneError(std::string(item) + "." + name, "must have " + std::to_string(expected) + " values, has " +
                                                           std::to_string(attribute.values.size()));
    check_finite(item, name, attribute.values);
  }
}

std::vector<std::uint32_t> usable_triangles(const Mesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<std::uint32_t> kept;
  kept.reserve(count);
  for (std::uint32_t triangle = 0; triangle < count; ++triangle)
    if (mesh.is_deforming() || has_area(mesh, triangle)) kept.push_back(triangle);
  return kept;
}

Mesh remove_degenerate_triangles(Mesh mesh, std::string_view item, Report& report) {
  const std::size_t count = mesh.triangles.size();
  const std::vector<std::uint32_t> kept = usable_triangles(mesh);
  if (kept.size() == count) return mesh;
  report.warn(std::string(item) + ": " + std::to_string(count - kept.size()) + " of " + std::to_string(count) +
              " triangles have no area and are left out");
  keep(mesh.triangles, kept, 1);
  keep(mesh.corner_normals, kept, 3);
  keep(mesh.uvs, kept, 3);
  keep(mesh.material_slots, kept, 1);
  for (MeshAttribute& attribute : mesh.attributes) {
    if (attribute.domain == AttributeDomain::corner) keep(attribute.values, kept, 3);
    if (attribute.domain == AttributeDomain::face) keep(attribute.values, kept, 1);
  }
  return mesh;
}

}  // namespace basicrt
