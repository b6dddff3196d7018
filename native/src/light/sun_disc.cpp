// SPDX-License-Identifier: GPL-3.0-or-later
// Directions are sampled uniformly in the disc's cone, for its light varies little.
#include "light/sun_disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/solid_angle.h"
#include "math/frame.h"
#include "math/warp.h"

namespace basicrt {
namespace {

// How much of the centre's radiance is lost at the limb.
constexpr float limb_darkening = 0.6f;
// The mean of sqrt(1 - r^2) over a disc is 2 / 3.
constexpr float mean_of_darkened = 1 - limb_darkening / 3;

Vec3d center_of(const SunDisc& disc) { return {std::cos(disc.elevation), 0, std::sin(disc.elevation)}; }

// 1 - cos of the angle between the direction and the disc's centre.
double distance_of(const SunDisc& disc, Vec3d direction) { return length_squared(direction - center_of(disc)) / 2; }

}  // namespace

Color eval_sun_disc(const SunDisc& disc, Vec3d direction) {
  const double distance = distance_of(disc, direction);
  if (distance >= one_minus_cos(disc.radius) || std::asin(std::clamp(direction.z, -1.0, 1.0)) < disc.horizon)
    return Color(0.0f);
  const double share = 2 * std::asin(std::sqrt(distance / 2)) / disc.radius;  // of the way to the limb
  const auto inwards = static_cast<float>(std::sqrt(std::max(1 - share * share, 0.0)));
  const double height = std::asin(std::clamp(direction.z, -1.0, 1.0)) - disc.elevation;
  const auto mix = static_cast<float>(std::clamp(0.5 + height / (2 * disc.radius), 0.0, 1.0));
  return (disc.low * (1 - mix) + disc.high * mix) * (1 - limb_darkening * (1 - inwards));
}

Vec3d sample_sun_disc(const SunDisc& disc, Vec2f u) {
  const double height = double(u.x) * one_minus_cos(disc.radius);  // 1 - cos of the direction
  const double across = std::sqrt(std::max(height * (2 - height), 0.0)), angle = 2 * std::numbers::pi * double(u.y);
  const Vec3d center = center_of(disc), up{-center.z, 0, center.x};
  return center * (1 - height) + up * (across * std::cos(angle)) + Vec3d{0, across * std::sin(angle), 0};
}

double pdf_sun_disc(const SunDisc& disc, Vec3d direction) {
  const double cone = one_minus_cos(disc.radius);
  return distance_of(disc, direction) < cone ? 1 / (2 * std::numbers::pi * cone) : 0;
}

Color sun_disc_irradiance(const SunDisc& disc) {
  const auto solid_angle = static_cast<float>(2 * std::numbers::pi * one_minus_cos(disc.radius));
  return (disc.low + disc.high) * (0.5f * solid_angle * mean_of_darkened);
}

}  // namespace basicrt
