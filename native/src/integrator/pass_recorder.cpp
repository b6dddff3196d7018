// SPDX-License-Identifier: GPL-3.0-or-later
// Files what paths see.
#include "integrator/pass_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "geometry/motion.h"

namespace basicrt {
namespace {

constexpr std::array light_passes = {Pass::diffuse_direct,  Pass::diffuse_indirect,    Pass::glossy_direct,
                                     Pass::glossy_indirect, Pass::transmission_direct, Pass::transmission_indirect,
                                     Pass::volume_direct,   Pass::volume_indirect,     Pass::emission,
                                     Pass::environment};

bool has_aov(const PassValues& values) {
  for (int number = 1; number <= aovs; ++number)
    if (values.has(aov_color_pass(number)) || values.has(aov_value_pass(number))) return true;
  return false;
}

bool has_light_group(const PassValues& values) {
  for (int group = 1; group <= light_groups; ++group)
    if (values.has(light_group_pass(group))) return true;
  return false;
}

const Mesh* mesh_of(const PreparedScene& scene, const SurfacePoint& point) {
  return std::get_if<Mesh>(&scene.shapes[scene.instances[point.instance].shape]);
}

CameraView view_at(const PreparedScene& scene, float time) {
  return scene.moving_camera.is_moving() ? scene.moving_camera.at(time) : scene.view;
}

// Where a point of a surface is one frame before (0) or after (1).
Vec3f adjacent_position(const PreparedScene& scene, const SurfacePoint& point, std::size_t frame) {
  const PreparedScene::PreparedInstance& instance = scene.instances[point.instance];
  const Mesh* mesh = mesh_of(scene, point);
  const bool deforms = mesh != nullptr && !mesh->adjacent_positions.empty();
  if (!deforms && instance.adjacent.empty()) return point.position;
  const TransformD now =
      instance.motion.empty() ? instance.placement.object_to_world : transform_at(instance.motion, point.time);
  Vec3d local;
  if (deforms) {
    const std::vector<Vec3f>& positions = mesh->adjacent_positions[frame];
    const std::array<std::uint32_t, 3>& corners = mesh->triangles[point.primitive];
    const double u = point.barycentrics.x, v = point.barycentrics.y;
    local = Vec3d(positions[corners[0]]) * (1 - u - v) + Vec3d(positions[corners[1]]) * u +
            Vec3d(positions[corners[2]]) * v;
  } else {
    local = inverse(now).point(Vec3d(point.position));
  }
  return Vec3f((instance.adjacent.empty() ? now : instance.adjacent[frame]).point(local));
}

// From one place on the film to another, in pixels; none where one of them is nowhere.
Vec2f film_way(std::optional<Vec2f> from, std::optional<Vec2f> to, float period) {
  if (!from || !to) return {0, 0};
  Vec2f way = *to - *from;
  if (!std::isfinite(way.x) || !std::isfinite(way.y)) return {0, 0};
  if (period > 0) way.x -= period * std::round(way.x / period);  // the shorter way around
  return way;
}

// How much there is to be seen of what is so far away, for all that is in between.
float clearness(const RenderSettings& settings, float distance) {
  const float share = settings.mist_depth > 0 ? (distance - settings.mist_start) / settings.mist_depth
                                              : static_cast<float>(distance >= settings.mist_start);
  return 1 - std::pow(std::clamp(share, 0.0f, 1.0f), settings.mist_falloff);
}

}  // namespace

LightShares light_shares(ScatterKind kind) {
  LightShares shares;
  Color& share = kind == ScatterKind::diffuse  ? shares.diffuse
                 : kind == ScatterKind::glossy ? shares.glossy
                 : kind == ScatterKind::volume ? shares.volume
                                               : shares.transmission;
  share = Color(1.0f);
  return shares;
}

LightShares light_shares(const Bsdf& bsdf, Vec3f wo, Vec3f wi, std::uint32_t kinds) {
  const Color diffuse = bsdf.eval_kinds(wo, wi, kinds & ray_diffuse).value;
  const Color glossy = bsdf.eval_kinds(wo, wi, kinds & ray_glossy).value;
  const Color all = diffuse + glossy + bsdf.eval_kinds(wo, wi, kinds & ray_transmission).value;
  LightShares shares;
  for (std::size_t i = 0; i < 3; ++i) {
    // Light on what only the smooth surface turns towards it is diffuse, for want of anything better.
    shares.diffuse[i] = all[i] > 0 ? diffuse[i] / all[i] : 1;
    shares.glossy[i] = all[i] > 0 ? glossy[i] / all[i] : 0;
    shares.transmission[i] = 1 - shares.diffuse[i] - shares.glossy[i];
  }
  return shares;
}

PassRecorder::PassRecorder(const PreparedScene& scene)
    : scene_(scene),
      values_(scene.settings.passes),
      has_mattes_(scene.settings.passes.has(PassRule::matte)),
      is_active_(has_mattes_ || !recorded_passes(scene.settings.passes).is_empty()),
      records_light_(std::ranges::any_of(light_passes, [&](Pass pass) { return values_.has(pass); }) ||
                     has_light_group(values_)),
      records_aovs_(has_aov(values_)) {}

void PassRecorder::begin(std::size_t samples) {
  if (!is_active_) return;
  values_.begin(samples);
  has_features_.assign(samples, 0);
  if (records_light_) shares_.assign(samples, {});
}

// As Cycles has it: from here to where it was, and from where it will be to here. `film_place` is that of what is seen, to
// a view: one frame before (0), now (nothing) or one frame after (1).
template <class FilmPlace>
void PassRecorder::record_motion(std::uint32_t sample, float time, FilmPlace&& film_place) {
  const CameraView now = view_at(scene_, time);
  const std::optional<Vec2f> here = film_place(now, std::nullopt);
  const auto way = [&](std::size_t frame) {
    const CameraView& view = scene_.adjacent_views.empty() ? now : scene_.adjacent_views[frame];
    return film_way(here, film_place(view, std::optional(frame)), now.period());
  };
  const Vec2f before = way(0), after = way(1);
  values_.add_one_of_some(sample, Pass::vector, {before.x, before.y, -after.x, -after.y});
}

void PassRecorder::record_first_hit(std::uint32_t sample, const SurfacePoint& point) {
  const PreparedScene::PreparedInstance& instance = scene_.instances[point.instance];
  values_.add(sample, Pass::position, point.position);
  values_.add(sample, Pass::object_index, static_cast<float>(instance.pass_index));
  values_.add(sample, Pass::material_index, static_cast<float>(scene_.material_of(point).material.pass_index));
  if (values_.has(Pass::vector))
    record_motion(sample, point.time, [&](const CameraView& view, std::optional<std::size_t> frame) {
      return view.pixel_of(frame ? adjacent_position(scene_, point, *frame) : point.position);
    });
  const Mesh* mesh = mesh_of(scene_, point);
  if (mesh == nullptr || !mesh->uvs.empty()) values_.add(sample, Pass::uv, Vec3f{point.uv.x, point.uv.y, 1});
}

void PassRecorder::record_background(std::uint32_t sample, const Ray& ray) {
  if (!values_.has(Pass::vector) || !scene_.settings.has_background_vectors) return;
  record_motion(sample, ray.time, [&](const CameraView& view, std::optional<std::size_t>) {
    return view.pixel_of_direction(ray.direction);
  });
}

void PassRecorder::record_seen(std::uint32_t sample, Vec3f wo, const SurfacePoint& point, const Bsdf& bsdf,
                               Color throughput) {
  for (const auto& [pass, kind] :
       {std::pair(Pass::diffuse_color, ScatterKind::diffuse), std::pair(Pass::glossy_color, ScatterKind::glossy),
        std::pair(Pass::transmission_color, ScatterKind::transmission)})
    if (values_.has(pass)) values_.add(sample, pass, throughput * bsdf.albedo(wo, kind));
  if (values_.has(Pass::denoising_specular_albedo) || values_.has(Pass::denoising_roughness)) {
    const Specularity specularity = bsdf.specularity(wo);
    values_.add(sample, Pass::denoising_specular_albedo, throughput * specularity.albedo);
    values_.add(sample, Pass::denoising_roughness, average(throughput) * specularity.roughness);
  }
  if (!has_mattes_ && !values_.has(Pass::mist)) return;
  const float coverage = average(throughput * (Color(1.0f) - bsdf.albedo(wo, ScatterKind::transparent)));
  if (values_.has(Pass::mist)) {
    const float distance = view_at(scene_, point.time).distance(point.position);
    values_.add(sample, Pass::mist, coverage * clearness(scene_.settings, distance));
  }
  if (!has_mattes_ || !(coverage > 0)) return;
  const PreparedScene::PreparedInstance& instance = scene_.instances[point.instance];
  values_.add(
      MatteSample{sample, {instance.object_id, scene_.material_of(point).matte_id, instance.asset_id}, coverage});
}

void PassRecorder::record_features(std::uint32_t sample, Vec3f wo, const SurfacePoint& point, const Bsdf& bsdf,
                                   Color throughput) {
  if (has_features_[sample] || bsdf.is_empty()) return;
  if (bsdf.has_only_deltas() && !bsdf.has_subsurface()) return;
  has_features_[sample] = 1;
  if (values_.has(Pass::denoising_albedo)) {
    Color albedo(0.0f);
    for (const ScatterKind kind : {ScatterKind::diffuse, ScatterKind::glossy, ScatterKind::transmission})
      albedo += bsdf.albedo(wo, kind);
    values_.add(sample, Pass::denoising_albedo, throughput * albedo);
  }
  if (values_.has(Pass::denoising_normal)) {
    const Vec3f normal = point.is_backfacing ? -point.shading_normal : point.shading_normal;
    values_.add(sample, Pass::denoising_normal, view_at(scene_, point.time).to_camera(normal));
  }
  values_.add(sample, Pass::denoising_depth, point.t);
}

void PassRecorder::note_scattering(std::uint32_t sample, const Bsdf& bsdf, Vec3f wo, const BsdfSample& scattered) {
  if (!records_light_) return;
  shares_[sample] = scattered.is_delta ? light_shares(scattered.kind) : light_shares(bsdf, wo, scattered.wi);
}

void PassRecorder::note_volume_scattering(std::uint32_t sample) {
  if (records_light_) shares_[sample] = light_shares(ScatterKind::volume);
}

void PassRecorder::add_found_light(std::uint32_t sample, int scatterings, Color radiance, int light_group,
                                   bool is_environment) {
  if (scatterings > 0) return add(sample, {shares_[sample], scatterings == 1, light_group}, radiance);
  values_.add(sample, is_environment ? Pass::environment : Pass::emission, radiance * scene_.settings.exposure);
  add_to_group(sample, light_group, radiance * scene_.settings.exposure);
}

void PassRecorder::add_to_group(std::uint32_t sample, int light_group, Color radiance) {
  if (light_group > 0) values_.add(sample, light_group_pass(light_group), radiance);
}

void PassRecorder::add_sampled_light(std::uint32_t sample, std::uint32_t filing, Color radiance) {
  if (filing != unfiled) add(sample, filings_[filing], radiance);
}

void PassRecorder::add(std::uint32_t sample, const Filing& filing, Color radiance) {
  radiance *= scene_.settings.exposure;
  add_to_group(sample, filing.light_group, radiance);
  const auto add_share = [&](Pass direct, Pass indirect, Color share) {
    values_.add(sample, filing.is_direct ? direct : indirect, radiance * share);
  };
  add_share(Pass::diffuse_direct, Pass::diffuse_indirect, filing.shares.diffuse);
  add_share(Pass::glossy_direct, Pass::glossy_indirect, filing.shares.glossy);
  add_share(Pass::transmission_direct, Pass::transmission_indirect, filing.shares.transmission);
  add_share(Pass::volume_direct, Pass::volume_indirect, filing.shares.volume);
}

}  // namespace basicrt
