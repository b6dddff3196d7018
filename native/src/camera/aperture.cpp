// SPDX-License-Identifier: GPL-3.0-or-later
// Places on an aperture, all alike.
#include <cmath>

#include "camera/camera_base.h"
#include "math/warp.h"

namespace basicrt {
namespace {

constexpr int least_corners = 3;

}  // namespace

Vec2f sample_aperture(const CameraBase& camera, Vec2f u) {
  Vec2f place;
  if (camera.aperture_blades < least_corners) {
    place = sample_disk(u);
  } else {
    const Vec2f p = sample_regular_polygon(u, camera.aperture_blades);
    const float c = std::cos(camera.aperture_rotation), s = std::sin(camera.aperture_rotation);
    place = {c * p.x - s * p.y, s * p.x + c * p.y};
  }
  place.x /= camera.aperture_ratio;
  return place * camera.aperture_radius;
}

float pdf_aperture(const CameraBase& camera) {
  const float pdf = camera.aperture_blades < least_corners ? pdf_disk : pdf_regular_polygon(camera.aperture_blades);
  return pdf * camera.aperture_ratio / (camera.aperture_radius * camera.aperture_radius);
}

}  // namespace basicrt
