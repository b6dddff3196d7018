// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ through tinyobjloader, which trusts its input: numbers and indices are checked here.
#include "io/obj.h"

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

#include <sstream>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "io/file.h"

namespace basicrt {
namespace {

struct ObjData {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
};

// tinyobjloader reads what is no number as 0.
void check_numbers(const std::string& text, const std::string& name) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string keyword, word;
    words >> keyword;
    if (keyword != "v" && keyword != "vn" && keyword != "vt") continue;
    int count = 0;
    for (; words >> word && word[0] != '#'; ++count)
      if (word.find_first_not_of("+-.0123456789eE") != std::string::npos)
        throw SceneError(name + ":" + std::to_string(number), "\"" + word + "\" is not a finite number");
    const int expected = keyword == "vt" ? 1 : 3;
    if (count < expected)
      throw SceneError(name + ":" + std::to_string(number),
                       keyword + " needs " + std::to_string(expected) + " numbers");
  }
}

ObjData parse(const std::string& text, const std::string& name, bool triangulate) {
  ObjData data;
  std::istringstream stream(text);
  std::string warnings, errors;  // the warnings are of materials, which are not read, and of what is checked here
  if (!tinyobj::LoadObj(&data.attributes, &data.shapes, nullptr, &warnings, &errors, &stream, nullptr, triangulate))
    throw SceneError(name, errors.substr(0, errors.find('\n')));
  return data;
}

void check_index(int index, std::size_t count, const char* what, const std::string& name) {
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw SceneError(name, "a face refers to " + std::string(what) + " " + std::to_string(index + 1) +
                               ", but there are " + std::to_string(count));
}

void check_indices(const ObjData& data, const std::string& name) {
  for (const tinyobj::shape_t& shape : data.shapes) {
    for (const tinyobj::index_t& index : shape.mesh.indices) {
      check_index(index.vertex_index, data.attributes.vertices.size() / 3, "vertex", name);
      if (index.normal_index != -1) check_index(index.normal_index, data.attributes.normals.size() / 3, "normal", name);
      if (index.texcoord_index != -1)
        check_index(index.texcoord_index, data.attributes.texcoords.size() / 2, "texture coordinate", name);
    }
  }
}

Vec3f vector_at(const std::vector<float>& numbers, int index) {
  const std::size_t first = std::size_t{3} * static_cast<std::size_t>(index);
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

// Each corner's index triple, three for each triangle.
std::vector<tinyobj::index_t> collect_corners(const ObjData& data) {
  std::vector<tinyobj::index_t> corners;
  for (const tinyobj::shape_t& shape : data.shapes)
    corners.insert(corners.end(), shape.mesh.indices.begin(), shape.mesh.indices.end());
  return corners;
}

Mesh make_mesh(const ObjData& data) {
  const tinyobj::attrib_t& attributes = data.attributes;
  const std::vector<tinyobj::index_t> corners = collect_corners(data);
  const auto has = [&](int tinyobj::index_t::* index) {
    return std::ranges::none_of(corners, [&](const tinyobj::index_t& corner) { return corner.*index < 0; });
  };

  Mesh mesh;
  for (int i = 0; i < static_cast<int>(attributes.vertices.size() / 3); ++i)
    mesh.positions.push_back(vector_at(attributes.vertices, i));
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    mesh.triangles.push_back({static_cast<std::uint32_t>(corners[i].vertex_index),
                              static_cast<std::uint32_t>(corners[i + 1].vertex_index),
                              static_cast<std::uint32_t>(corners[i + 2].vertex_index)});
  if (has(&tinyobj::index_t::normal_index))
    for (const tinyobj::index_t& corner : corners)
      mesh.corner_normals.push_back(vector_at(attributes.normals, corner.normal_index));
  if (has(&tinyobj::index_t::texcoord_index))
    for (const tinyobj::index_t& corner : corners) {
      const float* uv = attributes.texcoords.data() + std::size_t{2} * static_cast<std::size_t>(corner.texcoord_index);
      mesh.uvs.emplace_back(uv[0], uv[1]);
    }
  return mesh;
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
  // Triangulating looks at the vertices: only when every index has been checked.
  check_indices(parse(text, name, false), name);
  Mesh mesh = make_mesh(parse(text, name, true));
  validate(mesh, name);
  wind_by_normals(mesh);
  if (mesh.triangles.empty()) report.warn(name + ": has no faces");
  return mesh;
}

}  // namespace basicrt
