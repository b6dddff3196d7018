// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras.
#include "base/error.h"
#include "camera/camera.h"
#include "described.h"
#include "register.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

PerspectiveCamera look_at_camera(const Argument<Vec3f>& position, const Argument<Vec3f>& look_at,
                                 const Argument<Vec3f>& up, float fov, float aspect) {
  const std::string function = "look_at_camera";
  if (!(fov > 0 && fov < pi)) throw SceneError(function + ".fov", "must be in (0, pi), is " + std::to_string(fov));
  if (!(aspect > 0 && std::isfinite(aspect)))
    throw SceneError(function + ".aspect", "must be above 0 and finite, is " + std::to_string(aspect));
  const PerspectiveCamera camera =
      make_look_at_camera(position.read(function + ".position"), look_at.read(function + ".look_at"),
                          up.read(function + ".up"), fov, aspect);
  for (const auto& row : camera.to_world.rows)
    for (const float number : row)
      if (!std::isfinite(number))
        throw SceneError(function, "position and look_at must be finite and differ, up must not be along the view");
  return camera;
}

}  // namespace

void register_cameras(py::module_& m) {
  bind_described<PerspectiveCamera>(m, "PerspectiveCamera", "Sees along local -z through a window at z = -1.");
  bind_described<OrthographicCamera>(m, "OrthographicCamera", "Sees along local -z, all rays parallel.");
  m.def("look_at_camera", &look_at_camera, py::arg("position"), py::arg("look_at"), py::arg("up"), py::arg("fov"),
        py::arg("aspect"),
        "A perspective camera at `position`, world space, metres. fov is the full vertical angle, radians; aspect is\n"
        "width over height. Raises SceneError where these make no camera.");
}

}  // namespace basicrt::bindings
