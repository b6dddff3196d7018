// SPDX-License-Identifier: GPL-3.0-or-later
// Path tracing in three phases for a whole batch: extend, shade, connect.
#include "integrator/path.h"

#include <algorithm>

#include "base/append_result.h"
#include "integrator/batch.h"
#include "integrator/hit_shading.h"
#include "integrator/softening.h"
#include "scene/shade_lamp.h"

namespace basicrt {
namespace {

// By light that arrives along wi and leaves along wo.
bool is_crossed(const SurfacePoint& point, Vec3f wo, Vec3f wi) {
  return (dot(point.geometric_normal, wo) > 0) != (dot(point.geometric_normal, wi) > 0);
}

Ray up_to(Ray ray, const SurfacePoint& point) {
  ray.t_max = point.t;
  return ray;
}

}  // namespace

PathIntegrator::PathIntegrator(const PreparedScene& scene)
    : Integrator(scene),
      scene_(scene),
      probe_(scene),
      has_volumes_(scene.has_volumes),
      softens_caustics_(softens_caustics(scene.settings)) {}

void PathIntegrator::render(const CameraPaths& paths, std::span<PixelSample> samples) {
  begin(paths, samples);
  for (bool has_hits = is_baking_; !paths_.empty(); has_hits = false) {
    if (!has_hits) extend();
    shade(samples);
    connect(samples);
  }
}

void PathIntegrator::begin(const CameraPaths& paths, std::span<PixelSample> samples) {
  std::fill(samples.begin(), samples.end(), PixelSample{});
  recorder_.begin(samples.size());
  rays_ = paths.rays;
  paths_.clear();
  for (std::uint32_t i = 0; i < paths.size(); ++i)
    paths_.push_back({.sample = i, .media = i, .sampler = paths.samplers[i]});
  if (has_volumes_) find_camera_media();
  hits_ = paths.first_hits;
  is_baking_ = !hits_.empty();
  baked_parts_ = paths.parts;
}

void PathIntegrator::extend() { find_hits(scene_.tracer, rays_, hits_); }

void PathIntegrator::shade(std::span<PixelSample> samples) {
  shadow_rays_.clear();
  connections_.clear();
  shadow_media_.clear();
  linked_paths_.clear();
  linked_rays_.clear();
  recorder_.clear_filings();
  std::size_t kept = 0;
  points_.begin();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (i == points_.end()) points_.find(scene_, rays_, hits_, i);
    Path& path = paths_[i];
    Ray& ray = rays_[i];
    const Hit& hit = hits_[i];
    PixelSample& sample = samples[path.sample];
    if (is_in_media(path)) {
      const Passage passage = pass_media(path, ray, hit, points_[i], sample);
      if (passage == Passage::scattered) {
        rays_[kept] = ray;
        paths_[kept++] = path;
      }
      if (passage != Passage::passed) continue;
    }
    if (!hit.is_hit()) {
      gather_lamps(path, ray, sample);
      gather_distant_lamps(path, ray, sample);
      gather_environment(path, ray, sample);
      if (path.is_camera_ray) note_background(path.sample, ray, sample);
      continue;
    }

    const SurfacePoint& point = points_[i];
    gather_lamps(path, up_to(ray, point), sample);
    if (has_volumes_ && scene_.material_of(point).is_boundary) {
      cross_surface(media_[path.media], point);
      continue_behind(ray, hit, point);
      rays_[kept] = ray;
      paths_[kept++] = path;
      continue;
    }
    const bool is_first_hit = path.is_camera_ray && !sample.has_hit;
    if (is_first_hit) note_first_hit(path.sample, point, sample);

    SurfaceShading shading = shade_at(scene_, point, -ray.direction, [&] { return context_of(path, ray, point); });
    if (is_first_hit) note_first_surface(path, ray, point, shading.bsdf, sample);
    if (is_baking_ && path.is_camera_ray) keep_baked_parts(path, ray, shading, sample);
    if (path.shows_film) cut_out(path, ray, point, shading, sample);
    if (softens_caustics_) soften_caustics(scene_.settings, ray.kinds == ray_diffuse, path.least_pdf, shading.bsdf);
    if (path.is_camera_ray && scene_.instances[point.instance].is_shadow_catcher) {
      pass_catcher(path, ray, hit, point, shading.bsdf, sample);
      if (is_baking_) continue;
      rays_[kept] = ray;
      paths_[kept++] = path;
      continue;
    }
    if (recorder_.is_active()) record_surface(path, ray, point, shading);
    gather_emission(path, ray, point, shading.emission, sample);
    if (shading.bsdf.is_empty()) continue;
    if (!path.is_last) sample_lights(path, ray, point, shading.bsdf, sample);
    if (!scatter(path, ray, hit, point, shading.bsdf)) continue;
    rays_[kept] = ray;
    paths_[kept++] = path;
  }
  paths_.resize(kept);
  rays_.resize(kept);
  paths_.insert(paths_.end(), caught_paths_.begin(), caught_paths_.end());
  rays_.insert(rays_.end(), caught_rays_.begin(), caught_rays_.end());
  caught_paths_.clear();
  caught_rays_.clear();
  leave_bodies(samples);
}

