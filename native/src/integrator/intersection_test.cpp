// SPDX-License-Identifier: GPL-3.0-or-later
// One-point-light direct lighting behind perfect refraction, a batch at a time.
#include "integrator/intersection_test.h"

#include <algorithm>

#include "base/append_result.h"
#include "integrator/batch.h"
#include "integrator/hit_shading.h"
#include "math/constants.h"

namespace basicrt {

void IntersectionTest::render(const CameraPaths& paths, std::span<PixelSample> samples) {
  begin(paths, samples);
  for (int depth = 0; depth < scene_.settings.max_depth && !paths_.empty(); ++depth) {
    extend();
    shade(samples, depth == 0);
  }
  connect(samples);
}

void IntersectionTest::begin(const CameraPaths& paths, std::span<PixelSample> samples) {
  const PixelSample unseen{.alpha = scene_.settings.is_film_transparent ? 0.0f : 1.0f};
  std::fill(samples.begin(), samples.end(), unseen);
  recorder_.begin(samples.size());
  rays_ = paths.rays;
  paths_.clear();
  for (std::uint32_t i = 0; i < paths.size(); ++i) paths_.push_back({.sample = i, .sampler = paths.samplers[i]});
  shadow_rays_.clear();
  shadow_tests_.clear();
}

void IntersectionTest::extend() { find_hits(scene_.tracer, rays_, hits_); }

void IntersectionTest::shade(std::span<PixelSample> samples, bool is_camera_ray) {
  std::size_t kept = 0;
  points_.begin();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (i == points_.end()) find_points(i);
    Path& path = paths_[i];
    const Ray& ray = rays_[i];
    if (!hits_[i].is_hit()) {
      if (is_camera_ray) note_background(path.sample, ray, samples[path.sample]);
      continue;
    }
    const SurfacePoint& point = points_[i];
    PixelSample& sample = samples[path.sample];
    sample.alpha = 1;
    if (is_camera_ray) note_first_hit(path.sample, point, sample);

    const Vec3f wo = -ray.direction;
    const SurfaceShading shading = shade_at(
        scene_, point, wo, [&] { return shading_context(scene_, point, is_camera_ray ? ray_camera : ray_all); });
    if (!shading.bsdf.has_only_deltas()) {
      gather_light(path, ray, point, to_light_[i % SurfacePoints::at_once], shading.bsdf);
      continue;
    }
    const float choice = path.sampler.next_1d();
    const std::optional<BsdfSample> scattered = shading.bsdf.sample(wo, choice, path.sampler.next_2d());
    if (!scattered || scattered->kind == ScatterKind::subsurface) continue;
    path.throughput *= scattered->weight;
    rays_[kept] = spawn_ray(point, scattered->wi, ray_transmission, ray.time);
    paths_[kept++] = path;
  }
  paths_.resize(kept);
  rays_.resize(kept);
}

// The way to the light apart from all else: the roots and divisions of many points overlap.
void IntersectionTest::find_points(std::size_t first) {
  points_.find(scene_, rays_, hits_, first);
  for (std::size_t i = first; i < points_.end(); ++i) {
    if (!hits_[i].is_hit()) continue;
    const Vec3f to_light = scene_.settings.point_light_position - points_[i].position;
    const float distance = length(to_light), inverse_distance = 1 / distance;
    to_light_[i - first] = {to_light * inverse_distance, distance, inverse_distance};
  }
}

// radiance = f cos flux / (4 pi r^2), unless something is in the way.
void IntersectionTest::gather_light(const Path& path, const Ray& ray, const SurfacePoint& point,
                                    const ToLight& to_light, const Bsdf& bsdf) {
  const Color reflected = bsdf.eval(-ray.direction, to_light.wi).value;
  if (is_black(reflected)) return;
  const Color irradiance =
      scene_.settings.point_light_flux * (inv_pi / 4 * to_light.inverse_distance * to_light.inverse_distance);
  append_result(shadow_rays_, [&] { return spawn_shadow_ray(point, to_light.wi, to_light.distance, ray.time); });
  shadow_tests_.push_back({path.sample, path.throughput * reflected * irradiance});
}

void IntersectionTest::connect(std::span<PixelSample> samples) {
  for_each_unoccluded(scene_.tracer, shadow_rays_, shadow_tests_, occluded_,
                      [&](const ShadowTest& test) { samples[test.sample].radiance += test.radiance; });
}

}  // namespace basicrt
