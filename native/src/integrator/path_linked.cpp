// SPDX-License-Identifier: GPL-3.0-or-later
// The path tracer and lights that only some objects dim. Where a path's own ray ends says nothing of them: whenever it is
// scattered, a shadow ray of the light's own kind finds out whether it would have run into such a light.
#include "integrator/path.h"

namespace basicrt {

void PathIntegrator::look_for_linked_lights(const Path& path, const Ray& ray) {
  scene_.lights.for_each_linked_hit(ray, path.start(ray), [&](const LightHit& hit) {
    add_linked_connection(path, ray, hit.t, path.throughput * radiance_of_lamp(path, ray, hit), hit.light_group,
                          hit.shadow_kind);
  });
  if (!scene_.has_linked_emitters) return;
  linked_paths_.push_back(path);
  linked_rays_.push_back(ray);
}

// All surfaces of that kind on the way, one after another.
void PathIntegrator::look_for_linked_emitters() {
  std::vector<Ray> probes = linked_rays_;
  for (Ray& probe : probes) probe.kinds = ray_linked_emitter;
  while (!probes.empty()) {
    hits_.resize(probes.size());
    scene_.tracer.intersect(probes, hits_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      if (!hits_[i].is_hit()) continue;
      const SurfacePoint point = surface_point_at(scene_, probes[i], hits_[i]);
      meet_linked_emitter(linked_paths_[i], linked_rays_[i], point);
      continue_behind(probes[i], hits_[i], point);
      probes[kept] = probes[i];
      linked_rays_[kept] = linked_rays_[i];
      linked_paths_[kept++] = linked_paths_[i];
    }
    probes.resize(kept);
  }
}

void PathIntegrator::meet_linked_emitter(const Path& path, const Ray& ray, const SurfacePoint& point) {
  const PreparedScene::PreparedInstance& instance = scene_.instances[point.instance];
  if ((instance.visibility & ray.kinds) == 0 || !instance.lit_sets.has(path.receiver_set)) return;
  const Color emission = shade_at(scene_, point, -ray.direction, [&] { return context_of(path, ray, point); }).emission;
  add_linked_connection(path, ray, point.t, path.throughput * emission * weight_of_emission(path, ray, point),
                        instance.light_group, instance.shadow_kind);
}

void PathIntegrator::add_linked_connection(const Path& path, const Ray& ray, float distance, Color radiance,
                                           int light_group, std::uint32_t shadow_kind) {
  if (is_black(radiance)) return;
  Ray shadow_ray = ray;
  shadow_ray.kinds = path.destination == Destination::catcher_unlit ? std::uint32_t{ray_catcher} : shadow_kind;
  shadow_ray.t_max = distance * shadow_ray_share;
  const RenderSettings& settings = scene_.settings;
  const float most = path.bounces.total > 1 ? settings.clamp_indirect : settings.clamp_direct;
  const std::uint32_t filing =
      is_filed(path) ? recorder_.file_found(path.sample, path.bounces.total, light_group) : PassRecorder::unfiled;
  Bounces before = path.bounces;  // the ray is one of them
  --before.total;
  shadow_rays_.push_back(shadow_ray);
  if (has_volumes_) shadow_media_.push_back(media_[path.media]);
  connections_.push_back({path.sample, radiance, before, most, path.destination, filing});
}

}  // namespace basicrt
