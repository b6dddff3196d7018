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

// The lamp in world space.
struct Plate {
  Vec3d center, edge_x, edge_y;
  Vec3d normal;  // of the side that shines, unit length
  double area;
};

Plate plate_of(const AreaLight& light) {
  const TransformD to_world(light.to_world);
  const Vec3d edge_x = to_world.column(0), edge_y = to_world.column(1);
  const Vec3d across = cross(edge_x, edge_y);
  const double parallelogram = length(across);
  // Local -z may lie on either side where the transform mirrors.
  const double side = dot(across, to_world.column(2)) < 0 ? 1 : -1;
  return {.center = to_world.column(3),
          .edge_x = edge_x,
          .edge_y = edge_y,
          .normal = across * (side / parallelogram),
          .area = light.is_ellipse ? parallelogram * (std::numbers::pi / 4) : parallelogram};
}

double half_spread(const AreaLight& light) { return std::max(light.spread, narrowest_spread) / 2.0; }
bool has_full_spread(const AreaLight& light) { return light.spread >= widest_spread; }

// Radiance at an angle to the normal, over that of full spread: the same power in all. Falls with the tangent to
// nothing at half the spread, as Blender's lamps do.
double spread_share(const AreaLight& light, double cosine) {
  if (has_full_spread(light)) return 1;
  const double a = half_spread(light);
  const double tangent = std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine;
  return std::max(0.0, 1 - tangent / std::tan(a)) / (1 - a / std::tan(a));
}

bool is_perpendicular(const Plate& plate) {
  const double cosine = dot(plate.edge_x, plate.edge_y);
  return cosine * cosine <= 1e-12 * length_squared(plate.edge_x) * length_squared(plate.edge_y);
}

// The part of a rectangle that can shine on a position, in coordinates along its edges around the position's foot on
// its plane: a spread leaves only what is near the foot.
struct Window {
  Vec2d min, max;
  double height;
  [[nodiscard]] bool is_empty() const { return !(min.x < max.x && min.y < max.y); }
  [[nodiscard]] double area() const { return (max.x - min.x) * (max.y - min.y); }
};

