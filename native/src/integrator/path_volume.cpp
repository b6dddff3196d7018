// SPDX-License-Identifier: GPL-3.0-or-later
// The path tracer in volumes. What a ray meets on its way through one:
//
//   - lamps, and the volume's own emission, dimmed in closed form;
//   - light that lamps send to some place on the ray, and that is scattered there towards the path: one light sample for
//     each ray, of a light chosen first, at a place chosen by collisions and by the angle under which it sees the ray;
//   - by chance, a collision there and then, from which the path goes on in another direction.
//
// Light samples and scattered paths are combined by multiple importance sampling over directions, as on surfaces.
#include <algorithm>
#include <array>

#include "integrator/hit_shading.h"
#include "integrator/path.h"
#include "integrator/segment_sampling.h"
#include "integrator/softening.h"
#include "math/frame.h"

namespace basicrt {
namespace {

// Straight up, nearly, so as not to go along the edges and the diagonals of what people model.
const Vec3f probe_direction = normalize(Vec3f{0.1117f, 0.0729f, 1.0f});

bool contains(const Bounds3f& bounds, Vec3f p) {
  return p.x >= bounds.lower.x && p.y >= bounds.lower.y && p.z >= bounds.lower.z && p.x <= bounds.upper.x &&
         p.y <= bounds.upper.y && p.z <= bounds.upper.z;
}

// A ray that counts what it leaves, to know what its origin is in.
struct Probe {
  // How often the ray left an instance, less how often it entered: above 0 where the origin is inside.
  struct Count {
    std::uint32_t instance;
    const Medium* medium;
    int leaves;
  };
  std::uint32_t path;
  Ray ray;
  std::vector<Count> counts{};

  void count(const SurfacePoint& point, const Medium& medium) {
    const int leaves = point.is_backfacing ? 1 : -1;
    for (Count& known : counts) {
      if (known.instance != point.instance) continue;
      known.leaves += leaves;
      return;
    }
    counts.push_back({point.instance, &medium, leaves});
  }
};

// Sends all probes on, from surface to surface, until none meets any.
void trace_probes(const PreparedScene& scene, std::span<Probe> probes) {
  std::vector<std::uint32_t> active(probes.size());
  for (std::uint32_t i = 0; i < active.size(); ++i) active[i] = i;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  while (!active.empty()) {
    rays.clear();
    for (const std::uint32_t i : active) rays.push_back(probes[i].ray);
    hits.resize(rays.size());
    scene.tracer.intersect(rays, hits);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i].is_hit()) continue;
      Probe& probe = probes[active[i]];
      const SurfacePoint point = surface_point_at(scene, probe.ray, hits[i]);
      if (const Medium* medium = scene.medium_of(point)) probe.count(point, *medium);
      continue_behind(probe.ray, hits[i], point);
      active[kept++] = active[i];
    }
    active.resize(kept);
  }
}

// The particles of all volumes that a point is in, as seen along a ray: what surfaces' Bsdf is to them. As in Cycles all
// colours turn alike: kinds of particles count by the means of what they scatter.
class PhaseMixture {
 public:
  PhaseMixture(const MediaStack& media, Vec3f direction) : media_(media), direction_(direction) {
    media_.for_each_scatterer([&](const Scatterer& scatterer) {
      scattering_ += scatterer.scattering;
      total_ += average(scatterer.scattering);
    });
  }

  // The value is times the scattering coefficient.
  [[nodiscard]] BsdfValue eval(Vec3f wi) const {
    float pdf = 0;
    const float cos_theta = std::clamp(dot(direction_, wi), -1.0f, 1.0f);
    media_.for_each_scatterer([&](const Scatterer& scatterer) {
      pdf += average(scatterer.scattering) / total_ * eval_phase(scatterer.phase, cos_theta);
    });
    return {scattering_ * pdf, pdf};
  }
  [[nodiscard]] Vec3f sample(float choice, Vec2f u) const {
    const Scatterer* picked = nullptr;
    float rest = choice * total_;
    media_.for_each_scatterer([&](const Scatterer& scatterer) {
      if (picked == nullptr || rest >= 0) picked = &scatterer;
      rest -= average(scatterer.scattering);
    });
    const float cos_theta = sample_phase(picked->phase, u.x), phi = 2 * pi * u.y;
    const float sin_theta = std::sqrt(std::max(1 - cos_theta * cos_theta, 0.0f));
    return make_frame(direction_).to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
  }

