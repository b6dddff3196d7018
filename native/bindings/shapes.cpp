// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh and Sphere.
#include <memory>

#include "array_vectors.h"
#include "described.h"
#include "geometry/shape.h"
#include "register.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

// The first axis are the keys.
std::vector<std::vector<Vec3f>> to_keys(const py::array_t<float>& array) {
  const std::vector<Vec3f> all = to_vector<Vec3f>(array);
  const auto count = static_cast<std::size_t>(array.shape(0));
  const std::size_t size = count == 0 ? 0 : all.size() / count;
  std::vector<std::vector<Vec3f>> keys(count);
  for (std::size_t key = 0; key < count; ++key)
    keys[key].assign(all.begin() + static_cast<std::ptrdiff_t>(key * size),
                     all.begin() + static_cast<std::ptrdiff_t>((key + 1) * size));
  return keys;
}

Mesh make_mesh(const ArrayLike& positions, const ArrayLike& triangles, const std::optional<ArrayLike>& corner_normals,
               const std::optional<ArrayLike>& uvs, const std::optional<ArrayLike>& material_slots,
               const std::optional<ArrayLike>& motion_positions, const std::optional<ArrayLike>& motion_corner_normals,
               const std::optional<ArrayLike>& adjacent_positions, const std::vector<NamedArray>& attributes,
               const std::optional<std::array<std::array<float, 3>, 2>>& texture_space) {
  Mesh mesh;
  mesh.positions = to_vector<Vec3f>(float_array(positions, "positions", {{any_length, 3}}));
  mesh.triangles = to_vector<std::array<std::uint32_t, 3>>(index_array(triangles, "triangles", {{any_length, 3}}));
  const auto count = static_cast<py::ssize_t>(mesh.triangles.size());
  if (corner_normals)
    mesh.corner_normals =
        to_vector<Vec3f>(float_array(*corner_normals, "corner_normals", {{count, 3, 3}, {3 * count, 3}}));
  if (uvs) mesh.uvs = to_vector<Vec2f>(float_array(*uvs, "uvs", {{count, 3, 2}, {3 * count, 2}}));
  if (material_slots)
    mesh.material_slots = to_vector<std::uint32_t>(index_array(*material_slots, "material_slots", {{count}}));
  const auto vertex_count = static_cast<py::ssize_t>(mesh.positions.size());
  if (motion_positions)
    mesh.motion_positions =
        to_keys(float_array(*motion_positions, "motion_positions", {{any_length, vertex_count, 3}}));
  if (motion_corner_normals)
    mesh.motion_corner_normals = to_keys(float_array(*motion_corner_normals, "motion_corner_normals",
                                                     {{any_length, count, 3, 3}, {any_length, 3 * count, 3}}));
  if (adjacent_positions)
    mesh.adjacent_positions = to_keys(float_array(*adjacent_positions, "adjacent_positions", {{2, vertex_count, 3}}));
  mesh.attributes = to_attributes(attributes, "Mesh.attributes");
  if (texture_space) {
    const auto& [least, size] = *texture_space;
    mesh.texture_space_min = {least[0], least[1], least[2]};
    mesh.texture_space_size = {size[0], size[1], size[2]};
  }
  validate(mesh, "Mesh");
  return mesh;
}

// A view of each, of the given shape.
py::typing::List<py::array_t<float>> key_views(const std::vector<std::vector<Vec3f>>& keys, const ArrayShape& shape,
                                               const py::object& owner) {
  py::typing::List<py::array_t<float>> views;
  for (const std::vector<Vec3f>& key : keys)
    views.append(read_only_view(reinterpret_cast<const float*>(key.data()), shape, owner));
  return views;
}

// A view of per-corner vectors, (T, 3, size) float32, or None where the mesh has none.
template <class Element>
std::optional<py::array_t<float>> corner_view(const std::vector<Element>& elements, const py::object& owner) {
  if (elements.empty()) return std::nullopt;
  constexpr py::ssize_t size = sizeof(Element) / sizeof(float);
  const auto corners = static_cast<py::ssize_t>(elements.size());
  return read_only_view(reinterpret_cast<const float*>(elements.data()), {corners / 3, 3, size}, owner);
}

