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

bool FisheyeEquidistantCamera::sees(Vec2f place) const { return distance_from_axis(place) <= 0.5f * fov; }

Bearing FisheyeEquidistantCamera::bearing(Vec2f place) const {
  const float r = distance_from_axis(place);
  return turned_about_axis(place, r, r, 1);
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

bool FisheyePolynomialCamera::sees(Vec2f place) const {
  return std::abs(angle(distance_from_axis(place))) <= 0.5f * fov;
}

Bearing FisheyePolynomialCamera::bearing(Vec2f place) const {
  const float r = distance_from_axis(place);
  return turned_about_axis(place, r, angle(r), k1 + r * (2 * k2 + r * (3 * k3 + r * 4 * k4)));
}

bool CubemapFaceCamera::sees(Vec2f place) const { return std::abs(place.x) < pi / 2 && std::abs(place.y) < pi / 2; }

Bearing CubemapFaceCamera::bearing(Vec2f place) const {
  const float x = std::tan(place.x), y = std::tan(place.y);
  return {.direction = {x, y, -1}, .dx = {tangent_slope(x), 0, 0}, .dy = {0, tangent_slope(y), 0}};
}

Bearing CylindricalCamera::bearing(Vec2f place) const {
  const float s = std::sin(place.x), c = std::cos(place.x);
  return {.direction = {s, place.y, -c}, .dx = {c, 0, s}, .dy = {0, 1, 0}};
}

}  // namespace basicrt