 private:
  const MediaStack& media_;
  Vec3f direction_;
  Color scattering_{0.0f};
  float total_ = 0;
};

// Where on a ray light is scattered towards its origin, with the density of looking there.
struct ScatteringPlace {
  float distance, pdf;
};

// By collisions, and by the angle under which a light is seen. Of several places of both kinds, spread evenly, one is kept
// in proportion to the product of both densities over their mean (Talbot, Cline and Egbert 2005, "Importance Resampling for
// Global Illumination"), and to what a beam leaves there: where the light is strong and still gets back to the ray's origin.
ScatteringPlace pick_place(const PreparedScene& scene, Sampler& sampler, const Ray& ray, const LightSet::Choice& light,
                           const TruncatedCollisionSampling& collisions, float length) {
  const Vec2f u = sampler.next_2d();
  std::optional<EquiangularSampling> angles;
  if (const std::optional<LightExtent> extent = scene.lights.extent(light))
    angles = EquiangularSampling::make(extent->center - ray.at(ray.t_min), extent->radius, ray.direction, length);
  if (!angles) {
    const float distance = collisions.sample(u.x, u.y);
    return {distance, collisions.pdf(distance)};
  }

  constexpr int of_each_kind = 4;
  std::array<ScatteringPlace, 2 * of_each_kind> places;  // with what each is kept by, in place of a density
  float sum = 0;
  for (int i = 0; i < 2 * of_each_kind; ++i) {
    const float shifted = u.y + static_cast<float>(i / 2) / of_each_kind;
    const float number = std::min(shifted < 1 ? shifted : shifted - 1, one_minus_epsilon);
    const float distance = i % 2 == 0 ? collisions.sample(u.x, number) : angles->sample(number);
    const float by_collision = collisions.pdf(distance), by_angle = angles->pdf(distance);
    const float beam = scene.lights.beam(light, ray.at(ray.t_min + distance));
    places[i] = {distance, 2 * by_collision * by_angle * beam / (by_collision + by_angle)};
    sum += places[i].pdf;
  }
  float rest = sampler.next_1d() * sum;
  std::size_t kept = 0;
  while (kept + 1 < places.size() && rest >= places[kept].pdf) rest -= places[kept++].pdf;
  const float distance = places[kept].distance;
  const float beam = scene.lights.beam(light, ray.at(ray.t_min + distance));
  return {distance, collisions.pdf(distance) * angles->pdf(distance) * beam * places.size() / sum};
}

// From a place in a volume.
Ray spawn_volume_ray(Vec3f origin, Vec3f direction, std::uint32_t kinds, float time) {
  return {.origin = origin, .direction = direction, .kinds = kinds, .time = time};
}

}  // namespace

// What each camera ray starts in. Rays from one place share the answer.
void PathIntegrator::find_camera_media() {
  MediaStack around;
  if (scene_.world_volume != Id<Material>::none)
    around.enter(MediaStack::world, *scene_.materials[scene_.world_volume].medium);
  media_.assign(paths_.size(), around);

  std::vector<Probe> probes;
  std::vector<std::uint32_t> probe_of(paths_.size(), ~0u);
  for (std::uint32_t i = 0; i < paths_.size(); ++i) {
    const Vec3f start = rays_[i].at(rays_[i].t_min);
    const auto is_within = [&](const Bounds3f& bounds) { return contains(bounds, start); };
    if (std::ranges::none_of(scene_.volume_bounds, is_within)) continue;
    const bool is_known =
        !probes.empty() && probes.back().ray.origin == start && probes.back().ray.time == rays_[i].time;
    if (!is_known) probes.push_back({i, spawn_volume_ray(start, probe_direction, ray_camera, rays_[i].time)});
    probe_of[i] = static_cast<std::uint32_t>(probes.size() - 1);
  }
  trace_probes(scene_, probes);
  for (std::uint32_t i = 0; i < paths_.size(); ++i) {
    if (probe_of[i] == ~0u) continue;
    for (const Probe::Count& count : probes[probe_of[i]].counts)
      if (count.leaves > 0) media_[i].enter(count.instance, *count.medium);
  }
}