Window window_of(const AreaLight& light, const Plate& plate, Vec3d from_center, double height) {
  const double width = length(plate.edge_x), depth = length(plate.edge_y);
  const Vec2d foot{dot(from_center, plate.edge_x) / width, dot(from_center, plate.edge_y) / depth};
  Window window{{-width / 2 - foot.x, -depth / 2 - foot.y}, {width / 2 - foot.x, depth / 2 - foot.y}, height};
  if (!has_full_spread(light)) {
    const double reach = height * std::tan(half_spread(light));
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
Vec3d sample_plate(const AreaLight& light, const Plate& plate, Vec2f u) {
  const Vec2d local = light.is_ellipse ? Vec2d(sample_disk(u)) * 0.5 : Vec2d{u.x - 0.5, u.y - 0.5};
  return plate.edge_x * local.x + plate.edge_y * local.y;
}

bool is_on_plate(const AreaLight& light, const Plate& plate, Vec3d from_center) {
  const Vec3d across = cross(plate.edge_x, plate.edge_y);
  const double scale = 1 / length_squared(across);
  const double x = dot(cross(from_center, plate.edge_y), across) * scale;
  const double y = dot(cross(plate.edge_x, from_center), across) * scale;
  return light.is_ellipse ? x * x + y * y <= 0.25 : std::abs(x) <= 0.5 && std::abs(y) <= 0.5;
}

double cone_sin_squared(const AreaLight& light) {
  if (has_full_spread(light)) return 1;
  const double s = std::sin(half_spread(light));
  return s * s;
}

}  // namespace

bool is_delta_lamp(const AreaLight&) { return false; }

std::optional<LightSample> sample_lamp(const AreaLight& light, Vec3f position, Vec2f u) {
  const Plate plate = plate_of(light);
  const Vec3d from_center = Vec3d(position) - plate.center;
  const double height = dot(from_center, plate.normal);
  if (!(height > 0)) return std::nullopt;

  Vec3d to_place;
  PlaceDensity density;
  if (!light.is_ellipse && is_perpendicular(plate)) {
    const Window window = window_of(light, plate, from_center, height);
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
    to_place = normalize(plate.edge_x) * place.x + normalize(plate.edge_y) * place.y - plate.normal * height;
  } else {
    to_place = sample_plate(light, plate, u) - from_center;
    density.per_area = 1 / plate.area;
  }

  const double distance_squared = length_squared(to_place), distance = std::sqrt(distance_squared);
  const double cosine = -dot(to_place, plate.normal) / distance;
  if (!(cosine > 0)) return std::nullopt;
  return LightSample{.wi = Vec3f(to_place / distance),
                     .distance = float(distance),
                     .radiance = light.radiance * float(spread_share(light, cosine)),
                     .pdf = float(over_solid_angle(density, distance_squared, cosine))};
}

std::optional<LightHit> intersect_lamp(const AreaLight& light, const Ray& ray) {
  const Plate plate = plate_of(light);
  const Vec3d from_center = Vec3d(ray.origin) - plate.center, direction(ray.direction);
  const double height = dot(from_center, plate.normal), approach = -dot(direction, plate.normal);
  if (!(height > 0 && approach > 0)) return std::nullopt;
  const double t = height / approach;
  if (!(t >= ray.t_min && t <= ray.t_max)) return std::nullopt;
  if (!is_on_plate(light, plate, from_center + direction * t)) return std::nullopt;

  const double direction_squared = length_squared(direction);
  const double cosine = approach / std::sqrt(direction_squared);
  PlaceDensity density{.per_area = 1 / plate.area};
  if (!light.is_ellipse && is_perpendicular(plate)) {
    const Window window = window_of(light, plate, from_center, height);
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
EmissionSample sample_lamp_emission(const AreaLight& light, Vec2f u_position, Vec2f u_direction, Vec3f, float) {
  const Plate plate = plate_of(light);
  const Vec3d place = plate.center + sample_plate(light, plate, u_position);
  // The cone's projection onto the plate is a disc, in which the cosine is uniform.
  const double cone = cone_sin_squared(light);
  const Vec2d on_disk = Vec2d(sample_disk(u_direction)) * std::sqrt(cone);
  const double cosine = std::sqrt(std::max(0.0, 1 - on_disk.x * on_disk.x - on_disk.y * on_disk.y));
  const Vec3f normal(plate.normal);
  const Vec3f direction = make_frame(normal).to_world({float(on_disk.x), float(on_disk.y), float(cosine)});
  return {.ray = {.origin = Vec3f(place), .direction = direction},
          .normal = normal,
          .weight = light.radiance * float(spread_share(light, cosine) * std::numbers::pi * cone * plate.area),
          .pdf_position = float(1 / plate.area),
          .pdf_direction = float(cosine / (std::numbers::pi * cone))};
}

EmissionPdf lamp_emission_pdf(const AreaLight& light, Vec3f, Vec3f direction, float) {
  const Plate plate = plate_of(light);
  const double cosine = dot(Vec3d(direction), plate.normal), cone = cone_sin_squared(light);
  const bool is_inside = cosine > 0 && 1 - cosine * cosine <= cone;
  return {float(1 / plate.area), is_inside ? float(cosine / (std::numbers::pi * cone)) : 0};
}

LightBounds lamp_bounds(const AreaLight& light) {
  const Plate plate = plate_of(light);
  Bounds3f box;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5}) box.extend(Vec3f(plate.center + plate.edge_x * x + plate.edge_y * y));
  return {.box = box,
          .axis = Vec3f(plate.normal),
          .cos_normals = 1,
          .cos_emission = has_full_spread(light) ? 0 : float(std::cos(half_spread(light))),
          .is_solid = true,
          .intensity = luminance(light.radiance) * float(plate.area * spread_share(light, 1))};
}

float lamp_power(const AreaLight& light, float) { return pi * float(plate_of(light).area) * luminance(light.radiance); }

}  // namespace basicrt