ShadingContext PathIntegrator::context_of(const Path& path, const Ray& ray, const SurfacePoint& point) const {
  ShadingContext context = shading_context(scene_, point, ray.kinds);
  context.footprint += scene_.pixel_spread * path.length;
  context.is_singular_ray = path.is_specular && !path.is_camera_ray;
  context.is_translucent_ray = path.is_translucent;
  context.probe = &probe_;
  context.least_pdf = path.least_pdf;
  context.random_bits = path.sampler.fingerprint();
  set_bounces(context, path.bounces);
  return context;
}

ShadingContext PathIntegrator::shadow_context(const Connection& connection, const SurfacePoint& point) const {
  ShadingContext context = shading_context(scene_, point, ray_shadow);
  set_bounces(context, connection.bounces);
  ++context.bounces;
  --context.transparent_bounces;  // the surface itself is counted already
  return context;
}

void PathIntegrator::set_bounces(ShadingContext& context, const Bounces& bounces) {
  context.bounces = bounces.total;
  context.diffuse_bounces = bounces.diffuse;
  context.glossy_bounces = bounces.glossy;
  context.transmission_bounces = bounces.transmission;
  context.transparent_bounces = bounces.transparent;
}

Color& PathIntegrator::sum_of(Destination destination, PixelSample& sample) {
  switch (destination) {
    case Destination::behind_catcher:
      return sample.catcher.behind;
    case Destination::catcher_lit:
      return sample.catcher.lit;
    case Destination::catcher_unlit:
      return sample.catcher.unlit;
    case Destination::picture:
    case Destination::occlusion:
      break;
  }
  return sample.radiance;
}

void PathIntegrator::cut_hole(const Path& path, Color share, PixelSample& sample) {
  const float hole = average(path.throughput * share);
  if (path.destination == Destination::behind_catcher)
    sample.catcher.hole += hole;
  else
    sample.alpha -= hole;
}

// What catchers are compared by is not in the passes.
bool PathIntegrator::is_filed(const Path& path) const {
  return recorder_.records_light() &&
         (path.destination == Destination::picture || path.destination == Destination::behind_catcher);
}

void PathIntegrator::record_surface(const Path& path, const Ray& ray, const SurfacePoint& point,
                                    const SurfaceShading& shading) {
  if (path.destination != Destination::picture && path.destination != Destination::behind_catcher) return;
  const Bsdf& bsdf = shading.bsdf;
  if (path.is_camera_ray) {
    recorder_.record_seen(path.sample, -ray.direction, point, bsdf, path.throughput);
    if (recorder_.values().has(Pass::ambient_occlusion)) sample_occlusion(path, ray, point, bsdf);
  }
  if (!path.is_specular) return;
  recorder_.record_glow(path.sample, path.throughput * shading.emission);
  recorder_.record_features(path.sample, -ray.direction, point, bsdf, path.throughput);
}

// Light that the path ran into after its last scattering: direct light is what it finds after the first, or none.
void PathIntegrator::add_light(const Path& path, Color radiance, int light_group, PixelSample& sample,
                               bool is_environment) {
  const RenderSettings& settings = scene_.settings;
  const Color clamped = clamp_light(radiance, path.bounces.total > 1 ? settings.clamp_indirect : settings.clamp_direct);
  sum_of(path.destination, sample) += clamped;
  if (is_filed(path)) recorder_.add_found_light(path.sample, path.bounces.total, clamped, light_group, is_environment);
}

void PathIntegrator::add_connection(const Connection& connection, PixelSample& sample) {
  if (connection.destination == Destination::occlusion)
    return recorder_.record_openness(connection.sample, connection.radiance);
  const Color clamped = clamp_light(connection.radiance, connection.limit);
  sum_of(connection.destination, sample) += clamped;
  recorder_.add_sampled_light(connection.sample, connection.filing, clamped);
}

