// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps and the environment.
#include "described.h"
#include "light/light_set.h"
#include "register.h"

namespace basicrt::bindings {

namespace {

namespace py = pybind11;

constexpr const char* sky_type =
    "basicrt._native.PreethamSky | basicrt._native.SingleScatteringSky | basicrt._native.MultipleScatteringSky | None";

py::object write_sky(const std::optional<Sky>& sky) {
  if (!sky) return py::none();
  return std::visit([](const auto& kind) { return py::cast(kind); }, *sky);
}

std::optional<Sky> read_sky(py::handle value, const std::string& item) {
  if (value.is_none()) return std::nullopt;
  if (py::isinstance<PreethamSky>(value)) return value.cast<const PreethamSky&>();
  if (py::isinstance<SingleScatteringSky>(value)) return value.cast<const SingleScatteringSky&>();
  if (py::isinstance<MultipleScatteringSky>(value)) return value.cast<const MultipleScatteringSky&>();
  refuse_type(item, "must be a sky or None", value);
}

void register_environment(py::module_& m) {
  std::vector<Attribute<EnvironmentLayer>> layer = attributes_of<EnvironmentLayer>();
  layer.insert(layer.begin() + 1, {"image", "an Image; None is the same from everywhere",
                                   "basicrt._native.Image | None", "basicrt._native.Image | None",
                                   [](const EnvironmentLayer& self) {
                                     return self.image.is_empty() ? py::object(py::none()) : py::cast(self.image);
                                   },
                                   [](EnvironmentLayer& self, py::handle value, const std::string& item) {
                                     if (!value.is_none() && !py::isinstance<Image>(value))
                                       refuse_type(item, "must be an Image or None", value);
                                     self.image = value.is_none() ? Image{} : value.cast<const Image&>();
                                   }});
  layer.insert(
      layer.begin() + 2,
      {"sky", "a PreethamSky, SingleScatteringSky or MultipleScatteringSky instead of an image", sky_type, sky_type,
       [](const EnvironmentLayer& self) { return write_sky(self.sky); },
       [](EnvironmentLayer& self, py::handle value, const std::string& item) { self.sky = read_sky(value, item); }});
  bind_fields<EnvironmentLayer>(m, "EnvironmentLayer", "A picture around the scene, or the same from everywhere.",
                                layer);

  std::vector<Attribute<Environment>> attributes = attributes_of<Environment>();
  attributes.push_back(
      {"layers", "EnvironmentLayers, added up; reading gives a copy, assign to change them",
       "collections.abc.Iterable[basicrt._native.EnvironmentLayer]", "list[basicrt._native.EnvironmentLayer]",
       [](const Environment& self) { return py::cast(self.layers); },
       [](Environment& self, py::handle value, const std::string& item) {
         if (!py::isinstance<py::iterable>(value)) refuse_type(item, "must be a list", value);
         std::vector<EnvironmentLayer> layers;
         for (const py::handle entry : py::reinterpret_borrow<py::iterable>(value)) {
           if (!py::isinstance<EnvironmentLayer>(entry))
             refuse_type(item + "[" + std::to_string(layers.size()) + "]", "must be an EnvironmentLayer", entry);
           layers.push_back(entry.cast<const EnvironmentLayer&>());
         }
         self.layers = std::move(layers);
       }});
  bind_fields<Environment>(m, "Environment", "What a ray sees that hits nothing.", attributes);
}

}  // namespace

void register_lights(pybind11::module_& m) {
  bind_described<PointLight>(m, "PointLight", "A point, or a sphere that shines alike everywhere.");
  bind_described<SpotLight>(m, "SpotLight", "A point or sphere that shines in a cone.");
  bind_described<SunLight>(m, "SunLight", "Light from infinitely far.");
  bind_described<AreaLight>(m, "AreaLight", "A rectangle or ellipse that shines to one side.");
  bind_described<PreethamSky>(m, "PreethamSky", "A fit to daylight; it has no sun disc.");
  bind_described<SingleScatteringSky>(m, "SingleScatteringSky", "Light that is scattered once on its way.");
  bind_described<MultipleScatteringSky>(m, "MultipleScatteringSky",
                                        "Light that is scattered any number of times, and reflected by the ground.");
  register_environment(m);
}

}  // namespace basicrt::bindings
