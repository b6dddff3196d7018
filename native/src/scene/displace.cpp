// SPDX-License-Identifier: GPL-3.0-or-later
// Asks materials about each vertex, as a ray would see it that comes down on it.
#include "scene/displace.h"

#include <algorithm>
#include <array>

#include "base/parallel_for.h"
#include "scene/shade_point.h"

namespace basicrt {
namespace {

constexpr std::uint32_t no_corner = ~0u;
constexpr std::size_t at_once = 1024;

// Calls work(i) for all i below `count`.
template <class Work>
void for_each_index(std::size_t count, int threads, Work&& work) {
  parallel_for((count + at_once - 1) / at_once, threads, [&](std::size_t chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * at_once);
    for (std::size_t i = chunk * at_once; i < end; ++i) work(i);
  });
}

std::array<Vec3d, 3> corners_of(const Mesh& mesh, const std::vector<Vec3f>& positions, std::size_t triangle) {
  const auto& vertices = mesh.triangles[triangle];
  return {Vec3d(positions[vertices[0]]), Vec3d(positions[vertices[1]]), Vec3d(positions[vertices[2]])};
}

// Of any length.
Vec3d normal_of(const std::array<Vec3d, 3>& corners) { return cross(corners[1] - corners[0], corners[2] - corners[0]); }

const PreparedMaterial& material_of(const PreparedScene& scene, const PreparedScene::PreparedInstance& instance,
                                    const Mesh& mesh, std::size_t triangle) {
  const std::size_t slot = mesh.material_slots.empty() ? 0 : mesh.material_slots[triangle];
  return scene.materials[instance.materials[std::min(slot, instance.materials.size() - 1)]];
}

// For each vertex a corner of a triangle whose material moves it.
std::vector<std::uint32_t> moving_corners(const PreparedScene& scene, const PreparedScene::PreparedInstance& instance,
                                          const Mesh& mesh) {
  std::vector<std::uint32_t> corner_of(mesh.positions.size(), no_corner);
  for (std::uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    if (!material_of(scene, instance, mesh, triangle).displacement) continue;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      std::uint32_t& known = corner_of[mesh.triangles[triangle][corner]];
      if (known == no_corner) known = triangle * 3 + corner;
    }
  }
  return corner_of;
}

// In object space.
Displacement displacement_of(const PreparedScene& scene, std::uint32_t instance, const Mesh& mesh,
                             std::uint32_t corner) {
  constexpr std::array<Vec2f, 3> shares = {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{0, 1}};  // of the second and third corner
  const std::uint32_t triangle = corner / 3;
  const Placement& placement = scene.instances[instance].placement;
  const std::array<Vec3d, 3> corners = corners_of(mesh, mesh.positions, triangle);
  const Vec3d across = normal_of(corners);
  const Vec3d above = across / std::sqrt(std::max(length(across), 1e-300));  // about as far as the triangle is wide
  const Vec3d begin = placement.object_to_world.point(corners[corner % 3] + above);
  const Vec3d way = placement.object_to_world.vector(-above);
  const double distance = length(way);
  if (!(distance > 0)) return {};
  const Ray ray{.origin = Vec3f(begin), .direction = Vec3f(way / distance)};
  const Vec2f share = shares[corner % 3];
  const SurfacePoint point = surface_point_at(scene, ray, {float(distance), instance, triangle, share.x, share.y});
  Displacement made =
      displacement_at(scene.material_of(point), scene.textures, point, shading_context(scene, point, 0));
  made.offset = Vec3f(placement.world_to_object.vector(Vec3d(made.offset)));
  return made;
}

// The corners of each vertex, one vertex after another.
struct CornersOfVertices {
  std::vector<std::uint32_t> corners, firsts;

