// SPDX-License-Identifier: GPL-3.0-or-later
// One-point-light direct lighting behind perfect refraction, a batch at a time.
#include "integrator/intersection_test.h"

#include "integrator/batch.h"
#include "integrator/hit_shading.h"
#include "math/constants.h"

namespace basicrt {

void IntersectionTest::render(std::span<const CameraPath> paths, std::span<PixelSample> samples) {
  begin(paths, samples);
  for (int depth = 0; depth < scene_.settings.max_depth && !paths_.empty(); ++depth) {
    extend();
    shade(samples);
  }
  connect(samples);
}

void IntersectionTest::begin(std::span<const CameraPath> paths, std::span<PixelSample> samples) {
  paths_.clear();
  shadow_rays_.clear();
  shadow_tests_.clear();
  for (std::uint32_t i = 0; i < paths.size(); ++i) {
    samples[i] = PixelSample{};
    samples[i].alpha = scene_.settings.is_film_transparent ? 0.0f : 1.0f;
    paths_.push_back({.sample = i, .ray = paths[i].camera_ray.ray, .sampler = paths[i].sampler});
  }
}

void IntersectionTest::extend() { find_hits(scene_.tracer, paths_, rays_, hits_); }

void IntersectionTest::shade(std::span<PixelSample> samples) {
  const RenderSettings& settings = scene_.settings;
  next_paths_.clear();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (!hits_[i].is_hit()) continue;
    Path& path = paths_[i];
    const SurfacePoint point = surface_point_at(scene_, path.ray, hits_[i]);
    samples[path.sample].alpha = 1;
    if (path.is_camera_ray) record_first_hit(scene_, point, samples[path.sample]);

    const Vec3f wo = -path.ray.direction;
    const SurfaceShading shading = shade_at(scene_, point, wo);
    const Bsdf& bsdf = shading.bsdf;
    if (bsdf.has_only_deltas()) {
      const float choice = path.sampler.next_1d();
      const std::optional<BsdfSample> scattered = bsdf.sample(wo, choice, path.sampler.next_2d());
      if (!scattered) continue;
      path.throughput *= scattered->weight;
      path.ray = spawn_ray(point, scattered->wi, ray_transmission, path.ray.time);
      path.is_camera_ray = false;
      next_paths_.push_back(path);
      continue;
    }

    // radiance = f cos flux / (4 pi r^2), unless something is in the way.
    const Vec3f to_light = settings.point_light_position - point.position;
    const float distance = length(to_light);
    const Vec3f wi = to_light / distance;
    const Color reflected = bsdf.eval(wo, wi).value;
    if (is_black(reflected)) continue;
    const Color irradiance = settings.point_light_flux / (4 * pi * distance * distance);
    shadow_rays_.push_back(spawn_shadow_ray(point, wi, distance, path.ray.time));
    shadow_tests_.push_back({path.sample, path.throughput * reflected * irradiance});
  }
  paths_.swap(next_paths_);
}

void IntersectionTest::connect(std::span<PixelSample> samples) {
  add_unoccluded(scene_.tracer, shadow_rays_, shadow_tests_, occluded_, samples);
}

}  // namespace basicrt
