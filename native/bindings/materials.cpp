// SPDX-License-Identifier: GPL-3.0-or-later
// Shader nodes and the materials made of them.
#include "described.h"
#include "register.h"
#include "shading/material.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

auto root_getter(NodeIndex Material::* root) {
  return [root](const Material& self) -> std::optional<NodeIndex> {
    return self.*root == no_node ? std::nullopt : std::optional(self.*root);
  };
}
auto root_setter(NodeIndex Material::* root) {
  return [root](Material& self, std::optional<NodeIndex> node) { self.*root = node.value_or(no_node); };
}

}  // namespace

void register_materials(py::module_& m) {
  bind_described<DiffuseShader>(m, "DiffuseShader", "Diffuse reflection, Lambert's or by a rough surface.");
  bind_described<GlossyShader>(m, "GlossyShader", "GGX reflection tinted by a colour; a mirror at roughness 0.");
  bind_described<ConductorShader>(m, "ConductorShader", "A metal with measured refractive indices.");
  bind_described<MetallicShader>(m, "MetallicShader", "A metal by two colours or by measured refractive indices.");
  bind_described<TranslucentShader>(m, "TranslucentShader", "Diffuse transmission.");
  bind_described<SheenShader>(m, "SheenShader", "Light that fibres scatter at grazing angles.");
  bind_described<ToonShader>(m, "ToonShader", "A spot of even brightness.");
  bind_described<SubsurfaceShader>(m, "SubsurfaceShader",
                                   "Light that goes about beneath the surface and leaves elsewhere.");
  bind_described<PrincipledHairShader>(m, "PrincipledHairShader", "Hair by its pigments, colour or absorption.");
  bind_described<HairShader>(m, "HairShader", "Hair by its highlight, or by the light that shines through.");
  bind_described<RefractionShader>(m, "RefractionShader", "Refraction without Fresnel reflection.");
  bind_described<GlassShader>(m, "GlassShader", "Fresnel reflection and refraction.");
  bind_described<TransparentShader>(m, "TransparentShader", "Light passes straight through, tinted.");
  bind_described<EmissionShader>(m, "EmissionShader", "A surface that shines.");
  bind_described<HoldoutShader>(m, "HoldoutShader", "A hole in the picture for what the camera sees.");
  bind_described<PrincipledShader>(m, "PrincipledShader", "Blender's Principled BSDF but for thin walls.");
  bind_described<VolumeShader>(m, "VolumeShader", "What fills a shape, by its coefficients.");
  bind_described<DisplacementShader>(m, "DisplacementShader", "By how much the surface is moved, vertex by vertex.");
  bind_described<AovShader>(m, "AovShader", "What the surface writes into the passes AOV Color and AOV Value.");
  bind_described<MixShader>(m, "MixShader", "A blend of two nodes; None is black and opaque.");
  bind_described<AddShader>(m, "AddShader", "The sum of two nodes; None is black and opaque.");

  py::class_<Material>(m, "Material", "A small graph of shader nodes. A node refers only to nodes added before it.")
      .def(py::init([](std::string name) { return Material{.name = std::move(name), .nodes = {}}; }),
           py::arg("name") = "")
      .def_readwrite("name", &Material::name)
      .def_readwrite("pass_index", &Material::pass_index, "for the pass Material Index and operations that ask")
      .def("add", py::overload_cast<ShaderNode>(&Material::add), py::arg("node"),
           "Appends a node and returns its index.")
      .def("add_operation", py::overload_cast<Operation>(&Material::add), py::arg("operation"),
           "Appends an operation, which refers only to those before it, and returns what stands for its value.")
      .def_property("surface", root_getter(&Material::surface), root_setter(&Material::surface),
                    "The index of the node that the surface shows; None is black and opaque, or, with a volume, "
                    "nothing but the volume's boundary.")
      .def_property("volume", root_getter(&Material::volume), root_setter(&Material::volume),
                    "The index of the node that fills the shape: a VolumeShader, an EmissionShader, or such mixed and "
                    "added. None is empty space.")
      .def_property_readonly(
          "nodes", [](const Material& self) { return self.nodes; }, "Copies of the nodes.")
      .def_property_readonly(
          "operations", [](const Material& self) { return self.operations; }, "Copies of the operations.")
      .def("__repr__", [](const Material& self) {
        return "<Material \"" + self.name + "\" of " + std::to_string(self.nodes.size()) + " nodes>";
      });
}

}  // namespace basicrt::bindings
