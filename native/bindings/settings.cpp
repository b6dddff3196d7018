// SPDX-License-Identifier: GPL-3.0-or-later
// RenderSettings, with the filter's settings and the passes among its own; the table of passes.
#include "scene/settings.h"
#include "base/error.h"
#include "described.h"
#include "pass_list.h"
#include "register.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

using Settings = RenderSettings;

// The filter's fields, as attributes of the settings that hold it.
void add_filter(std::vector<Attribute<Settings>>& attributes) {
  for (const Attribute<FilterSettings>& part : attributes_of<FilterSettings>())
    attributes.push_back(
        {"filter_" + part.name, part.doc, part.accepts, part.returns,
         [part](const Settings& self) { return part.get(self.filter); },
         [part](Settings& self, py::handle value, const std::string& item) { part.set(self.filter, value, item); }});
}

}  // namespace

void register_settings(py::module_& m) {
  py::class_<PassInfo>(m, "PassInfo", "A kind of picture that a render can make.")
      .def_property_readonly(
          "name", [](const PassInfo& info) { return std::string(info.name); }, "Blender's name, and the EXR layer's")
      .def_property_readonly(
          "channels", [](const PassInfo& info) { return std::string(info.channels); }, "one letter for each")
      .def_readonly("background", &PassInfo::background, "where no ray hits anything")
      .def("__repr__", [](const PassInfo& info) {
        return "<PassInfo " + std::string(info.name) + " " + std::string(info.channels) + ">";
      });
  m.def("passes", [] { return std::vector<PassInfo>(passes.begin(), passes.end()); }, "Every pass there is.");

  std::vector<Attribute<Settings>> attributes = attributes_of<Settings>();
  add_filter(attributes);
  attributes.push_back(passes_attribute(&Settings::passes));
  bind_fields<Settings>(m, "RenderSettings", "How a picture is made.", attributes);
}

}  // namespace basicrt::bindings
