// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: the assignment's, which looks at a point, and ours with a transform.
#include <array>

#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

PerspectiveCamera read_look_at_camera(const JsonValue& camera, const RenderSettings& settings) {
  camera.check_keys(std::array<std::string_view, 5>{"position", "look_at", "ref_up", "fov", "focal_length"});
  const auto position = read_required<Vec3f>(camera, "position");
  const auto look_at = read_required<Vec3f>(camera, "look_at");
  Vec3f up{0, 1, 0};
  read_optional(camera, "ref_up", up);
  const JsonValue fov_json = camera.require("fov");
  float fov = 0;  // vertical, degrees
  read(fov_json, fov);
  if (!(fov > 0 && fov < 180)) fov_json.fail("must be between 0 and 180 degrees, is " + number_text(fov));
  // Picture and plane grow together with it: it changes nothing.
  float focal_length = 1;
  read_optional(camera, "focal_length", focal_length);

  const Vec3d forward = Vec3d(look_at) - Vec3d(position);
  if (length_squared(forward) == 0) camera.require("look_at").fail("must differ from position");
  const Vec3d right = cross(forward, Vec3d(up));
  if (length_squared(right) <= 1e-12 * length_squared(forward) * length_squared(Vec3d(up)))
    camera.fail("ref_up must not be parallel to the direction of view");
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  return make_look_at_camera(position, look_at, up, fov * (pi / 180), aspect);
}

Camera read_camera_value(const JsonValue& camera, const RenderSettings& settings) {
  if (camera.find("type")) return read_plain_variant<Camera>(camera);
  return read_look_at_camera(camera, settings);
}

}  // namespace

void read_camera(SceneReader& reader, const JsonValue& camera) {
  reader.scene.camera = read_camera_value(camera, reader.scene.settings);
}

void read_adjacent_cameras(SceneReader& reader, const JsonValue& cameras) {
  cameras.expect_array();
  for (std::size_t i = 0; i < cameras.size(); ++i)
    reader.scene.adjacent_cameras.push_back(read_camera_value(cameras.item(i), reader.scene.settings));
}

}  // namespace basicrt