// Takes the path along its ray through what it is in, up to the hit.
PathIntegrator::Passage PathIntegrator::pass_media(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point,
                                                   PixelSample& sample) {
  const MediaSum media = media_[path.media].sum();
  const float length = (hit.is_hit() ? point.t : infinity) - ray.t_min;
  Ray segment = ray;
  if (hit.is_hit()) segment.t_max = point.t;
  if (path.is_camera_ray && hit.is_hit() && !sample.has_hit && !scene_.material_of(point).is_boundary)
    note_first_hit(path.sample, point, sample);
  gather_lamps_in_media(path, segment, media.extinction, sample);
  const std::uint32_t innermost = media_[path.media].innermost();
  const bool shines = innermost == MediaStack::world || scene_.instances[innermost].lit_sets.has(path.receiver_set);
  if (!is_black(media.emission) && shines)
    add_light(path, path.throughput * media.emission * integrated_transmittance(media.extinction, length), 0, sample);

  const bool scatters = !path.is_last && !is_black(media.scattering);
  const std::optional<Color> shares = scatters ? channel_shares(path.throughput) : std::nullopt;
  if (!shares) {
    path.throughput *= transmittance(media.extinction, length);
    return is_black(path.throughput) ? Passage::ended : Passage::passed;
  }
  sample_lights_in_media(path, ray, media, length, sample);
  const CollisionSampling collisions(media.extinction, *shares);
  const Vec2f u = path.sampler.next_2d();
  const float distance = collisions.sample(u.x, u.y);
  if (distance < length) {
    path.throughput *= transmittance(media.extinction, distance) / collisions.pdf(distance);
    return scatter_in_media(path, ray, distance) ? Passage::scattered : Passage::ended;
  }
  path.throughput *= transmittance(media.extinction, length) / collisions.pass_probability(length);
  return is_black(path.throughput) ? Passage::ended : Passage::passed;
}

void PathIntegrator::gather_lamps_in_media(const Path& path, const Ray& ray, Color extinction, PixelSample& sample) {
  scene_.lights.for_each_lamp_hit(ray, path.start(ray), [&](LightHit hit) {
    hit.radiance *= transmittance(extinction, hit.t - ray.t_min);
    gather_lamp(path, ray, hit, sample);
  });
}

// Light that reaches some place on the ray and is scattered there towards the path.
void PathIntegrator::sample_lights_in_media(Path& path, const Ray& ray, const MediaSum& media, float length,
                                            PixelSample& sample) {
  if (scene_.lights.is_empty()) return;
  const Color scattered = media.scattering * integrated_transmittance(media.extinction, length);
  const std::optional<Color> shares = channel_shares(path.throughput * scattered);
  if (!shares) return;
  const TruncatedCollisionSampling collisions(media.extinction, *shares, length);
  // The light is chosen before the place, which is then sought where that light is: near a lamp light grows beyond bounds,
  // and no other way of finding places there keeps the noise within any.
  const Vec2f first = path.sampler.next_2d();
  const int receiver_set = receiver_set_in_media(path);
  const LitPoint guess(ray.at(ray.t_min + collisions.sample(first.x, first.y)), Vec3f(0.0f), receiver_set);
  const std::optional<LightSet::Choice> chosen = scene_.lights.choose(guess, path.sampler.next_1d());
  if (!chosen) return;
  const auto [distance, place_pdf] = pick_place(scene_, path.sampler, ray, *chosen, collisions, length);
  const Vec3f position = ray.at(ray.t_min + distance);
  std::optional<LightSample> light = scene_.lights.sample_chosen(*chosen, position, path.sampler.next_2d(), ray.time);
  if (!light || (light->kinds & ray_volume) == 0 || path.bounces.total > light->max_bounces) return;
  look_up_emission(path, position, ray.time, *light);
  const BsdfValue phase = PhaseMixture(media_[path.media], ray.direction).eval(light->wi);
  // Scattered rays that run into the light ask how likely a sample from that place alone is: so does this.
  const float pdf_there = light->pdf * scene_.lights.probability(*chosen, {position, Vec3f(0.0f), receiver_set});
  const float weight = light->is_delta ? 1 : power_heuristic(pdf_there, phase.pdf);
  Color radiance = path.throughput * transmittance(media.extinction, distance) * phase.value * light->radiance *
                   (weight / (light->pdf * chosen->probability * place_pdf));
  if (is_black(radiance) || !survives_light_roulette(path, radiance)) return;
  const RenderSettings& settings = scene_.settings;
  const float most = path.bounces.total > 0 ? settings.clamp_indirect : settings.clamp_direct;
  const std::uint32_t filing = is_filed(path) ? recorder_.file(path.sample, path.bounces.total, light->light_group,
                                                               [] { return light_shares(ScatterKind::volume); })
                                              : PassRecorder::unfiled;
  const Connection connection{path.sample, radiance, path.bounces, most, path.destination, filing};
  if (!light->casts_shadows) return add_connection(connection, sample);
  const bool is_unlit = path.destination == Destination::catcher_unlit;
  shadow_rays_.push_back(
      spawn_volume_ray(position, light->wi, is_unlit ? std::uint32_t{ray_catcher} : light->shadow_kind, ray.time));
  shadow_rays_.back().t_max = light->distance * shadow_ray_share;
  shadow_media_.push_back(media_[path.media]);
  connections_.push_back(connection);
}