// Lamps do not block rays: each one between the ray's ends adds its light. pass_media() has seen to those in volumes.
void PathIntegrator::gather_lamps(const Path& path, const Ray& ray, PixelSample& sample) {
  if (is_in_media(path)) return;
  scene_.lights.for_each_lamp_hit(ray, path.start(ray),
                                  [&](const LightHit& hit) { gather_lamp(path, ray, hit, sample); });
}

// Those are behind everything, where a camera's clipping doesn't reach.
void PathIntegrator::gather_distant_lamps(const Path& path, const Ray& ray, PixelSample& sample) {
  scene_.lights.for_each_distant_hit(ray, path.start(ray),
                                     [&](const LightHit& hit) { gather_lamp(path, ray, hit, sample); });
}

// look_for_linked_lights() has seen to those that only some objects dim, but where the camera itself sees them.
void PathIntegrator::gather_lamp(const Path& path, const Ray& ray, const LightHit& hit, PixelSample& sample) {
  if (hit.shadow_kind == ray_shadow || path.is_camera_ray)
    add_light(path, path.throughput * radiance_of_lamp(path, ray, hit), hit.light_group, sample);
}

// Of which light samples find the rest. The counts are those of a light sample taken where the ray began; the camera's
// rays count as if they had been scattered.
Color PathIntegrator::radiance_of_lamp(const Path& path, const Ray& ray, const LightHit& hit) const {
  const float weight = path.is_specular ? 1 : power_heuristic(path.bsdf_pdf, hit.pdf);
  Color radiance = hit.radiance;
  if (hit.varying_lamp != Hit::none) {
    Ray seen = ray;
    seen.t_max = hit.t;
    radiance = with_emission(radiance, hit.varying_lamp, seen, path, std::max(path.bounces.total, 1));
  }
  return radiance * weight;
}

Color PathIntegrator::with_emission(Color radiance, std::uint32_t lamp, const Ray& ray, const Path& path,
                                    int depth) const {
  const LampView view{.lamp = scene_.lights.lamp(lamp),
                      .position = ray.origin,
                      .wi = normalize(ray.direction),
                      .distance = ray.t_max,
                      .time = ray.time};
  radiance *= lamp_emission(scene_, scene_.lamp_materials[lamp], view, [&](ShadingContext& context) {
    context.random_bits = path.sampler.fingerprint();
    set_bounces(context, path.bounces);
    context.bounces = depth;
  });
  return is_finite(radiance) ? radiance : Color(0.0f);
}

void PathIntegrator::gather_environment(const Path& path, const Ray& ray, PixelSample& sample) {
  const bool is_hole = path.shows_film && scene_.settings.is_film_transparent;
  if (is_hole) cut_hole(path, Color(1.0f), sample);
  if (is_hole && !is_filed(path)) return;
  const Color radiance = scene_.lights.environment_radiance(ray.direction, path.is_camera_ray);
  if (is_black(radiance)) return;
  if (path.is_specular) recorder_.record_glow(path.sample, path.throughput * radiance);
  const float weight =
      path.is_specular
          ? 1
          : power_heuristic(path.bsdf_pdf, scene_.lights.pdf_environment(ray.direction, path.receiver_set));
  if (is_hole)  // the pass Environment has what the picture and its groups have not
    recorder_.add_found_light(path.sample, path.bounces.total, path.throughput * radiance * weight, 0, true);
  else
    add_light(path, path.throughput * radiance * weight, scene_.lights.environment_light_group(), sample, true);
}

void PathIntegrator::gather_emission(const Path& path, const Ray& ray, const SurfacePoint& point, Color emission,
                                     PixelSample& sample) {
  if (is_black(emission)) return;
  const PreparedScene::PreparedInstance& instance = scene_.instances[point.instance];
  if (!instance.lit_sets.has(path.receiver_set)) return;
  if (instance.shadow_kind != ray_shadow && !path.is_camera_ray) return;  // look_for_linked_emitters() has seen to it
  add_light(path, path.throughput * emission * weight_of_emission(path, ray, point), instance.light_group, sample);
}

float PathIntegrator::weight_of_emission(const Path& path, const Ray& ray, const SurfacePoint& point) const {
  return path.is_specular ? 1 : power_heuristic(path.bsdf_pdf, scene_.lights.pdf_surface(point, path.start(ray)));
}

