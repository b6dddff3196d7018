// SPDX-License-Identifier: GPL-3.0-or-later
// PointCloud and Curves.
#include "array_vectors.h"
#include "described.h"
#include "geometry/shape.h"
#include "register.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

std::vector<float> to_floats(const std::optional<ArrayLike>& values, const std::string& item, py::ssize_t count) {
  if (!values) return {};
  return to_vector<float>(float_array(*values, item, {{count}}));
}

// One number is that of all.
std::vector<float> to_radii(const ArrayLike& radii, py::ssize_t count) {
  if (!py::isinstance<py::float_>(radii) && !py::isinstance<py::int_>(radii)) return to_floats(radii, "radii", count);
  return std::vector<float>(static_cast<std::size_t>(count), radii.cast<float>());
}

PointCloud make_point_cloud(const ArrayLike& positions, const ArrayLike& radii, const std::optional<ArrayLike>& randoms,
                            const std::vector<NamedArray>& attributes) {
  PointCloud cloud;
  cloud.positions = to_vector<Vec3f>(float_array(positions, "positions", {{any_length, 3}}));
  const auto count = static_cast<py::ssize_t>(cloud.positions.size());
  cloud.radii = to_radii(radii, count);
  cloud.randoms = to_floats(randoms, "randoms", count);
  cloud.attributes = to_attributes(attributes, "PointCloud.attributes");
  validate(cloud, "PointCloud");
  return cloud;
}

Curves make_curves(const ArrayLike& points, const ArrayLike& radii, const ArrayLike& firsts, const std::string& form,
                   const std::optional<ArrayLike>& intercepts, const std::optional<ArrayLike>& randoms,
                   const std::optional<ArrayLike>& uvs, const std::vector<NamedArray>& attributes) {
  Curves curves;
  curves.points = to_vector<Vec3f>(float_array(points, "points", {{any_length, 3}}));
  const auto count = static_cast<py::ssize_t>(curves.points.size());
  curves.radii = to_radii(radii, count);
  curves.firsts = to_vector<std::uint32_t>(index_array(firsts, "firsts", {{any_length}}));
  const auto curve_count = static_cast<py::ssize_t>(curves.firsts.size());
  curves.form = PythonValue<CurveForm>::read(py::str(form), "Curves.form");
  curves.intercepts = to_floats(intercepts, "intercepts", count);
  curves.randoms = to_floats(randoms, "randoms", curve_count);
  if (uvs) curves.uvs = to_vector<Vec2f>(float_array(*uvs, "uvs", {{curve_count, 2}}));
  curves.attributes = to_attributes(attributes, "Curves.attributes");
  validate(curves, "Curves");
  return curves;
}

// A view of (N,) or (N, size) float32.
template <class Element>
py::array_t<float> float_view(const std::vector<Element>& elements, const py::object& owner) {
  constexpr py::ssize_t size = sizeof(Element) / sizeof(float);
  const auto count = static_cast<py::ssize_t>(elements.size());
  return read_only_view(reinterpret_cast<const float*>(elements.data()),
                        size == 1 ? ArrayShape{count} : ArrayShape{count, size}, owner);
}

// The same, or None where there are none.
template <class Element>
std::optional<py::array_t<float>> optional_view(const std::vector<Element>& elements, const py::object& owner) {
  if (elements.empty()) return std::nullopt;
  return float_view(elements, owner);
}

