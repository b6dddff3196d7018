// SPDX-License-Identifier: GPL-3.0-or-later
// Shader nodes and the materials made of them.
#include "described.h"
#include "register.h"
#include "shading/material.h"

namespace basicrt::bindings {
namespace py = pybind11;

void register_materials(py::module_& m) {
  bind_described<DiffuseShader>(m, "DiffuseShader", "Lambert's reflection.");
  bind_described<GlossyShader>(m, "GlossyShader", "GGX reflection tinted by a colour; a mirror at roughness 0.");
  bind_described<ConductorShader>(m, "ConductorShader", "A metal with measured refractive indices.");
  bind_described<RefractionShader>(m, "RefractionShader", "Refraction without Fresnel reflection.");
  bind_described<GlassShader>(m, "GlassShader", "Fresnel reflection and refraction.");
  bind_described<TransparentShader>(m, "TransparentShader", "Light passes straight through, tinted.");
  bind_described<EmissionShader>(m, "EmissionShader", "A surface that shines.");
  bind_described<HoldoutShader>(m, "HoldoutShader", "A hole in the picture for what the camera sees.");
  bind_described<PrincipledShader>(m, "PrincipledShader", "Blender's Principled BSDF with constant values.");
  bind_described<MixShader>(m, "MixShader", "A blend of two nodes; None is black and opaque.");
  bind_described<AddShader>(m, "AddShader", "The sum of two nodes; None is black and opaque.");

  py::class_<Material>(m, "Material", "A small graph of shader nodes. A node refers only to nodes added before it.")
      .def(py::init([](std::string name) { return Material{.name = std::move(name), .nodes = {}}; }),
           py::arg("name") = "")
      .def_readwrite("name", &Material::name)
      .def("add", &Material::add, py::arg("node"), "Appends a node and returns its index.")
      .def_property(
          "surface",
          [](const Material& self) -> std::optional<NodeIndex> {
            return self.surface == no_node ? std::nullopt : std::optional(self.surface);
          },
          [](Material& self, std::optional<NodeIndex> node) { self.surface = node.value_or(no_node); },
          "The index of the node that the surface shows; None is black and opaque.")
      .def_property_readonly(
          "nodes", [](const Material& self) { return self.nodes; }, "Copies of the nodes.")
      .def("__repr__", [](const Material& self) {
        return "<Material \"" + self.name + "\" of " + std::to_string(self.nodes.size()) + " nodes>";
      });
}

}  // namespace basicrt::bindings
