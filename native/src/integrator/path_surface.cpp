// SPDX-License-Identifier: GPL-3.0-or-later
// What is done with the surface that a path begins on: for passes, and for baking.
#include "integrator/path.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/warp.h"

namespace basicrt {

// Another direction that the surface is seen from would be the same to it: what is transparent is a hole.
void PathIntegrator::keep_baked_parts(const Path& path, const Ray& ray, SurfaceShading& shading,
                                      PixelSample& sample) const {
  cut_hole(path, shading.bsdf.albedo(-ray.direction, ScatterKind::transparent), sample);
  shading.bsdf.keep_kinds(baked_parts_.kinds);
  if (!baked_parts_.has_emission) shading.emission = Color(0.0f);
}

void PathIntegrator::note_first_surface(const Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf,
                                        PixelSample& sample) {
  if (bsdf.is_turned()) sample.normal = bsdf.mean_normal() * (point.is_backfacing ? -1.0f : 1.0f);
  if (recorder_.values().has(Pass::roughness)) recorder_.record_roughness(path.sample, bsdf.mean_roughness());
  if (recorder_.records_aovs())
    for_each_aov(scene_.material_of(point), scene_.textures, point, -ray.direction, context_of(path, ray, point),
                 [&](const AovShader& aov) { recorder_.record_aov(path.sample, aov); });
}

// The numbers drawn are those that the path itself draws next: its picture is the same without this pass.
void PathIntegrator::sample_occlusion(const Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf) {
  const Color share = path.throughput * (Color(1.0f) - bsdf.albedo(-ray.direction, ScatterKind::transparent));
  if (is_black(share)) return;
  Sampler sampler = path.sampler;
  const Frame frame = make_frame(bsdf.mean_normal(ScatterKind::diffuse) * (point.is_backfacing ? -1.0f : 1.0f));
  const Vec3f wi = frame.to_world(sample_cosine_hemisphere(sampler.next_2d()));
  const float most = scene_.settings.ao_distance;
  shadow_rays_.push_back(spawn_shadow_ray(scene_, point, wi, most > 0 ? most : infinity, ray.time));
  if (has_volumes_) shadow_media_.push_back(media_[path.media]);
  connections_.push_back({path.sample, share, path.bounces, 0, Destination::occlusion, PassRecorder::unfiled});
}

}  // namespace basicrt