// Holdouts are holes, whether or not the film is transparent elsewhere.
void PathIntegrator::cut_out(const Path& path, const Ray& ray, const SurfacePoint& point, SurfaceShading& shading,
                             PixelSample& sample) const {
  Color hole(shading.holdout);
  if (scene_.instances[point.instance].is_holdout) {
    hole = Color(1.0f) - transparency_at(scene_, point, -ray.direction, context_of(path, ray, point));
    shading.emission = Color(0.0f);
    shading.bsdf.remove_opaque();
  }
  cut_hole(path, hole, sample);
}

void PathIntegrator::sample_lights(Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf,
                                   PixelSample& sample) {
  if (bsdf.has_only_deltas() || scene_.lights.is_empty()) return;
  const auto [choice, u] = path.sampler.next_choice();
  const int receiver_set = scene_.instances[point.instance].receiver_set;
  std::optional<LightSample> light =
      scene_.lights.sample({point.position, bsdf.lit_side(-ray.direction), receiver_set}, choice, u, ray.time);
  if (!light || path.bounces.total > light->max_bounces) return;
  look_up_emission(path, point.position, ray.time, *light);
  BsdfValue reflected = eval_towards(*light, point, -ray.direction, bsdf);
  reflected.value *= terminator_share(point, light->wi);
  const float weight = light->is_delta ? 1 : power_heuristic(light->pdf, reflected.pdf);
  Color radiance = path.throughput * reflected.value * light->radiance * (weight / light->pdf);
  if (is_black(radiance) || !survives_light_roulette(path, radiance)) return;
  const RenderSettings& settings = scene_.settings;
  const float most = path.bounces.total > 0 ? settings.clamp_indirect : settings.clamp_direct;
  const std::uint32_t filing =
      is_filed(path) ? recorder_.file(path.sample, path.bounces.total, light->light_group,
                                      [&] { return light_shares(bsdf, -ray.direction, light->wi, light->kinds); })
                     : PassRecorder::unfiled;
  const Connection connection{path.sample, radiance, path.bounces, most, path.destination, filing};
  if (!light->casts_shadows) return add_connection(connection, sample);
  append_result(shadow_rays_, [&] { return spawn_shadow_ray(scene_, point, light->wi, light->distance, ray.time); });
  shadow_rays_.back().kinds = path.destination == Destination::catcher_unlit ? ray_catcher : light->shadow_kind;
  if (has_volumes_) {
    shadow_media_.push_back(media_[path.media]);
    if (is_crossed(point, -ray.direction, light->wi)) cross_surface(shadow_media_.back(), point);
  }
  connections_.push_back(connection);
}

// As the material of what shines sees it that is nobody's ray: none of Blender's kinds.
void PathIntegrator::look_up_emission(const Path& path, Vec3f position, float time, LightSample& light) const {
  const Ray ray{.origin = position, .direction = light.wi, .t_max = light.distance, .time = time};
  if (light.varying_lamp != Hit::none)
    light.radiance = with_emission(light.radiance, light.varying_lamp, ray, path, path.bounces.total + 1);
  if (light.emitter_instance == Hit::none) return;
  const Hit hit{.t = light.distance, .instance = light.emitter_instance, .primitive = light.emitter_primitive};
  const SurfacePoint place = surface_point_at(scene_, ray, hit);
  light.radiance *= shade_at(scene_, place, -light.wi, [&] {
                      ShadingContext context = shading_context(scene_, place, 0);
                      context.random_bits = path.sampler.fingerprint();
                      set_bounces(context, path.bounces);
                      ++context.bounces;
                      return context;
                    }).emission;
}

// What the object's shading offset leaves of light that is reflected from a direction.
float PathIntegrator::terminator_share(const SurfacePoint& point, Vec3f wi) const {
  const float offset = scene_.instances[point.instance].shadow_terminator_shading_offset;
  return offset > 0 ? offset_share(point, wi, offset) : 1;
}

// What the surface scatters of the light, of the kinds that the lamp lights.
BsdfValue PathIntegrator::eval_towards(const LightSample& light, const SurfacePoint& point, Vec3f wo,
                                       const Bsdf& bsdf) const {
  constexpr std::uint32_t surface_kinds = ray_diffuse | ray_glossy | ray_transmission;
  if ((light.kinds & surface_kinds) != surface_kinds) return bsdf.eval_kinds(wo, light.wi, light.kinds);
  const bool is_smoothed = scene_.instances[point.instance].shadow_terminator_offset > 0;
  return is_smoothed ? bsdf.eval_smooth(wo, light.wi) : bsdf.eval(wo, light.wi);
}

