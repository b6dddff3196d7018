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
  bind_described<EquirectangularCamera>(m, "EquirectangularCamera", "A panorama of longitude and latitude.");
  bind_described<FisheyeEquidistantCamera>(m, "FisheyeEquidistantCamera",
                                           "A fisheye: distances in the picture are angles from the axis.");
  bind_described<FisheyeEquisolidCamera>(m, "FisheyeEquisolidCamera",
                                         "A fisheye: areas of the picture are solid angles. A mirror ball is one.");
  bind_described<FisheyePolynomialCamera>(
      m, "FisheyePolynomialCamera",
      "A fisheye: the angle from the axis is k0 + k1 r + k2 r^2 + k3 r^3 + k4 r^4, r the distance in the picture.");
  bind_described<CubemapFaceCamera>(m, "CubemapFaceCamera", "A face of a cube with pixels evenly spaced in angle.");
  bind_described<CylindricalCamera>(m, "CylindricalCamera", "A panorama on a cylinder about the y axis.");
  m.def("look_at_camera", &look_at_camera, py::arg("position"), py::arg("look_at"), py::arg("up"), py::arg("fov"),
        py::arg("aspect"),
        "A perspective camera at `position`, world space, metres. fov is the full vertical angle, radians; aspect is\n"
        "width over height. Raises SceneError where these make no camera.");
}

}  // namespace basicrt::bindings
