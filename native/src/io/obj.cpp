// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ through tinyobjloader, which trusts its input: numbers and indices are checked here.
#include "io/obj.h"

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "io/file.h"
#include "io/triangulate.h"

namespace basicrt {
namespace {

// tinyobjloader reads what is no number as 0.
void check_numbers(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string keyword, word;
    words >> keyword;
    if (keyword != "v" && keyword != "vn" && keyword != "vt") continue;
    const std::string place = name + ":" + std::to_string(number);
    int count = 0;
    for (; words >> word && word[0] != '#'; ++count)
      if (word.find_first_not_of("+-.0123456789eE") != std::string::npos)
        throw SceneError(place, "\"" + word + "\" is not a finite number");
    const int expected = keyword == "vt" ? 1 : 3;
    if (count < expected) throw SceneError(place, keyword + " needs " + std::to_string(expected) + " numbers");
  }
}

// The faces of a file as they come in.
class MeshBuilder {
 public:
  MeshBuilder(std::string name, Report& report) : name_(std::move(name)), report_(report) {}

  void add_position(Vec3f position) { mesh_.positions.push_back(position); }
  void add_normal(Vec3f normal) { normals_.push_back(normal); }
  void add_uv(Vec2f uv) { uvs_.push_back(uv); }
  void add_face(std::span<const tinyobj::index_t> corners) {
    if (corners.size() < 3) return report_.warn(name_ + ": faces of fewer than three corners are left out");
    std::vector<Vec3f> polygon;
    std::vector<std::uint32_t> vertices;
    for (const tinyobj::index_t& corner : corners) {
      vertices.push_back(resolve(corner.vertex_index, mesh_.positions.size(), "vertex"));
      polygon.push_back(mesh_.positions[vertices.back()]);
    }
    for (const auto& triangle : triangulate(polygon)) {
      mesh_.triangles.push_back({vertices[triangle[0]], vertices[triangle[1]], vertices[triangle[2]]});
      for (const std::uint32_t corner : triangle) add_corner(corners[corner]);
    }
  }

  // Normals and uvs only where every corner has them.
  Mesh finish() {
    if (mesh_.corner_normals.size() != 3 * mesh_.triangles.size()) mesh_.corner_normals.clear();
    if (mesh_.uvs.size() != 3 * mesh_.triangles.size()) mesh_.uvs.clear();
    return std::move(mesh_);
  }

 private:
  void add_corner(const tinyobj::index_t& corner) {
    // No index at all is a 0 too.
    if (corner.normal_index != 0)
      mesh_.corner_normals.push_back(normals_[resolve(corner.normal_index, normals_.size(), "normal")]);
    if (corner.texcoord_index != 0)
      mesh_.uvs.push_back(uvs_[resolve(corner.texcoord_index, uvs_.size(), "texture coordinate")]);
  }

  // OBJ counts from 1, or from the end with negative numbers.
  [[nodiscard]] std::uint32_t resolve(int index, std::size_t count, const char* what) const {
    const std::int64_t absolute = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
    if (index == 0 || absolute < 0 || absolute >= static_cast<std::int64_t>(count))
      throw SceneError(name_, "a face refers to " + std::string(what) + " " + std::to_string(index) +
                                  ", but there are " + std::to_string(count));
    return static_cast<std::uint32_t>(absolute);
  }

  std::string name_;
  Report& report_;
  Mesh mesh_;
  std::vector<Vec3f> normals_;
  std::vector<Vec2f> uvs_;
};

MeshBuilder& builder_of(void* data) { return *static_cast<MeshBuilder*>(data); }

tinyobj::callback_t make_callbacks() {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* data, float x, float y, float z, float) { builder_of(data).add_position({x, y, z}); };
  callbacks.normal_cb = [](void* data, float x, float y, float z) { builder_of(data).add_normal({x, y, z}); };
  callbacks.texcoord_cb = [](void* data, float u, float v, float) { builder_of(data).add_uv({u, v}); };
  callbacks.index_cb = [](void* data, tinyobj::index_t* indices, int count) {
    builder_of(data).add_face(std::span<const tinyobj::index_t>(indices, static_cast<std::size_t>(count)));
  };
  return callbacks;
}

// A face whose corner normals point to its back is wound the other way.
void wind_by_normals(Mesh& mesh) {
  if (mesh.corner_normals.empty()) return;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Vec3f* normals = &mesh.corner_normals[std::size_t{3} * i];
    const Vec3d p0(mesh.position(i, 0)), p1(mesh.position(i, 1)), p2(mesh.position(i, 2));
    if (dot(cross(p1 - p0, p2 - p0), Vec3d(normals[0] + normals[1] + normals[2])) >= 0) continue;
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
    std::swap(normals[1], normals[2]);
    if (!mesh.uvs.empty()) std::swap(mesh.uvs[std::size_t{3} * i + 1], mesh.uvs[std::size_t{3} * i + 2]);
  }
}

}  // namespace

Mesh read_obj(const std::filesystem::path& path, Report& report) {
  const std::string text = read_file(path), name = path.string();
  check_numbers(text, name);
  MeshBuilder builder(name, report);
  std::istringstream stream(text);
  std::string warnings, errors;  // of materials, which are not read
  if (!tinyobj::LoadObjWithCallback(stream, make_callbacks(), &builder, nullptr, &warnings, &errors))
    throw SceneError(name, errors.substr(0, errors.find('\n')));
  Mesh mesh = builder.finish();
  validate(mesh, name);
  wind_by_normals(mesh);
  return mesh;
}

}  // namespace basicrt