// Two paths leave a shadow catcher, with the same random numbers: one among all objects, one among catchers alone. The
// path itself goes on behind it.
void PathIntegrator::pass_catcher(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point, const Bsdf& bsdf,
                                  PixelSample& sample) {
  for (const Destination destination : {Destination::catcher_lit, Destination::catcher_unlit}) {
    Path caught = path;
    Ray caught_ray = ray;
    caught.destination = destination;
    caught.shows_film = caught.is_camera_ray = false;
    if (has_volumes_) {
      caught.media = static_cast<std::uint32_t>(media_.size());
      media_.push_back(MediaStack(media_[path.media]));
    }
    sample_lights(caught, ray, point, bsdf, sample);
    if (!scatter(caught, caught_ray, hit, point, bsdf)) continue;
    caught_paths_.push_back(caught);
    caught_rays_.push_back(caught_ray);
  }
  path.destination = Destination::behind_catcher;
  count_bounce(path, ScatterKind::transparent);
  if (has_volumes_) cross_surface(media_[path.media], point);
  continue_behind(ray, hit, point);
}

// Light that is to go about beneath the surface: leave_bodies() takes it from there.
void PathIntegrator::enter_body(const Path& path, const Ray& ray, const SurfacePoint& point, const BsdfSample& entering,
                                bool is_turned) {
  walks_.emplace_back(*entering.subsurface, point, entering.normal, entering.wi, ray.time, path.throughput,
                      path.sampler);
  walking_paths_.push_back({path, is_turned});
}

// Where light comes out of a body it is lit and scattered as by a white diffuse surface.
void PathIntegrator::leave_bodies(std::span<PixelSample> samples) {
  if (walks_.empty()) return;
  walkers_.run(scene_, walks_);
  for (std::size_t i = 0; i < walks_.size(); ++i) {
    const SubsurfaceWalk& walk = walks_[i];
    if (walk.state() != SubsurfaceWalk::State::out) continue;
    Path& path = walking_paths_[i].path;
    path.throughput = walk.throughput();
    path.sampler = walk.sampler();
    SurfacePoint point = surface_point_at(scene_, walk.ray(), walk.exit());
    point.is_backfacing = !point.is_backfacing;
    Ray ray = walk.ray();
    ray.direction = -ray.direction;  // as if it had come from outside
    Bsdf bsdf(make_frame(point.shading_normal), point.geometric_normal);
    if (walking_paths_[i].is_turned)
      bsdf.use_normal(shade_at(scene_, point, -ray.direction, [&] {
                        return context_of(path, ray, point);
                      }).bsdf.subsurface_normal());
    bsdf.add(Lambert{}, Color(1.0f));
    sample_lights(path, ray, point, bsdf, samples[path.sample]);
    if (!scatter(path, ray, walk.exit(), point, bsdf)) continue;
    paths_.push_back(path);
    rays_.push_back(ray);
  }
  walks_.clear();
  walking_paths_.clear();
}

// Sends the path on in a sampled direction. False where it ends, or goes on beneath the surface.
bool PathIntegrator::scatter(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point, const Bsdf& bsdf) {
  const auto [choice, u] = path.sampler.next_choice();
  const std::optional<BsdfSample> scattered = bsdf.sample(-ray.direction, choice, u);
  const bool is_passed = scattered && scattered->kind == ScatterKind::transparent && !path.ends_at_panes;
  if (!scattered || (path.is_last && !is_passed)) return false;
  path.throughput *= scattered->weight * terminator_share(point, scattered->wi);
  if (is_black(path.throughput)) return false;
  if (scattered->kind == ScatterKind::subsurface) {
    enter_body(path, ray, point, *scattered, bsdf.is_turned());
    return false;
  }
  if (path.bounces.total == 0 && scattered->kind != ScatterKind::transparent && is_filed(path))
    recorder_.note_scattering(path.sample, bsdf, -ray.direction, *scattered);
  count_bounce(path, scattered->kind);

  if (has_volumes_ && is_crossed(point, -ray.direction, scattered->wi)) cross_surface(media_[path.media], point);
  if (scattered->kind == ScatterKind::transparent) {
    continue_behind(ray, hit, point);
    return true;
  }
  path.lit_side = bsdf.lit_side(-ray.direction);
  path.receiver_set = scene_.instances[point.instance].receiver_set;
  const bool is_unlit = path.destination == Destination::catcher_unlit;
  ray = spawn_ray(point, scattered->wi, is_unlit ? std::uint32_t{ray_catcher} : ray_kind(scattered->kind), ray.time);
  path.bsdf_pdf = scattered->pdf;
  path.is_specular = scattered->is_delta;
  path.is_camera_ray = false;
  path.is_translucent = scattered->is_translucent;
  path.length += point.t;
  path.shows_film = path.shows_film && scattered->kind == ScatterKind::transmission &&
                    scene_.settings.is_glass_transparent &&
                    bsdf.transmission_alpha() <= scene_.settings.transparent_glass_roughness;
  if (!scattered->is_delta) path.least_pdf = std::min(path.least_pdf, scattered->pdf);
  if (!survives_roulette(path)) return false;
  if (has_links()) look_for_linked_lights(path, ray);
  return true;
}

