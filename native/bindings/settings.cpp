// SPDX-License-Identifier: GPL-3.0-or-later
// RenderSettings, with the filter's settings and the passes among its own; the table of passes.
#include "scene/settings.h"
#include "base/error.h"
#include "described.h"
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

std::vector<std::string> pass_names(PassLayout layout) {
  std::vector<std::string> names;
  for (const PassInfo& info : passes)
    if (layout.has(info.pass)) names.emplace_back(info.name);
  return names;
}

PassLayout read_passes(py::handle value, const std::string& item) {
  if (py::isinstance<py::str>(value)) refuse_type(item, "must be a list of names", value);
  std::vector<std::string_view> known;
  for (const PassInfo& info : passes) known.push_back(info.name);
  PassLayout layout = PassLayout::none();
  for (const std::string& name : PythonValue<std::vector<std::string>>::read(value, item))
    layout.enable(passes[read_enum(py::str(name), item, known)].pass);
  return layout;
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
  attributes.push_back(
      {"passes", "names of the passes to make, as in passes()", "collections.abc.Iterable[str]", "list[str]",
       [](const Settings& self) { return py::cast(pass_names(self.passes)); },
       [](Settings& self, py::handle value, const std::string& item) { self.passes = read_passes(value, item); }});
  bind_fields<Settings>(m, "RenderSettings", "How a picture is made.", attributes);
}

}  // namespace basicrt::bindings
