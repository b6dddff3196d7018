// SPDX-License-Identifier: GPL-3.0-or-later
// What every kind of geometry answers: its bounds, and whether it is sound.
#include "geometry/shape.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/overloaded.h"
#include "geometry/sphere.h"

namespace basicrt {
namespace {

void validate_sphere(const Sphere& sphere, std::string_view item) {
  const std::string name(item);
  if (!is_finite(sphere.center)) throw SceneError(name + ".center", "must be finite, is NaN or infinite");
  if (!(sphere.radius > 0 && std::isfinite(sphere.radius)))
    throw SceneError(name + ".radius", "must be positive and finite, is " + std::to_string(sphere.radius));
}

}  // namespace

Bounds3f bounds(const Shape& shape) {
  const auto of_sphere = [](const Sphere& sphere) { return sphere_bounds(sphere.center, sphere.radius); };
  return std::visit(Overloaded{of_sphere, [](const auto& other) { return bounds(other); }}, shape);
}

bool is_empty(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Mesh& mesh) { return mesh.triangles.empty(); }, [](const Sphere&) { return false; },
                 [](const PointCloud& cloud) { return bounds(cloud).is_empty(); },
                 [](const Curves& curves) { return !has_segments(curves); }},
      shape);
}

void validate(const Shape& shape, std::string_view item) {
  std::visit(Overloaded{[&](const Sphere& sphere) { validate_sphere(sphere, item); },
                        [&](const auto& other) { validate(other, item); }},
             shape);
}

}  // namespace basicrt