// Blender counts one scattering more than its limits say, and after the last one still gathers what the next surface
// emits. Behind the last transparent surface that is all, too.
void PathIntegrator::count_bounce(Path& path, ScatterKind kind) const {
  const RenderSettings& settings = scene_.settings;
  Bounces& bounces = path.bounces;
  if (kind == ScatterKind::transparent) {
    if (++bounces.transparent >= settings.transparent_bounces) path.is_last = path.ends_at_panes = true;
    return;
  }
  const bool is_over = [&] {
    switch (kind) {
      case ScatterKind::diffuse:
        return ++bounces.diffuse > settings.diffuse_bounces;
      case ScatterKind::glossy:
        return ++bounces.glossy > settings.glossy_bounces;
      case ScatterKind::volume:
        return ++bounces.volume > settings.volume_bounces;
      default:
        return ++bounces.transmission > settings.transmission_bounces;
    }
  }();
  path.is_last = ++bounces.total > settings.max_bounces || is_over;
}

// Unbiased: what survives with probability p counts 1/p.
bool PathIntegrator::survives_roulette(Path& path) const {
  constexpr int free_bounces = 2;  // early bounces carry most of the light
  if (path.bounces.total <= free_bounces) return true;
  const float importance = max_component(path.throughput);
  if (importance >= scene_.settings.roulette_threshold) return true;
  const float survival = importance / scene_.settings.roulette_threshold;
  if (path.sampler.next_1d() >= survival) return false;
  path.throughput *= 1 / survival;
  return true;
}

// Unbiased in the same way. Shadow rays cost most of all: few are spent on what adds next to nothing.
bool PathIntegrator::survives_light_roulette(Path& path, Color& radiance) const {
  const float threshold = scene_.settings.light_threshold, importance = max_component(radiance);
  if (importance >= threshold) return true;
  const float survival = importance / threshold;
  if (path.sampler.next_1d() >= survival) return false;
  radiance *= 1 / survival;
  return true;
}

void PathIntegrator::connect(std::span<PixelSample> samples) {
  if (scene_.has_linked_emitters) look_for_linked_emitters();
  if (has_volumes_) return connect_through_media(samples);
  if (scene_.has_transparency) return connect_through_transparency(samples);
  for_each_unoccluded(scene_.tracer, shadow_rays_, connections_, occluded_,
                      [&](const Connection& connection) { add_connection(connection, samples[connection.sample]); });
}

// Advances all shadow rays together from surface to surface, dimmed by each, until they arrive or are black.
void PathIntegrator::connect_through_transparency(std::span<PixelSample> samples) {
  while (!shadow_rays_.empty()) {
    hits_.resize(shadow_rays_.size());
    scene_.tracer.intersect(shadow_rays_, hits_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shadow_rays_.size(); ++i) {
      Ray ray = shadow_rays_[i];
      Connection connection = connections_[i];
      if (!hits_[i].is_hit()) {
        add_connection(connection, samples[connection.sample]);
        continue;
      }
      if (++connection.bounces.transparent > scene_.settings.transparent_bounces) continue;
      const SurfacePoint point = surface_point_at(scene_, ray, hits_[i]);
      connection.radiance *= transparency_at(scene_, point, -ray.direction, shadow_context(connection, point));
      if (is_black(connection.radiance)) continue;
      continue_behind(ray, hits_[i], point);
      shadow_rays_[kept] = ray;
      connections_[kept] = connection;
      ++kept;
    }
    shadow_rays_.resize(kept);
    connections_.resize(kept);
  }
}

}  // namespace basicrt
