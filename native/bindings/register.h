// SPDX-License-Identifier: GPL-3.0-or-later
// What each file of the bindings adds to the module; a class must be registered before it appears in a signature.
#pragma once

#include <pybind11/pybind11.h>

namespace basicrt::bindings {

void register_errors(pybind11::module_& m);
void register_shapes(pybind11::module_& m);
void register_round_shapes(pybind11::module_& m);
void register_textures(pybind11::module_& m);
void register_operations(pybind11::module_& m);
void register_materials(pybind11::module_& m);
void register_lights(pybind11::module_& m);
void register_cameras(pybind11::module_& m);
void register_settings(pybind11::module_& m);
void register_machine(pybind11::module_& m);
void register_scene(pybind11::module_& m);
void register_baking(pybind11::module_& m);
void register_session(pybind11::module_& m);
void register_view_session(pybind11::module_& m);
void register_io(pybind11::module_& m);

}  // namespace basicrt::bindings
