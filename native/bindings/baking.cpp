// SPDX-License-Identifier: GPL-3.0-or-later
// What is baked, and what of it.
#include "integrator/baking.h"

#include <optional>

#include "arrays.h"
#include "described.h"
#include "pass_list.h"
#include "register.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

BakeTarget make_target(std::uint32_t instance, const ArrayLike& triangles, const ArrayLike& barycentrics,
                       const std::optional<ArrayLike>& changes, const std::optional<ArrayLike>& seeds) {
  const auto of_pixels = index_array(triangles, "BakeTarget.triangles", {{any_length, any_length}});
  BakeTarget target{.instance = instance,
                    .width = static_cast<int>(of_pixels.shape(1)),
                    .height = static_cast<int>(of_pixels.shape(0)),
                    .points = {}};
  const py::ssize_t height = of_pixels.shape(0), width = of_pixels.shape(1);
  const auto shares = float_array(barycentrics, "BakeTarget.barycentrics", {{height, width, 2}});
  std::optional<py::array_t<float>> change;
  if (changes) change = float_array(*changes, "BakeTarget.changes", {{height, width, 2, 2}});
  std::optional<py::array_t<std::uint32_t>> seed;
  if (seeds) seed = index_array(*seeds, "BakeTarget.seeds", {{height, width}});
  target.points.resize(static_cast<std::size_t>(of_pixels.size()));
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    BakePoint& point = target.points[i];
    point.triangle = of_pixels.data()[i];
    point.seed = seed ? seed->data()[i] : static_cast<std::uint32_t>(i);
    point.barycentrics = {shares.data()[2 * i], shares.data()[2 * i + 1]};
    if (!change) continue;
    const float* numbers = change->data() + 4 * i;
    point.change_x = {numbers[0], numbers[1]};
    point.change_y = {numbers[2], numbers[3]};
  }
  return target;
}

}  // namespace

void register_baking(py::module_& m) {
  py::class_<BakeTarget>(m, "BakeTarget", R"(A picture of places on a mesh, to be laid onto it.

instance: index into Scene.instances, of a mesh. For each pixel, row 0 at the bottom: triangles (height, width), indices
into the mesh's, or NOWHERE; barycentrics (height, width, 2), the shares of the triangle's second and third corner;
changes (height, width, 2, 2), by how much these change across the pixel, to the right and upwards: its samples are
spread over that, as far as it is in the triangle; seeds (height, width): pixels with the same one have the same noise.)")
      .def(py::init(&make_target), py::arg("instance"), py::arg("triangles"), py::arg("barycentrics"), py::kw_only(),
           py::arg("changes") = py::none(), py::arg("seeds") = py::none())
      .def_readonly_static("NOWHERE", &BakePoint::nowhere)
      .def_readonly("instance", &BakeTarget::instance)
      .def_readonly("width", &BakeTarget::width)
      .def_readonly("height", &BakeTarget::height)
      .def("__repr__", [](const BakeTarget& target) {
        return "<BakeTarget of " + std::to_string(target.width) + " x " + std::to_string(target.height) +
               " pixels on instance " + std::to_string(target.instance) + ">";
      });

  std::vector<Attribute<BakeSettings>> attributes = attributes_of<BakeSettings>();
  attributes.push_back(passes_attribute(&BakeSettings::passes));
  bind_fields<BakeSettings>(m, "BakeSettings", "What is asked of the places of a BakeTarget.", attributes);
}

}  // namespace basicrt::bindings
