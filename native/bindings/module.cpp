// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled module basicrt._native: lists what it is made of.
#include <pybind11/pybind11.h>

#include "register.h"

PYBIND11_MODULE(_native, m) {
  using namespace basicrt::bindings;
  m.doc() = "The native core of BasicRT. Use it through the package basicrt.";
  m.def("native_version", [] { return BASICRT_VERSION; }, "The version that this module was compiled as.");

  register_errors(m);
  register_shapes(m);
  register_round_shapes(m);
  register_textures(m);
  register_operations(m);
  register_materials(m);
  register_lights(m);
  register_cameras(m);
  register_settings(m);
  register_machine(m);
  register_scene(m);
  register_baking(m);
  register_session(m);
  register_view_session(m);
  register_io(m);
}
