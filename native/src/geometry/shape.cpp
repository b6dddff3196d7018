// SPDX-License-Identifier: GPL-3.0-or-later
// What every kind of geometry answers: its bounds, and whether it is sound.
#include "geometry/shape.h"

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/overloaded.h"
#include "math/next_float.h"

namespace basicrt {
namespace {

Bounds3f bounds_of(const Sphere& sphere) {
  Bounds3f result;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // One float wider: center +- radius was rounded.
    result.lower[axis] = next_float_down(sphere.center[axis] - sphere.radius);
    result.upper[axis] = next_float_up(sphere.center[axis] + sphere.radius);
  }
  return result;
}

void validate_sphere(const Sphere& sphere, std::string_view item) {
  const std::string name(item);
  if (!is_finite(sphere.center)) throw SceneError(name + ".center", "must be finite, is NaN or infinite");
  if (!(sphere.radius > 0 && std::isfinite(sphere.radius)))
    throw SceneError(name + ".radius", "must be positive and finite, is " + std::to_string(sphere.radius));
}

}  // namespace

Bounds3f bounds(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Mesh& mesh) { return bounds(mesh); }, [](const Sphere& sphere) { return bounds_of(sphere); }},
      shape);
}

bool is_empty(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh && mesh->triangles.empty();
}

void validate(const Shape& shape, std::string_view item) {
  std::visit(Overloaded{[&](const Mesh& mesh) { validate(mesh, item); },
                        [&](const Sphere& sphere) { validate_sphere(sphere, item); }},
             shape);
}

}  // namespace basicrt
