// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes: meshes from OBJ files or written out, spheres, point clouds and curves.
#include <array>
#include <variant>

#include "io/described_json.h"
#include "io/obj.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

// A flat array of numbers, as many as `Element` has for each.
template <class Element, std::size_t count>
std::vector<Element> read_elements(const JsonValue& json) {
  using Number = std::conditional_t<std::is_same_v<Element, std::array<std::uint32_t, 3>>, std::uint32_t, float>;
  std::vector<Element> elements;
  std::vector<Number> numbers;
  read_numbers(json, numbers);
  if (numbers.size() % count != 0)
    json.fail("must have a multiple of " + std::to_string(count) + " numbers, has " + std::to_string(numbers.size()));
  elements.reserve(numbers.size() / count);
  for (std::size_t i = 0; i < numbers.size(); i += count) {
    if constexpr (count == 2)
      elements.push_back(Element{numbers[i], numbers[i + 1]});
    else
      elements.push_back(Element{numbers[i], numbers[i + 1], numbers[i + 2]});
  }
  return elements;
}

template <class Element, std::size_t count>
std::vector<Element> read_elements(const JsonValue& object, std::string_view key) {
  const auto json = object.find(key);
  return json ? read_elements<Element, count>(*json) : std::vector<Element>();
}

// An array of such arrays, one for each time or frame.
std::vector<std::vector<Vec3f>> read_keys(const JsonValue& object, std::string_view key) {
  std::vector<std::vector<Vec3f>> keys;
  const auto json = object.find(key);
  if (!json) return keys;
  json->expect_array();
  for (std::size_t i = 0; i < json->size(); ++i) keys.push_back(read_elements<Vec3f, 3>(json->item(i)));
  return keys;
}

constexpr std::array<std::string_view, 11> inline_mesh_keys = {
    "positions",      "triangles",         "corner_normals",        "uvs",
    "material_slots", "motion_positions",  "motion_corner_normals", "adjacent_positions",
    "attributes",     "texture_space_min", "texture_space_size"};

std::vector<MeshAttribute> read_attributes(const JsonValue& attributes) {
  attributes.expect_array();
  std::vector<MeshAttribute> result;
  for (std::size_t i = 0; i < attributes.size(); ++i) {
    const JsonValue attribute = attributes.item(i);
    attribute.check_keys(std::array<std::string_view, 3>{"name", "domain", "values"});
    MeshAttribute& added = result.emplace_back();
    read(attribute.require("name"), added.name);
    read_optional(attribute, "domain", added.domain);
    added.values = read_elements<Vec3f, 3>(attribute, "values");
  }
  return result;
}

Mesh read_inline_mesh(const JsonValue& object) {
  (void)object.require("positions");
  (void)object.require("triangles");
  Mesh mesh{.positions = read_elements<Vec3f, 3>(object, "positions"),
            .triangles = read_elements<std::array<std::uint32_t, 3>, 3>(object, "triangles"),
            .corner_normals = read_elements<Vec3f, 3>(object, "corner_normals"),
            .uvs = read_elements<Vec2f, 2>(object, "uvs"),
            .material_slots = {},
            .motion_positions = read_keys(object, "motion_positions"),
            .motion_corner_normals = read_keys(object, "motion_corner_normals"),
            .adjacent_positions = read_keys(object, "adjacent_positions")};
  if (const auto slots = object.find("material_slots")) read_numbers(*slots, mesh.material_slots);
  if (const auto attributes = object.find("attributes")) mesh.attributes = read_attributes(*attributes);
  read_optional(object, "texture_space_min", mesh.texture_space_min);
  read_optional(object, "texture_space_size", mesh.texture_space_size);
  validate(mesh, object.path());
  return mesh;
}

// Files that several shapes name are read once.
Id<Shape> read_obj_shape(SceneReader& reader, const JsonValue& path_json) {
  const std::filesystem::path path = reader.resolve_path(path_json).lexically_normal();
  if (const auto known = reader.obj_shapes.find(path); known != reader.obj_shapes.end()) return known->second;
  const Id<Shape> id = reader.scene.shapes.append(read_obj(path, reader.report));
  reader.obj_shapes.emplace(path, id);
  return id;
}

