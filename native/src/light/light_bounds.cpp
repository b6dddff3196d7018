// SPDX-License-Identifier: GPL-3.0-or-later
// The cone of many lights' normals lies around the mean of their axes.
#include "light/light_bounds.h"

#include <cmath>
#include <numbers>

namespace basicrt {
namespace {

// Two-sided lights have no sign: they are turned to agree with the first.
Vec3f aligned_axis(const LightBounds& light, const LightBounds& first) {
  return light.is_two_sided && dot(light.axis, first.axis) < 0 ? -light.axis : light.axis;
}

}  // namespace

// A bit less, for the rounding of the axis.
float height_along(Vec3f axis, Vec3d point) {
  return static_cast<float>(dot(Vec3d(axis), point) - 1e-6 * max_component(abs(point)));
}

LightBounds merge(std::span<const LightBounds> lights) {
  const LightBounds& first = lights.front();
  if (lights.size() == 1) return first;
  LightBounds all{.cos_emission = 1, .is_two_sided = first.is_two_sided};
  double intensity = 0;
  Vec3d axes(0.0);
  bool is_mixed = false;
  for (const LightBounds& light : lights) {
    all.box.extend(light.box);
    all.cos_emission = std::min(all.cos_emission, light.cos_emission);
    all.is_solid = all.is_solid || light.is_solid;
    is_mixed = is_mixed || light.is_two_sided != first.is_two_sided;
    intensity += light.intensity;
    axes += Vec3d(aligned_axis(light, first)) * (double(light.intensity) * (1 + light.cos_normals));
  }
  all.intensity = static_cast<float>(std::min<double>(intensity, std::numeric_limits<float>::max()));

  const double length_of_axes = length(axes);
  const auto give_up = [&] {  // to any direction
    all.cos_normals = -1;
    all.is_two_sided = false;
  };
  if (is_mixed || !(length_of_axes > 1e-6 * intensity)) {
    give_up();
    return all;
  }
  const Vec3d axis = axes / length_of_axes;
  double widest = 0;  // angle
  for (const LightBounds& light : lights) {
    const double cosine = dot(axis, Vec3d(aligned_axis(light, first)));
    widest = std::max(
        widest, std::acos(std::clamp(cosine, -1.0, 1.0)) + std::acos(std::clamp(double(light.cos_normals), -1.0, 1.0)));
  }
  all.axis = Vec3f(axis);
  all.cos_normals = static_cast<float>(std::cos(std::min(widest, std::numbers::pi)));
  if (widest > std::numbers::pi / (all.is_two_sided ? 2 : 1)) give_up();
  return all;
}

}  // namespace basicrt
