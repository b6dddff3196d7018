// SPDX-License-Identifier: GPL-3.0-or-later
// The projections of panoramic cameras.
#include "camera/panorama.h"

#include <algorithm>
#include <cmath>

namespace basicrt {
namespace {

float distance_from_axis(Vec2f place) { return std::sqrt(place.x * place.x + place.y * place.y); }

// The direction at an angle from the axis, turned about it as `place` is, at the distance `r` from the origin.
// `slope` is the angle's derivative by r.
Bearing turned_about_axis(Vec2f place, float r, float angle, float slope) {
  const Vec2f e = r > 0 ? place * (1 / r) : Vec2f{1, 0};
  const float s = std::sin(angle), c = std::cos(angle);
  const Vec3f outward = Vec3f{c * e.x, c * e.y, s} * slope;
  const Vec3f around = Vec3f{-e.y, e.x, 0} * (r > 0 ? s / r : slope);
  return {.direction = {s * e.x, s * e.y, -c}, .dx = outward * e.x - around * e.y, .dy = outward * e.y + around * e.x};
}

float angle_from_axis(Vec3f direction) { return std::atan2(std::hypot(direction.x, direction.y), -direction.z); }

// The place at the distance `r` from the origin, turned about it as the direction is about the axis.
Vec2f place_about_axis(Vec3f direction, float r) {
  const float across = std::hypot(direction.x, direction.y);
  return across > 0 ? Vec2f{direction.x, direction.y} * (r / across) : Vec2f{r, 0};
}

// 1 / cos^2: the derivative of the tangent, given that.
float tangent_slope(float tangent) { return 1 + tangent * tangent; }

}  // namespace

Bearing EquirectangularCamera::bearing(Vec2f place) const {
  const float sin_longitude = std::sin(place.x), cos_longitude = std::cos(place.x);
  const float sin_latitude = std::sin(place.y), cos_latitude = std::cos(place.y);
  return {.direction = {cos_latitude * sin_longitude, sin_latitude, -cos_latitude * cos_longitude},
          .dx = {cos_latitude * cos_longitude, 0, cos_latitude * sin_longitude},
          .dy = {-sin_latitude * sin_longitude, cos_latitude, sin_latitude * cos_longitude}};
}

std::optional<Vec2f> EquirectangularCamera::place_of(Vec3f direction) const {
  return Vec2f{std::atan2(direction.x, -direction.z), std::atan2(direction.y, std::hypot(direction.x, direction.z))};
}

bool FisheyeEquidistantCamera::sees(Vec2f place) const { return distance_from_axis(place) <= 0.5f * fov; }

Bearing FisheyeEquidistantCamera::bearing(Vec2f place) const {
  const float r = distance_from_axis(place);
  return turned_about_axis(place, r, r, 1);
}

std::optional<Vec2f> FisheyeEquidistantCamera::place_of(Vec3f direction) const {
  return place_about_axis(direction, angle_from_axis(direction));
}

bool FisheyeEquisolidCamera::sees(Vec2f place) const {
  const float sine = distance_from_axis(place) / (2 * focal_length);
  return sine <= 1 && sine <= std::sin(std::min(0.25f * fov, pi / 2));
}

Bearing FisheyeEquisolidCamera::bearing(Vec2f place) const {
  const float r = distance_from_axis(place), sine = std::min(r / (2 * focal_length), 1.0f);
  // At the rim of a full circle the slope has no bound.
  const float cosine = std::max(std::sqrt(1 - sine * sine), 1e-4f);
  return turned_about_axis(place, r, 2 * std::asin(sine), 1 / (focal_length * cosine));
}

std::optional<Vec2f> FisheyeEquisolidCamera::place_of(Vec3f direction) const {
  return place_about_axis(direction, 2 * focal_length * std::sin(0.5f * angle_from_axis(direction)));
}

bool FisheyePolynomialCamera::sees(Vec2f place) const {
  return std::abs(angle(distance_from_axis(place))) <= 0.5f * fov;
}

Bearing FisheyePolynomialCamera::bearing(Vec2f place) const {
  const float r = distance_from_axis(place);
  return turned_about_axis(place, r, angle(r), slope(r));
}

// By Newton's method, from where the distance would be were the angle linear in it.
std::optional<Vec2f> FisheyePolynomialCamera::place_of(Vec3f direction) const {
  constexpr int most_steps = 20;
  constexpr float tolerance = 1e-6f;
  const float wanted = angle_from_axis(direction);
  float r = k1 != 0 ? (wanted - k0) / k1 : wanted;
  for (int i = 0; i < most_steps; ++i) {
    const float step = (angle(r) - wanted) / slope(r);
    r -= step;
    if (!std::isfinite(r)) return std::nullopt;
    if (std::abs(step) <= tolerance * std::abs(r)) break;
  }
  if (!(r >= 0) || std::abs(angle(r) - wanted) > 1e-4f) return std::nullopt;
  return place_about_axis(direction, r);
}

bool CubemapFaceCamera::sees(Vec2f place) const { return std::abs(place.x) < pi / 2 && std::abs(place.y) < pi / 2; }

Bearing CubemapFaceCamera::bearing(Vec2f place) const {
  const float x = std::tan(place.x), y = std::tan(place.y);
  return {.direction = {x, y, -1}, .dx = {tangent_slope(x), 0, 0}, .dy = {0, tangent_slope(y), 0}};
}

std::optional<Vec2f> CubemapFaceCamera::place_of(Vec3f direction) const {
  if (!(direction.z < 0)) return std::nullopt;
  return Vec2f{std::atan2(direction.x, -direction.z), std::atan2(direction.y, -direction.z)};
}

Bearing CylindricalCamera::bearing(Vec2f place) const {
  const float s = std::sin(place.x), c = std::cos(place.x);
  return {.direction = {s, place.y, -c}, .dx = {c, 0, s}, .dy = {0, 1, 0}};
}

std::optional<Vec2f> CylindricalCamera::place_of(Vec3f direction) const {
  const float across = std::hypot(direction.x, direction.z);
  if (!(across > 0)) return std::nullopt;
  return Vec2f{std::atan2(direction.x, -direction.z), direction.y / across};
}

}  // namespace basicrt