Id<Shape> read_mesh_shape(SceneReader& reader, const JsonValue& object) {
  if (const auto path = object.find("path")) {
    for (const std::string_view key : inline_mesh_keys)
      if (object.find(key)) path->fail("give this or \"" + std::string(key) + "\", not both");
    return read_obj_shape(reader, *path);
  }
  return reader.scene.shapes.append(read_inline_mesh(object));
}

Id<Shape> read_sphere_shape(SceneReader& reader, const JsonValue& object) {
  Sphere sphere;
  read_fields(object, sphere);
  return reader.scene.shapes.append(sphere);
}

template <class Number>
std::vector<Number> read_list(const JsonValue& object, std::string_view key) {
  std::vector<Number> numbers;
  if (const auto json = object.find(key)) read_numbers(*json, numbers);
  return numbers;
}

// For each of `count` things a radius, or one for all.
std::vector<float> read_radii(const JsonValue& object, std::size_t count) {
  const JsonValue radii = object.require("radii");
  if (!radii.json().is_number()) return read_list<float>(object, "radii");
  float radius = 0;
  read(radii, radius);
  return std::vector<float>(count, radius);
}

constexpr std::array<std::string_view, 4> point_cloud_keys = {"positions", "radii", "randoms", "attributes"};

Id<Shape> read_point_cloud(SceneReader& reader, const JsonValue& object) {
  (void)object.require("positions");
  PointCloud cloud{.positions = read_elements<Vec3f, 3>(object, "positions")};
  cloud.radii = read_radii(object, cloud.positions.size());
  cloud.randoms = read_list<float>(object, "randoms");
  if (const auto attributes = object.find("attributes")) cloud.attributes = read_attributes(*attributes);
  validate(cloud, object.path());
  return reader.scene.shapes.append(std::move(cloud));
}

constexpr std::array<std::string_view, 8> curves_keys = {"points",     "radii",   "firsts", "form",
                                                         "intercepts", "randoms", "uvs",    "attributes"};

Id<Shape> read_curves(SceneReader& reader, const JsonValue& object) {
  (void)object.require("points");
  (void)object.require("firsts");
  Curves curves{.points = read_elements<Vec3f, 3>(object, "points")};
  curves.radii = read_radii(object, curves.points.size());
  curves.firsts = read_list<std::uint32_t>(object, "firsts");
  read_optional(object, "form", curves.form);
  curves.intercepts = read_list<float>(object, "intercepts");
  curves.randoms = read_list<float>(object, "randoms");
  curves.uvs = read_elements<Vec2f, 2>(object, "uvs");
  if (const auto attributes = object.find("attributes")) curves.attributes = read_attributes(*attributes);
  validate(curves, object.path());
  return reader.scene.shapes.append(std::move(curves));
}

template <std::size_t count>
std::vector<std::string_view> with_type(const std::array<std::string_view, count>& keys) {
  std::vector<std::string_view> result = {"type"};
  result.insert(result.end(), keys.begin(), keys.end());
  return result;
}

std::vector<std::string_view> all_mesh_keys() {
  std::vector<std::string_view> keys = {"type", "path"};
  keys.insert(keys.end(), inline_mesh_keys.begin(), inline_mesh_keys.end());
  return keys;
}

struct ShapeKind {
  std::string_view name;
  std::vector<std::string_view> keys;
  Id<Shape> (*read)(SceneReader&, const JsonValue&);
};

const std::array shape_kinds = {ShapeKind{"mesh", all_mesh_keys(), read_mesh_shape},
                                ShapeKind{Sphere::kind, known_keys<Sphere>(), read_sphere_shape},
                                ShapeKind{PointCloud::kind, with_type(point_cloud_keys), read_point_cloud},
                                ShapeKind{Curves::kind, with_type(curves_keys), read_curves}};

}  // namespace

Id<Shape> read_shape(SceneReader& reader, const JsonValue& object, std::span<const std::string_view> extra_keys) {
  std::array<std::string_view, shape_kinds.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = shape_kinds[i].name;
  const ShapeKind& kind = shape_kinds[read_choice(object.require("type"), names, "type")];
  std::vector<std::string_view> keys = kind.keys;
  keys.insert(keys.end(), extra_keys.begin(), extra_keys.end());
  object.check_keys(keys);
  return kind.read(reader, object);
}

void read_shapes(SceneReader& reader, const JsonValue& shapes) {
  shapes.expect_object();
  for (const auto& [name, json] : shapes.json().items())
    reader.shapes.add(name, read_shape(reader, shapes.member(name), {}));
}

}  // namespace basicrt
