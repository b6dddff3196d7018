// SPDX-License-Identifier: GPL-3.0-or-later
// The choice between the two ways depends on the position alone, so that the density is known of any place.
#include "light/triangle_emitter.h"

#include "light/spherical_triangle.h"
#include "math/warp.h"

namespace basicrt {
namespace {

// Steradians. Below, the two ways hardly differ; above, the triangle all but surrounds the position.
constexpr double smallest_solid_angle = 1e-3, largest_solid_angle = 6.2;

// A triangle must not light itself: its own points are in its plane but for the rounding of a float position.
bool is_in_plane(const EmitterTriangle& triangle, Vec3d position) {
  const Vec3d normal = normalize(triangle.cross_product());
  const double height = std::abs(dot(triangle.p0 - position, normal));
  const double size = length(triangle.p1 - triangle.p0) + length(triangle.p2 - triangle.p0);
  return !(height > 1e-6 * size + 3e-7 * max_component(abs(position)));
}

bool is_sampled_by_solid_angle(const SphericalTriangle& seen) {
  return seen.solid_angle() > smallest_solid_angle && seen.solid_angle() < largest_solid_angle;
}

// One over the area, over solid angle.
double area_pdf(const EmitterTriangle& triangle, Vec3d offset) {
  const double distance_squared = length_squared(offset);
  const double twice_projected_area = std::abs(dot(offset, triangle.cross_product())) / std::sqrt(distance_squared);
  return 2 * distance_squared / twice_projected_area;
}

}  // namespace

std::optional<TrianglePlace> sample_triangle_emitter(const EmitterTriangle& triangle, Vec3d position, Vec2f u) {
  if (is_in_plane(triangle, position)) return std::nullopt;
  const Vec3d a = triangle.p0 - position, b = triangle.p1 - position, c = triangle.p2 - position;
  const SphericalTriangle seen(a, b, c);
  if (!is_sampled_by_solid_angle(seen)) {
    const Vec2d weights(sample_triangle(u));
    const Vec3d offset = a + (b - a) * weights.x + (c - a) * weights.y;
    return TrianglePlace{offset, area_pdf(triangle, offset)};
  }
  const Vec3d direction = seen.sample(u), normal = triangle.cross_product();
  const double distance = dot(a, normal) / dot(direction, normal);
  if (!(distance > 0 && std::isfinite(distance))) return std::nullopt;
  return TrianglePlace{direction * distance, 1 / seen.solid_angle()};
}

double pdf_triangle_emitter(const EmitterTriangle& triangle, Vec3d position, Vec3d offset) {
  if (is_in_plane(triangle, position)) return 0;
  const SphericalTriangle seen(triangle.p0 - position, triangle.p1 - position, triangle.p2 - position);
  return is_sampled_by_solid_angle(seen) ? 1 / seen.solid_angle() : area_pdf(triangle, offset);
}

}  // namespace basicrt
