// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras: they look along local -z with y up.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "camera/camera_base.h"
#include "camera/panorama.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

// The window is the part of the plane z = -1 that the picture shows.
struct PerspectiveCamera : CameraBase {
  static constexpr std::string_view kind = "perspective";
  static constexpr auto fields() {
    return camera_fields<PerspectiveCamera>("lower left corner on the plane z = -1",
                                            "upper right corner on the plane z = -1");
  }
};

// The window is in metres.
struct OrthographicCamera : CameraBase {
  static constexpr std::string_view kind = "orthographic";
  static constexpr auto fields() {
    return camera_fields<OrthographicCamera>("lower left corner, metres", "upper right corner, metres");
  }
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, EquirectangularCamera, FisheyeEquidistantCamera,
                            FisheyeEquisolidCamera, FisheyePolynomialCamera, CubemapFaceCamera, CylindricalCamera>;

// `fov` is the full vertical angle, radians; `aspect` is width over height.
[[nodiscard]] PerspectiveCamera make_look_at_camera(Vec3f position, Vec3f look_at, Vec3f up, float fov, float aspect);

// A camera made ready for a film of one size. Places on the film are in pixels, (0, 0) its lower left corner.
class CameraView {
 public:
  CameraView() = default;
  CameraView(const Camera& camera, Vec2i film_size);

  // Neither bends lines nor blurs: ray(pixel) will do.
  [[nodiscard]] bool is_pinhole() const { return !is_panorama_ && !has_aperture(); }
  [[nodiscard]] bool has_aperture() const { return has_aperture_; }

  // Of a pinhole.
  [[nodiscard]] Ray ray(Vec2f pixel) const {
    const Vec3f towards = direction_ + direction_dx_ * pixel.x + direction_dy_ * pixel.y;
    const float reach = length(towards), distance_per_depth = reach * (1 / dot(towards, axis_));
    return {.origin = origin_ + origin_dx_ * pixel.x + origin_dy_ * pixel.y,
            .t_min = clip_near_ * distance_per_depth,
            .direction = towards * (1 / reach),
            .t_max = clip_far_ * distance_per_depth,
            .kinds = ray_camera};
  }
  // Of any camera; `lens` in [0, 1)^2 chooses the place on its aperture, where it has one. Nothing: it sees nothing there.
  [[nodiscard]] std::optional<Ray> ray(Vec2f pixel, Vec2f lens) const;

  // How the ray there changes: the one through the middle of the aperture.
  [[nodiscard]] RayDifferentials differentials(Vec2f pixel) const;
  // Where on the film a point is seen, beyond its edges too, whatever stands before it; the aperture counts as a point.
  // Nothing where no place shows it: behind a flat camera.
  [[nodiscard]] std::optional<Vec2f> pixel_of(Vec3f position) const;
  // The same of what is infinitely far in a direction. Nothing where the camera is orthographic, too: it would be
  // everywhere or nowhere.
  [[nodiscard]] std::optional<Vec2f> pixel_of_direction(Vec3f direction) const;
  // After how many pixels across a panorama shows the same again; 0: it doesn't.
  [[nodiscard]] float period() const;
  // Depth along the viewing axis, as the Depth pass has it; of a panorama, the distance.
  [[nodiscard]] float depth(Vec3f position) const {
    return is_panorama_ ? length(position - position_) : dot(position - position_, axis_);
  }
  // Where x is to the right, y up and z where the camera looks.
  [[nodiscard]] TransformD world_to_camera() const {
    const auto row = [&](Vec3f axis) {
      return std::array<double, 4>{axis.x, axis.y, axis.z, -dot(Vec3d(axis), Vec3d(position_))};
    };
    return TransformD({row(right_), row(up_), row(axis_)});
  }
  // From the camera, or from its plane where it is orthographic.
  [[nodiscard]] float distance(Vec3f position) const {
    return std::holds_alternative<OrthographicCamera>(camera_) ? std::abs(dot(position - position_, axis_))
                                                               : length(position - position_);
  }
  // A direction as the camera has it: x to the right, y up, z forward.
  [[nodiscard]] Vec3f to_camera(Vec3f direction) const {
    return {dot(direction, right_), dot(direction, up_), dot(direction, axis_)};
  }

 private:
  // `local` is in the camera's space.
  [[nodiscard]] std::optional<Vec2f> pixel_of_local(Vec3d local) const;
  void set_window(const PerspectiveCamera& camera, Vec2f step);
  void set_window(const OrthographicCamera& camera, Vec2f step);
  template <Panorama Kind>
  void set_window(const Kind& camera, Vec2f step);

  template <Panorama Kind>
  [[nodiscard]] std::optional<Ray> panorama_ray(const Kind& camera, Vec2f pixel, Vec2f lens) const;
  [[nodiscard]] Ray flat_ray(const CameraBase& camera, Vec2f pixel, Vec2f lens) const;
  [[nodiscard]] Vec2f window_place(const CameraBase& camera, Vec2f pixel) const {
    return {camera.window_min.x + step_.x * pixel.x, camera.window_min.y + step_.y * pixel.y};
  }

  Camera camera_;
  Vec2f step_;  // how far it is in the window from pixel to pixel
  bool is_panorama_ = false, has_aperture_ = false;
  // Where lines stay straight: of the ray through (0, 0), and how they change from pixel to pixel. Directions are not
  // yet of unit length.
  Vec3f origin_, origin_dx_, origin_dy_;
  Vec3f direction_, direction_dx_, direction_dy_;
  Vec3f position_, axis_, right_, up_;  // the camera's, of unit length
  float clip_near_ = 0, clip_far_ = infinity;
};

// A camera while the shutter is open.
class MovingCamera {
 public:
  MovingCamera() = default;
  MovingCamera(Camera camera, Vec2i film_size);

  [[nodiscard]] bool is_moving() const { return !keys_.empty(); }
  // Needs a camera that moves.
  [[nodiscard]] CameraView at(float time) const;

 private:
  Camera camera_;
  Vec2i film_size_;
  std::vector<TransformD> keys_;
};

}  // namespace basicrt