  explicit CornersOfVertices(const Mesh& mesh) : corners(mesh.triangles.size() * 3), firsts(mesh.positions.size() + 1) {
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) ++firsts[vertex + 1];
    for (std::size_t i = 1; i < firsts.size(); ++i) firsts[i] += firsts[i - 1];
    std::vector<std::uint32_t> next(firsts.begin(), firsts.end() - 1);
    for (std::uint32_t i = 0; i < corners.size(); ++i) corners[next[mesh.triangles[i / 3][i % 3]]++] = i;
  }
  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t vertex) const {
    return std::span(corners).subspan(firsts[vertex], firsts[vertex + 1] - firsts[vertex]);
  }
};

// Normals at time 0 say which corners of a vertex belong together: as smooth, they get the mean of their triangles' normals.
void smooth_normals(const Mesh& mesh, const std::vector<Vec3f>& before, const std::vector<std::uint8_t>& is_kept,
                    const std::vector<Vec3f>& positions, std::vector<Vec3f>& normals, int threads) {
  constexpr float alike = 1e-6f;  // squared distance of unit vectors
  const CornersOfVertices corners_of_vertices(mesh);
  for_each_index(mesh.positions.size(), threads, [&](std::size_t vertex) {
    const std::span<const std::uint32_t> corners = corners_of_vertices.of(vertex);
    for (const std::uint32_t corner : corners) {
      if (is_kept[corner] != 0) continue;
      const Vec3f own = normalize(before[corner]);
      Vec3d sum(0.0);
      for (const std::uint32_t other : corners) {
        if (is_kept[other] != 0 || length_squared(normalize(before[other]) - own) > alike) continue;
        const Vec3d normal = normal_of(corners_of(mesh, positions, other / 3));
        if (const double size = length(normal); size > 0) sum += normal / size;
      }
      if (const double size = length(sum); size > 0) normals[corner] = Vec3f(sum / size);
    }
  });
}

}  // namespace

bool is_displaced(const PreparedScene& scene, const PreparedScene::PreparedInstance& instance) {
  return std::holds_alternative<Mesh>(scene.shapes[instance.shape]) &&
         std::ranges::any_of(instance.materials, [&](std::uint32_t material) {
           return scene.materials[material].displacement.has_value();
         });
}

Mesh displaced_mesh(const PreparedScene& scene, std::uint32_t instance, int threads) {
  const PreparedScene::PreparedInstance& of = scene.instances[instance];
  const Mesh& before = std::get<Mesh>(scene.shapes[of.shape]);
  Mesh mesh = before;
  mesh.rest_positions = before.positions;
  const std::vector<std::uint32_t> corner_of = moving_corners(scene, of, before);
  std::vector<std::uint8_t> keeps_normals(before.positions.size(), 1);
  for_each_index(before.positions.size(), threads, [&](std::size_t vertex) {
    if (corner_of[vertex] == no_corner) return;
    const Displacement displacement = displacement_of(scene, instance, before, corner_of[vertex]);
    keeps_normals[vertex] = displacement.keeps_normals;
    mesh.positions[vertex] += displacement.offset;
    for (std::vector<Vec3f>& key : mesh.motion_positions) key[vertex] += displacement.offset;
    for (std::vector<Vec3f>& frame : mesh.adjacent_positions) frame[vertex] += displacement.offset;
  });
  if (before.corner_normals.empty()) return mesh;
  std::vector<std::uint8_t> is_kept(before.corner_normals.size());  // of each corner
  for (std::size_t i = 0; i < is_kept.size(); ++i)
    is_kept[i] =
        keeps_normals[before.triangles[i / 3][i % 3]] != 0 || !material_of(scene, of, before, i / 3).displacement;
  for (std::size_t key = 0; key <= mesh.motion_positions.size(); ++key) {
    std::vector<Vec3f>& normals = key == 0 ? mesh.corner_normals : mesh.motion_corner_normals[key - 1];
    smooth_normals(before, before.corner_normals, is_kept, mesh.positions_of_key(key), normals, threads);
  }
  return mesh;
}

}  // namespace basicrt
