// SPDX-License-Identifier: GPL-3.0-or-later
// What every integrator does with a hit: the surfaces of a whole batch, passes, and the rays that leave.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "bsdf/bsdf.h"
#include "geometry/shadow_terminator.h"
#include "geometry/surface_point.h"
#include "math/next_float.h"
#include "scene/shade_point.h"

namespace basicrt {

// The surface points of some of a batch's hits at once, few enough to stay in the cache until they are shaded.
class SurfacePoints {
 public:
  static constexpr std::size_t at_once = surface_hits_at_once;

  SurfacePoints() { moved_.reserve(at_once); }

  // Before the first of a batch.
  void begin() { first_ = end_ = 0; }
  // Of the hits from `first` on, up to end(). Where a ray missed there is none.
  void find(const PreparedScene& scene, std::span<const Ray> rays, std::span<const Hit> hits, std::size_t first) {
    std::array<SurfaceHit, at_once> found;
    std::size_t count = 0;
    moved_.clear();
    const std::size_t end = std::min(rays.size(), first + at_once);
    for (std::size_t i = first; i < end; ++i) {
      if (!hits[i].is_hit()) continue;
      const PreparedScene::PreparedInstance& instance = scene.instances[hits[i].instance];
      const Placement* placement = &instance.placement;
      if (!instance.motion.empty()) placement = &moved_.emplace_back(transform_at(instance.motion, rays[i].time));
      found[count++] = {&scene.shapes[instance.shape], placement, &rays[i], &hits[i], &points_[i - first]};
    }
    make_surface_points(std::span(found).first(count));
    for (const SurfaceHit& hit : std::span(found).first(count))
      if (const auto& instance = scene.instances[hit.hit->instance]; instance.needs_derivatives)
        add_details(instance, *hit.point, *hit.shape, *hit.placement);
    first_ = first;
    end_ = end;
  }
  [[nodiscard]] std::size_t end() const { return end_; }
  // `i` counts as in the batch.
  [[nodiscard]] const SurfacePoint& operator[](std::size_t i) const { return points_[i - first_]; }

 private:
  std::size_t first_ = 0, end_ = 0;
  std::array<SurfacePoint, at_once> points_;
  std::vector<Placement> moved_;  // of what moves, at the rays' times
};

[[nodiscard]] inline Color transparency_at(const PreparedScene& scene, const SurfacePoint& point, Vec3f wo,
                                           const ShadingContext& context) {
  return transparency(scene.material_of(point).transparent, scene.textures, point, wo, context);
}

// Notes the passes of a camera ray's first hit.
inline void record_first_hit(const PreparedScene& scene, const SurfacePoint& point, PixelSample& sample) {
  sample.has_hit = true;
  sample.depth = scene.moving_camera.is_moving() ? scene.moving_camera.at(point.time).depth(point.position)
                                                 : scene.view.depth(point.position);
  sample.normal = point.is_backfacing ? -point.shading_normal : point.shading_normal;
}

// Names the triangle that a ray starts on. A sphere isn't named: a ray may well hit it again.
inline void set_start(Ray& ray, const SurfacePoint& point) {
  ray.from_instance = point.primitive == Hit::none ? Hit::none : point.instance;
  ray.from_primitive = point.primitive;
}

// Veach 1997, the power heuristic with exponent two.
[[nodiscard]] inline float power_heuristic(float pdf, float other_pdf) {
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

// A ray that leaves the surface, free of hitting it again.
[[nodiscard]] inline Ray spawn_ray(const SurfacePoint& point, Vec3f direction, std::uint32_t kinds, float time) {
  Ray ray{.origin = offset_origin(point, direction), .direction = direction, .kinds = kinds, .time = time};
  set_start(ray, point);
  return ray;
}

// How much of the way to a light shadow rays go.
inline constexpr float shadow_ray_share = 1 - 1e-4f;

// A ray from the surface that ends just before what is `distance` away.
[[nodiscard]] inline Ray spawn_shadow_ray(const SurfacePoint& point, Vec3f direction, float distance, float time) {
  Ray ray = spawn_ray(point, direction, ray_shadow, time);
  ray.t_max = distance * shadow_ray_share;
  return ray;
}

// The same as Blender's shadow terminator offset has it: on a smooth-shaded mesh the ray may start above the facet.
[[nodiscard]] inline Ray spawn_shadow_ray(const PreparedScene& scene, const SurfacePoint& point, Vec3f direction,
                                          float distance, float time) {
  Ray ray = spawn_shadow_ray(point, direction, distance, time);
  const PreparedScene::PreparedInstance& instance = scene.instances[point.instance];
  if (instance.shadow_terminator_offset == 0) return ray;
  const float share = smooth_share(point, direction, instance.shadow_terminator_offset);
  if (share == 0) return ray;
  const Mesh& mesh = std::get<Mesh>(scene.shapes[instance.shape]);
  const Vec3f shift = shift_to_smooth_surface(mesh, instance.placement, point, direction) * share;
  if (!(length_squared(shift) > 0)) return ray;
  ray.origin = offset_origin(point, shift) + shift;
  if (distance == infinity) return ray;
  const Vec3f to_light = point.position + direction * distance - ray.origin;  // the same point of it
  const float new_distance = length(to_light);
  ray.direction = to_light * (1 / new_distance);
  ray.t_max = new_distance * shadow_ray_share;
  return ray;
}

// Takes the ray on behind a hit. Its origin stays, so that densities are still measured from where it was scattered. The
// tracer's own distance is what it will compare others with: each round begins behind all that the last one found.
inline void continue_behind(Ray& ray, const Hit& hit, const SurfacePoint& point) {
  ray.t_min = next_float_up(std::max(ray.t_min, hit.t));
  set_start(ray, point);
}

}  // namespace basicrt