void register_point_cloud(py::module_& m) {
  py::class_<PointCloud>(m, "PointCloud",
                         R"(Many exact spheres in object space, copied out of arrays and checked once. Read-only.

positions (N, 3) float32, metres; radii (N,) float32, or one number for all: points of radius 0 can't be hit; randoms (N,)
float32, what Point Info calls Random; attributes are (name, "vertex", values), values (N, 3) float32. They have the texture
coordinates of Sphere. Where they shine, rays run into them: they are not sampled as lights. Raises SceneError naming the
array, the rule and the value.)")
      .def(py::init(&make_point_cloud), py::arg("positions"), py::arg("radii"), py::kw_only(),
           py::arg("randoms") = py::none(), py::arg("attributes") = std::vector<NamedArray>{})
      .def_property_readonly(
          "positions",
          [](const py::object& self) { return float_view(self.cast<const PointCloud&>().positions, self); },
          "(N, 3) float32, object space, metres")
      .def_property_readonly(
          "radii", [](const py::object& self) { return float_view(self.cast<const PointCloud&>().radii, self); },
          "(N,) float32, metres")
      .def_property_readonly(
          "randoms", [](const py::object& self) { return optional_view(self.cast<const PointCloud&>().randoms, self); },
          "(N,) float32, or None: all 0")
      .def_property_readonly(
          "attributes",
          [](const py::object& self) { return attribute_views(self.cast<const PointCloud&>().attributes, self); },
          "names, domains and values, (N, 3) float32")
      .def("__repr__", [](const PointCloud& cloud) {
        return "<PointCloud of " + std::to_string(cloud.positions.size()) + " points>";
      });
}

void register_curves(py::module_& m) {
  py::class_<Curves>(m, "Curves", R"(Hair in object space, copied out of arrays and checked once. Read-only.

points (N, 3) float32, metres, of one curve after the other; radii (N,) float32, or one number for all; firsts (C,) uint32,
the number of each curve's first point. Curves are Catmull-Rom splines through their points, and so are their radii. form:
"round", or "ribbon", which is flat and faces the ray. intercepts (N,) float32, how far along its curve a point is; randoms
(C,) float32 of each curve, what Curves Info calls Random; uvs (C, 2) float32, where each is rooted; attributes are (name,
domain, values): "vertex" has values for each point, "face" for each curve, (·, 3) float32. Curves are seen from outside
only, and have no volume. Where they shine, rays run into them: they are not sampled as lights. Raises SceneError naming
the array, the rule and the value.)")
      .def(py::init(&make_curves), py::arg("points"), py::arg("radii"), py::arg("firsts"), py::kw_only(),
           py::arg("form") = "round", py::arg("intercepts") = py::none(), py::arg("randoms") = py::none(),
           py::arg("uvs") = py::none(), py::arg("attributes") = std::vector<NamedArray>{})
      .def_property_readonly(
          "points", [](const py::object& self) { return float_view(self.cast<const Curves&>().points, self); },
          "(N, 3) float32, object space, metres")
      .def_property_readonly(
          "radii", [](const py::object& self) { return float_view(self.cast<const Curves&>().radii, self); },
          "(N,) float32, metres")
      .def_property_readonly(
          "firsts",
          [](const py::object& self) {
            const auto& firsts = self.cast<const Curves&>().firsts;
            return read_only_view(firsts.data(), {static_cast<py::ssize_t>(firsts.size())}, self);
          },
          "(C,) uint32, each curve's first point")
      .def_property_readonly(
          "form",
          [](const Curves& self) { return std::string(enum_names<CurveForm>[static_cast<std::size_t>(self.form)]); },
          "round or ribbon")
      .def_property_readonly(
          "intercepts",
          [](const py::object& self) { return optional_view(self.cast<const Curves&>().intercepts, self); },
          "(N,) float32, or None: by the points' numbers")
      .def_property_readonly(
          "randoms", [](const py::object& self) { return optional_view(self.cast<const Curves&>().randoms, self); },
          "(C,) float32, or None: all 0")
      .def_property_readonly(
          "uvs", [](const py::object& self) { return optional_view(self.cast<const Curves&>().uvs, self); },
          "(C, 2) float32, or None: the intercept and 0")
      .def_property_readonly(
          "attributes",
          [](const py::object& self) { return attribute_views(self.cast<const Curves&>().attributes, self); },
          "names, domains and values, (·, 3) float32")
      .def("__repr__", [](const Curves& curves) {
        return "<Curves: " + std::to_string(curves.firsts.size()) + " of " + std::to_string(curves.points.size()) +
               " points>";
      });
}

}  // namespace

void register_round_shapes(py::module_& m) {
  register_point_cloud(m);
  register_curves(m);
}

}  // namespace basicrt::bindings
