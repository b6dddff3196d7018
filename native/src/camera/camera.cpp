// SPDX-License-Identifier: GPL-3.0-or-later
// From a place on the film to a ray in the world.
#include "camera/camera.h"

#include <cmath>

#include "geometry/motion.h"
#include "math/frame.h"

namespace basicrt {
namespace {

// The derivative of v / |v|, given that of v.
Vec3f unit_change(Vec3f v, Vec3f change) {
  const float scale = 1 / length(v);
  return (change - v * (dot(v, change) * scale * scale)) * scale;
}

const CameraBase& base_of(const Camera& camera) {
  return std::visit([](const CameraBase& base) -> const CameraBase& { return base; }, camera);
}

}  // namespace

PerspectiveCamera make_look_at_camera(Vec3f position, Vec3f look_at, Vec3f up, float fov, float aspect) {
  const Vec3f forward = normalize(look_at - position);
  const Vec3f right = normalize(cross(forward, up));
  const Vec3f camera_up = cross(right, forward);
  const float half_height = std::tan(fov / 2), half_width = half_height * aspect;

  PerspectiveCamera camera;
  for (int i = 0; i < 3; ++i) camera.to_world.rows[i] = {right[i], camera_up[i], -forward[i], position[i]};
  camera.window_min = {-half_width, -half_height};
  camera.window_max = {half_width, half_height};
  return camera;
}

CameraView::CameraView(const Camera& camera, Vec2i film_size) : camera_(camera) {
  const auto set = [&](const auto& kind) {
    const Vec2f window = kind.window_max - kind.window_min;
    step_ = {window.x / static_cast<float>(film_size.x), window.y / static_cast<float>(film_size.y)};
    set_window(kind, step_);
    position_ = kind.to_world.column(3);
    axis_ = normalize(-kind.to_world.column(2));
    right_ = normalize(kind.to_world.column(0));
    up_ = normalize(kind.to_world.column(1));
    clip_near_ = kind.clip_near;
    clip_far_ = kind.clip_far;
    has_aperture_ = kind.aperture_radius > 0;
  };
  std::visit(set, camera_);
}

MovingCamera::MovingCamera(Camera camera, Vec2i film_size) : camera_(std::move(camera)), film_size_(film_size) {
  const auto take_keys = [&](auto& kind) {
    if (!kind.motion_transforms.empty()) keys_.emplace_back(kind.to_world);
    for (const Transform& key : kind.motion_transforms) keys_.emplace_back(key);
    kind.motion_transforms.clear();  // copies of the camera are made for each ray
  };
  std::visit(take_keys, camera_);
}

CameraView MovingCamera::at(float time) const {
  Camera now = camera_;
  std::visit([&](auto& kind) { kind.to_world = Transform(transform_at(keys_, time)); }, now);
  return {now, film_size_};
}

void CameraView::set_window(const PerspectiveCamera& camera, Vec2f step) {
  origin_ = camera.to_world.column(3);
  direction_ = camera.to_world.vector(Vec3f{camera.window_min.x, camera.window_min.y, -1});
  direction_dx_ = camera.to_world.column(0) * step.x;
  direction_dy_ = camera.to_world.column(1) * step.y;
}

void CameraView::set_window(const OrthographicCamera& camera, Vec2f step) {
  origin_ = camera.to_world.point(Vec3f{camera.window_min.x, camera.window_min.y, 0});
  origin_dx_ = camera.to_world.column(0) * step.x;
  origin_dy_ = camera.to_world.column(1) * step.y;
  direction_ = -camera.to_world.column(2);
}

template <Panorama Kind>
void CameraView::set_window(const Kind&, Vec2f) {
  is_panorama_ = true;
}

std::optional<Ray> CameraView::ray(Vec2f pixel, Vec2f lens) const {
  const auto make_ray = [&]<class Kind>(const Kind& camera) -> std::optional<Ray> {
    if constexpr (Panorama<Kind>)
      return panorama_ray(camera, pixel, lens);
    else
      return has_aperture_ ? flat_ray(camera, pixel, lens) : ray(pixel);
  };
  return std::visit(make_ray, camera_);
}

// All rays of a pixel meet in the plane that is in focus, at one depth.
Ray CameraView::flat_ray(const CameraBase& camera, Vec2f pixel, Vec2f lens) const {
  const Vec2f place = sample_aperture(camera, lens);
  const Vec3f middle = origin_ + origin_dx_ * pixel.x + origin_dy_ * pixel.y;
  const Vec3f forward = direction_ + direction_dx_ * pixel.x + direction_dy_ * pixel.y;
  const Vec3f origin = middle + right_ * place.x + up_ * place.y;
  const Vec3f towards = middle + forward * (camera.focus_distance / dot(forward, axis_)) - origin;
  const float reach = length(towards), distance_per_depth = reach / dot(towards, axis_);
  return {.origin = origin,
          .t_min = clip_near_ * distance_per_depth,
          .direction = towards * (1 / reach),
          .t_max = clip_far_ * distance_per_depth,
          .kinds = ray_camera};
}

// The aperture turns with the view, its x axis staying as level as it can; in focus is a sphere.
template <Panorama Kind>
std::optional<Ray> CameraView::panorama_ray(const Kind& camera, Vec2f pixel, Vec2f lens) const {
  const Vec2f window = window_place(camera, pixel);
  if (!camera.sees(window)) return std::nullopt;
  Vec3f origin = position_, direction = normalize(camera.to_world.vector(camera.bearing(window).direction));
  if (has_aperture_) {
    const Vec2f place = sample_aperture(camera, lens);
    const Frame frame = make_frame(-direction, cross(direction, up_));
    const Vec3f offset = frame.tangent * place.x + frame.bitangent * place.y;
    origin += offset;
    direction = normalize(direction * camera.focus_distance - offset);
  }
  return Ray{.origin = origin, .t_min = clip_near_, .direction = direction, .t_max = clip_far_, .kinds = ray_camera};
}

std::optional<Vec2f> CameraView::pixel_of_local(Vec3d local) const {
  const auto find_place = [&]<class Kind>(const Kind& camera) -> std::optional<Vec2f> {
    if constexpr (Panorama<Kind>) {
      const double distance = length(local);
      return distance > 0 ? camera.place_of(Vec3f(local * (1 / distance))) : std::nullopt;
    } else {
      const double depth = std::is_same_v<Kind, PerspectiveCamera> ? -local.z : 1;
      return depth > 0 ? std::optional(Vec2f(Vec2d{local.x, local.y} * (1 / depth))) : std::nullopt;
    }
  };
  const auto find_pixel = [&](const auto& camera) -> std::optional<Vec2f> {
    const std::optional<Vec2f> place = find_place(camera);
    if (!place) return std::nullopt;
    return Vec2f{(place->x - camera.window_min.x) / step_.x, (place->y - camera.window_min.y) / step_.y};
  };
  return std::visit(find_pixel, camera_);
}

std::optional<Vec2f> CameraView::pixel_of(Vec3f position) const {
  return pixel_of_local(inverse(TransformD(base_of(camera_).to_world)).point(Vec3d(position)));
}

std::optional<Vec2f> CameraView::pixel_of_direction(Vec3f direction) const {
  if (std::holds_alternative<OrthographicCamera>(camera_)) return std::nullopt;
  return pixel_of_local(inverse(TransformD(base_of(camera_).to_world)).vector(Vec3d(direction)));
}

float CameraView::period() const {
  const bool goes_around =
      std::holds_alternative<EquirectangularCamera>(camera_) || std::holds_alternative<CylindricalCamera>(camera_);
  return goes_around ? 2 * pi / step_.x : 0;
}

RayDifferentials CameraView::differentials(Vec2f pixel) const {
  const auto change = [&]<class Kind>(const Kind& camera) -> RayDifferentials {
    if constexpr (Panorama<Kind>) {
      const Bearing bearing = camera.bearing(window_place(camera, pixel));
      const Vec3f direction = camera.to_world.vector(bearing.direction);
      return {.origin_dx = Vec3f(0),
              .origin_dy = Vec3f(0),
              .direction_dx = unit_change(direction, camera.to_world.vector(bearing.dx) * step_.x),
              .direction_dy = unit_change(direction, camera.to_world.vector(bearing.dy) * step_.y)};
    } else {
      const Vec3f direction = direction_ + direction_dx_ * pixel.x + direction_dy_ * pixel.y;
      return {.origin_dx = origin_dx_,
              .origin_dy = origin_dy_,
              .direction_dx = unit_change(direction, direction_dx_),
              .direction_dy = unit_change(direction, direction_dy_)};
    }
  };
  return std::visit(change, camera_);
}

}  // namespace basicrt
