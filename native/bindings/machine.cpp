// SPDX-License-Identifier: GPL-3.0-or-later
// What a program may ask of the machine it runs on: instruction sets, processors, memory.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "base/parallel_for.h"
#include "bvh/kernels/chosen_kernel.h"
#include "register.h"
#include "scene/memory.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

std::vector<std::string> names_of_kernels() {
  const std::vector<std::string_view> names = kernel_names();
  return {names.begin(), names.end()};
}

void bind_memory(py::module_& m) {
  py::class_<SceneMemory>(m, "SceneMemory", R"(How many bytes a scene takes while it is rendered.

What is small is left out (materials, tables of lights), and what builders of trees need for a moment.)")
      .def_readonly("shapes", &SceneMemory::shapes, "twice: as they are described, and as they are rendered")
      .def_readonly("instances", &SceneMemory::instances, "the same, with what rays need to know of each")
      .def_readonly("images", &SceneMemory::images, "of textures and the environment, each once")
      .def_readonly("trees", &SceneMemory::trees, "that rays walk, with the triangles that they hold")
      .def_readonly("picture", &SceneMemory::picture, "a number for each channel of the passes and each pixel")
      .def_property_readonly("total", &SceneMemory::total, "all of them")
      .def("__repr__",
           [](const SceneMemory& self) { return "<SceneMemory of " + std::to_string(self.total()) + " bytes>"; });
}

}  // namespace

void register_machine(py::module_& m) {
  bind_memory(m);
  m.def("kernels", &names_of_kernels,
        "Names of the instruction sets that rays can be traced with on this machine, the best first.");
  m.def(
      "chosen_kernel", [] { return std::string(chosen_kernel().name); },
      "That which rays are traced with: what choose_kernel() was told, or the environment variable BASICRT_ISA says, "
      "or the best. Raises SceneError where there isn't what the variable names.");
  m.def(
      "choose_kernel", [](const std::string& name) { choose_kernel(name); }, py::arg("name") = "",
      "Traces rays with this one of kernels() from now on, in what is being rendered too; \"\" leaves the choice to "
      "BASICRT_ISA and the machine again. Pictures do not depend on it. Raises SceneError where there is none of "
      "that name.");
  m.def("processor_count", [] { return resolve_thread_count(0); }, "How many threads 0 stands for.");
}

}  // namespace basicrt::bindings
