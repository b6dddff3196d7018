// SPDX-License-Identifier: GPL-3.0-or-later
// Rectangles are sampled by solid angle where they can be, everything else by area.
#include "light/area.h"

#include "light/spherical_rectangle.h"
#include "math/frame.h"
#include "math/warp.h"

namespace basicrt {
namespace {

// A smaller solid angle (steradians) is as good as flat, and is sampled by area.
constexpr double smallest_solid_angle = 1e-6;
// A narrower spread (radians) than Blender's narrowest, one degree, counts as that.
constexpr float narrowest_spread = 0.0174533f;
constexpr float widest_spread = 3.14159f;

// Radiance at an angle to the normal, over that of full spread: the same power in all. Falls with the tangent to
// nothing at half the spread, as Blender's lamps do.
double spread_share(const AreaLamp& light, double cosine) {
  if (light.has_full_spread) return 1;
  const double tangent = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;
  return std::max(0.0, 1 - tangent / light.tan_half_spread) * light.spread_scale;
}

// The part of a rectangle that can shine on a position, in coordinates along its edges around the position's foot on
// its plane: a spread leaves only what is near the foot.
struct Window {
  Vec2d min, max;
  double height;
  [[nodiscard]] bool is_empty() const { return !(min.x < max.x && min.y < max.y); }
  [[nodiscard]] double area() const { return (max.x - min.x) * (max.y - min.y); }
};

Window window_of(const AreaLamp& light, Vec3d from_center, double height) {
  const Vec2d foot{dot(from_center, light.axis_x), dot(from_center, light.axis_y)};
  const Vec2d half{light.width / 2, light.depth / 2};
  Window window{Vec2d{} - half - foot, half - foot, height};
  if (!light.has_full_spread) {
    const double reach = height * light.tan_half_spread;
    window.min = {std::max(window.min.x, -reach), std::max(window.min.y, -reach)};
    window.max = {std::min(window.max.x, reach), std::min(window.max.y, reach)};
  }
  return window;
}

// A place on the plate relative to the position, and its density over the plate's area or, if that is not 0, over
// solid angle.
struct PlaceDensity {
  double per_area = 0, per_solid_angle = 0;
};
double over_solid_angle(const PlaceDensity& density, double distance_squared, double cosine) {
  return density.per_solid_angle > 0 ? density.per_solid_angle : density.per_area * distance_squared / cosine;
}

// Uniform by area, relative to the centre.
Vec3d sample_plate(const AreaLamp& light, Vec2f u) {
  const Vec2d local = light.is_ellipse ? Vec2d(sample_disk(u)) * 0.5 : Vec2d{u.x - 0.5, u.y - 0.5};
  return light.edge_x * local.x + light.edge_y * local.y;
}

bool is_on_plate(const AreaLamp& light, Vec3d from_center) {
  const double x = dot(from_center, light.dual_x), y = dot(from_center, light.dual_y);
  return light.is_ellipse ? x * x + y * y <= 0.25 : std::abs(x) <= 0.5 && std::abs(y) <= 0.5;
}

double cone_sin_squared(const AreaLamp& light) {
  if (light.has_full_spread) return 1;
  const double s = std::sin(light.half_spread);
  return s * s;
}

}  // namespace

AreaLamp::AreaLamp(const AreaLight& light) : AreaLight(light) {
  const TransformD transform(light.to_world);
  center = transform.column(3);
  edge_x = transform.column(0);
  edge_y = transform.column(1);
  width = length(edge_x);
  depth = length(edge_y);
  axis_x = edge_x / width;
  axis_y = edge_y / depth;
  const Vec3d across = cross(edge_x, edge_y);
  const double parallelogram = length(across);
  // Local -z may lie on either side where the transform mirrors.
  normal = across * ((dot(across, transform.column(2)) < 0 ? 1 : -1) / parallelogram);
  dual_x = cross(edge_y, across) / (parallelogram * parallelogram);
  dual_y = cross(across, edge_x) / (parallelogram * parallelogram);
  area = is_ellipse ? parallelogram * (std::numbers::pi / 4) : parallelogram;
  const double cosine = dot(axis_x, axis_y);
  is_rectangle = !is_ellipse && cosine * cosine <= 1e-12;
  has_full_spread = spread >= widest_spread;
  half_spread = std::max(spread, narrowest_spread) / 2.0;
  tan_half_spread = std::tan(half_spread);
  spread_scale = 1 / (1 - half_spread / tan_half_spread);
}

bool is_delta_lamp(const AreaLamp&) { return false; }

std::optional<LightSample> sample_lamp(const AreaLamp& light, Vec3f position, Vec2f u) {
  const Vec3d from_center = Vec3d(position) - light.center;
  const double height = dot(from_center, light.normal);
  if (!(height > 0)) return std::nullopt;

  Vec3d to_place;
  PlaceDensity density;
  if (light.is_rectangle) {
    const Window window = window_of(light, from_center, height);
    if (window.is_empty()) return std::nullopt;
    const SphericalRectangle rectangle(window.min, window.max, window.height);
    Vec2d place;
    if (rectangle.solid_angle() > smallest_solid_angle) {
      place = rectangle.sample(u);
      density.per_solid_angle = 1 / rectangle.solid_angle();
    } else {
      place = {lerp(window.min.x, window.max.x, double(u.x)), lerp(window.min.y, window.max.y, double(u.y))};
      density.per_area = 1 / window.area();
    }
    to_place = light.axis_x * place.x + light.axis_y * place.y - light.normal * height;
  } else {
    to_place = sample_plate(light, u) - from_center;
    density.per_area = 1 / light.area;
  }

  const double distance_squared = length_squared(to_place), distance = std::sqrt(distance_squared);
  const double cosine = -dot(to_place, light.normal) / distance;
  if (!(cosine > 0)) return std::nullopt;
  return LightSample{.wi = Vec3f(to_place / distance),
                     .distance = float(distance),
                     .radiance = light.radiance * float(spread_share(light, cosine)),
                     .pdf = float(over_solid_angle(density, distance_squared, cosine))};
}

std::optional<LightHit> intersect_lamp(const AreaLamp& light, const Ray& ray) {
  const Vec3d from_center = Vec3d(ray.origin) - light.center, direction(ray.direction);
  const double height = dot(from_center, light.normal), approach = -dot(direction, light.normal);
  if (!(height > 0 && approach > 0)) return std::nullopt;
  const double t = height / approach;
  if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
  if (!is_on_plate(light, from_center + direction * t)) return std::nullopt;

  const double direction_squared = length_squared(direction);
  const double cosine = approach / std::sqrt(direction_squared);
  PlaceDensity density{.per_area = 1 / light.area};
  if (light.is_rectangle) {
    const Window window = window_of(light, from_center, height);
    if (window.is_empty()) return std::nullopt;
    const double solid_angle = SphericalRectangle(window.min, window.max, window.height).solid_angle();
    density = {.per_area = 1 / window.area(),
               .per_solid_angle = solid_angle > smallest_solid_angle ? 1 / solid_angle : 0};
  }
  return LightHit{.t = float(t),
                  .radiance = light.radiance * float(spread_share(light, cosine)),
                  .pdf = float(over_solid_angle(density, t * t * direction_squared, cosine))};
}

// Directions by the cosine within the spread.
EmissionSample sample_lamp_emission(const AreaLamp& light, Vec2f u_position, Vec2f u_direction, Vec3f, float) {
  const Vec3d place = light.center + sample_plate(light, u_position);
  // The cone's projection onto the plate is a disc, in which the cosine is uniform.
  const double cone = cone_sin_squared(light);
  const Vec2d on_disk = Vec2d(sample_disk(u_direction)) * std::sqrt(cone);
  const double cosine = std::sqrt(std::max(0.0, 1 - on_disk.x * on_disk.x - on_disk.y * on_disk.y));
  const Vec3f normal(light.normal);
  const Vec3f direction = make_frame(normal).to_world({float(on_disk.x), float(on_disk.y), float(cosine)});
  return {.ray = {.origin = Vec3f(place), .direction = direction},
          .normal = normal,
          .weight = light.radiance * float(spread_share(light, cosine) * std::numbers::pi * cone * light.area),
          .pdf_position = float(1 / light.area),
          .pdf_direction = float(cosine / (std::numbers::pi * cone))};
}

EmissionPdf lamp_emission_pdf(const AreaLamp& light, Vec3f, Vec3f direction, float) {
  const double cosine = dot(Vec3d(direction), light.normal), cone = cone_sin_squared(light);
  const bool is_inside = cosine > 0 && 1 - cosine * cosine <= cone;
  return {float(1 / light.area), is_inside ? float(cosine / (std::numbers::pi * cone)) : 0};
}

LightBounds lamp_bounds(const AreaLamp& light) {
  Bounds3f box;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5}) box.extend(Vec3f(light.center + light.edge_x * x + light.edge_y * y));
  return {.box = box,
          .axis = Vec3f(light.normal),
          .cos_normals = 1,
          .cos_emission = light.has_full_spread ? 0 : float(std::cos(light.half_spread)),
          .is_solid = true,
          .lowest = height_along(Vec3f(light.normal), light.center),
          .intensity = luminance(light.radiance) * float(light.area * spread_share(light, 1))};
}

float lamp_power(const AreaLamp& light, float) { return pi * float(light.area) * luminance(light.radiance); }

}  // namespace basicrt