void register_mesh(py::module_& m) {
  py::class_<Mesh>(m, "Mesh", R"(Triangles in object space, copied out of arrays and checked once. Read-only.

positions (V, 3) float32, metres; triangles (T, 3) uint32, counter-clockwise seen from the front; corner_normals
(T, 3, 3) or (3T, 3) float32, unit length, without them the mesh is flat; uvs (T, 3, 2) or (3T, 2) float32;
material_slots (T,) uint32, without them every triangle has slot 0. A mesh that deforms has motion_positions
(K, V, 3) float32 and, where it has corner_normals, motion_corner_normals (K, T, 3, 3) or (K, 3T, 3) float32: those at K
further times, equally spaced; the others are when the shutter opens, the last of these when it closes, and all is
linear between them. adjacent_positions (2, V, 3) float32 are for the pass Vector: one frame before and one frame
after. attributes are (name, domain, values): domain "vertex", "corner" or "face", values (N, 3) float32 for
each vertex, each corner of the triangles or each triangle. texture_space is where generated coordinates are 0, and how
far from there they are 1. Other real (or integer) types are converted.
Raises SceneError naming the array, the rule and the value.)")
      .def(py::init(&make_mesh), py::arg("positions"), py::arg("triangles"), py::kw_only(),
           py::arg("corner_normals") = py::none(), py::arg("uvs") = py::none(), py::arg("material_slots") = py::none(),
           py::arg("motion_positions") = py::none(), py::arg("motion_corner_normals") = py::none(),
           py::arg("adjacent_positions") = py::none(), py::arg("attributes") = std::vector<NamedArray>{},
           py::arg("texture_space") = py::none())
      .def_property_readonly(
          "positions",
          [](const py::object& self) {
            const auto& positions = self.cast<const Mesh&>().positions;
            return read_only_view(reinterpret_cast<const float*>(positions.data()),
                                  {static_cast<py::ssize_t>(positions.size()), 3}, self);
          },
          "(V, 3) float32, object space, metres")
      .def_property_readonly(
          "triangles",
          [](const py::object& self) {
            const auto& triangles = self.cast<const Mesh&>().triangles;
            return read_only_view(reinterpret_cast<const std::uint32_t*>(triangles.data()),
                                  {static_cast<py::ssize_t>(triangles.size()), 3}, self);
          },
          "(T, 3) uint32, rows of positions")
      .def_property_readonly(
          "corner_normals",
          [](const py::object& self) { return corner_view(self.cast<const Mesh&>().corner_normals, self); },
          "(T, 3, 3) float32, or None: flat")
      .def_property_readonly(
          "uvs", [](const py::object& self) { return corner_view(self.cast<const Mesh&>().uvs, self); },
          "(T, 3, 2) float32, or None")
      .def_property_readonly(
          "material_slots",
          [](const py::object& self) -> std::optional<py::array_t<std::uint32_t>> {
            const auto& slots = self.cast<const Mesh&>().material_slots;
            if (slots.empty()) return std::nullopt;
            return read_only_view(slots.data(), {static_cast<py::ssize_t>(slots.size())}, self);
          },
          "(T,) uint32, or None: all 0")
      .def_property_readonly(
          "motion_positions",
          [](const py::object& self) {
            const auto& mesh = self.cast<const Mesh&>();
            return key_views(mesh.motion_positions, {static_cast<py::ssize_t>(mesh.positions.size()), 3}, self);
          },
          "(V, 3) float32 for each further time; none where it doesn't deform")
      .def_property_readonly(
          "motion_corner_normals",
          [](const py::object& self) {
            const auto& mesh = self.cast<const Mesh&>();
            return key_views(mesh.motion_corner_normals, {static_cast<py::ssize_t>(mesh.triangles.size()), 3, 3}, self);
          },
          "(T, 3, 3) float32 for each further time; none where it doesn't deform or is flat")
      .def_property_readonly(
          "adjacent_positions",
          [](const py::object& self) {
            const auto& mesh = self.cast<const Mesh&>();
            return key_views(mesh.adjacent_positions, {static_cast<py::ssize_t>(mesh.positions.size()), 3}, self);
          },
          "(V, 3) float32 of the frame before and the frame after; none where it doesn't deform from frame to frame")
      .def_property_readonly(
          "texture_space",
          [](const Mesh& self) {
            const auto numbers = [](Vec3f v) { return std::array<float, 3>{v.x, v.y, v.z}; };
            return std::array{numbers(self.texture_space_min), numbers(self.texture_space_size)};
          },
          "where generated coordinates are 0, and how far from there they are 1")
      .def_property_readonly(
          "attributes",
          [](const py::object& self) { return attribute_views(self.cast<const Mesh&>().attributes, self); },
          "names, domains and values, (N, 3) float32")
      .def("__repr__", [](const Mesh& mesh) {
        return "<Mesh of " + std::to_string(mesh.positions.size()) + " positions, " +
               std::to_string(mesh.triangles.size()) + " triangles>";
      });
}

}  // namespace

void register_shapes(py::module_& m) {
  register_mesh(m);
  bind_described<Sphere>(m, "Sphere", "A sphere, exact. u is longitude, v latitude, poles on z.");
}

}  // namespace basicrt::bindings