// Sends the path on from a collision. False where it ends.
bool PathIntegrator::scatter_in_media(Path& path, Ray& ray, float distance) {
  const PhaseMixture mixture(media_[path.media], ray.direction);
  const float choice = path.sampler.next_1d();
  const Vec3f wi = mixture.sample(choice, path.sampler.next_2d());
  const BsdfValue phase = mixture.eval(wi);
  if (!(phase.pdf > 0)) return false;
  path.throughput *= phase.value / phase.pdf;
  if (is_black(path.throughput)) return false;
  if (path.bounces.total == 0 && is_filed(path)) recorder_.note_volume_scattering(path.sample);
  count_bounce(path, ScatterKind::volume);
  const bool is_unlit = path.destination == Destination::catcher_unlit;
  ray = spawn_volume_ray(ray.at(ray.t_min + distance), wi,
                         is_unlit ? std::uint32_t{ray_catcher} : ray_kind(ScatterKind::volume), ray.time);
  path.lit_side = Vec3f(0.0f);
  path.receiver_set = receiver_set_in_media(path);
  path.bsdf_pdf = phase.pdf;
  path.is_specular = path.is_camera_ray = path.is_translucent = path.shows_film = false;
  path.length += distance;
  path.least_pdf = std::min(path.least_pdf, phase.pdf);
  if (!survives_roulette(path)) return false;
  if (has_links()) look_for_linked_lights(path, ray);
  return true;
}

// As Blender has it, light in several volumes at once is received by the one that was entered last.
int PathIntegrator::receiver_set_in_media(const Path& path) const {
  const std::uint32_t instance = media_[path.media].innermost();
  return instance == MediaStack::world ? 0 : scene_.instances[instance].receiver_set;
}

// To the other side of what the point is on than its ray came from.
void PathIntegrator::cross_surface(MediaStack& media, const SurfacePoint& point) const {
  if (point.is_backfacing)
    media.leave(point.instance);
  else if (const Medium* medium = scene_.medium_of(point))
    media.enter(point.instance, *medium);
}

// As connect_through_transparency(), dimmed also by what lies between surfaces.
void PathIntegrator::connect_through_media(std::span<PixelSample> samples) {
  while (!shadow_rays_.empty()) {
    hits_.resize(shadow_rays_.size());
    scene_.tracer.intersect(shadow_rays_, hits_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < shadow_rays_.size(); ++i) {
      Ray ray = shadow_rays_[i];
      Connection connection = connections_[i];
      MediaStack media = shadow_media_[i];
      const Color extinction = media.sum().extinction;
      if (!hits_[i].is_hit()) {
        connection.radiance *= transmittance(extinction, ray.t_max / shadow_ray_share - ray.t_min);
        add_connection(connection, samples[connection.sample]);
        continue;
      }
      const SurfacePoint point = surface_point_at(scene_, ray, hits_[i]);
      const PreparedMaterial& material = scene_.material_of(point);
      connection.radiance *= transmittance(extinction, point.t - ray.t_min);
      if (!material.is_boundary) {
        if (++connection.bounces.transparent > scene_.settings.transparent_bounces) continue;
        connection.radiance *= transparency_at(scene_, point, -ray.direction, shadow_context(connection, point));
      }
      if (is_black(connection.radiance)) continue;
      cross_surface(media, point);
      continue_behind(ray, hits_[i], point);
      shadow_rays_[kept] = ray;
      connections_[kept] = connection;
      shadow_media_[kept] = media;
      ++kept;
    }
    shadow_rays_.resize(kept);
    connections_.resize(kept);
    shadow_media_.resize(kept);
  }
}

}  // namespace basicrt
