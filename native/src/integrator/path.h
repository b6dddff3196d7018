// SPDX-License-Identifier: GPL-3.0-or-later
// The unidirectional path tracer: lights and BSDFs sampled, combined by multiple importance sampling.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "bsdf/bsdf.h"
#include "integrator/hit_shading.h"
#include "integrator/integrator.h"
#include "integrator/media_stack.h"
#include "integrator/scene_probe.h"
#include "integrator/subsurface_walk.h"

namespace basicrt {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const PreparedScene& scene);
  void render(const CameraPaths& paths, std::span<PixelSample> samples) override;

 private:
  // Where a path's light goes: into the picture; where the path is one that leaves a shadow catcher, into one of the two
  // sums that are compared; where it came through one, into what is darkened by that. Into the pass Ambient Occlusion goes
  // light from everywhere, which is no path's.
  enum class Destination : std::uint8_t { picture, behind_catcher, catcher_lit, catcher_unlit, occlusion };
  // Scatterings so far, by kind.
  struct Bounces {
    int total = 0, diffuse = 0, glossy = 0, transmission = 0, transparent = 0, volume = 0;
  };
  struct Path {
    std::uint32_t sample;     // which of the batch's samples it is for
    std::uint32_t media = 0;  // where there are volumes: which of media_ it is in
    Sampler sampler;
    Color throughput{1.0f};
    Bounces bounces = {};
    Vec3f lit_side = {};                    // of the last scattering, as light was chosen for it: see LitPoint
    int receiver_set = LinkSets::unlinked;  // of what scattered it last: only what lights that counts
    float length = 0;                       // of all rays before this one, metres
    float bsdf_pdf = 0;                     // of the last scattering's direction, over solid angle
    bool is_specular = true;     // no light sample could have found this ray (a camera ray, or after a delta lobe)
    bool is_last = false;        // only what the next surface emits still counts, also behind transparent ones
    bool ends_at_panes = false;  // at transparent surfaces, too, if it is the last
    bool is_camera_ray = true;
    bool is_translucent = false;  // the last scattering
    Destination destination = Destination::picture;
    bool shows_film = true;      // holes that it meets are holes in the picture
    float least_pdf = infinity;  // of all scatterings' densities

    // Where its ray began, as light was chosen there.
    [[nodiscard]] LitPoint start(const Ray& ray) const { return {ray.origin, lit_side, receiver_set}; }
  };
  // A path beneath a surface.
  struct WalkingPath {
    Path path;
    bool is_turned;  // bumps may turn the surface that it leaves by, too
  };
  // A light sample that is worth testing for shadow.
  struct Connection {
    std::uint32_t sample;
    Color radiance;   // if nothing is in the way
    Bounces bounces;  // before it
    float limit;      // clamps the radiance, as in clamp_light()
    Destination destination;
    std::uint32_t filing;  // in the passes: PassRecorder's
  };

  void begin(const CameraPaths& paths, std::span<PixelSample> samples);
  void extend();                                 // finds each path's next hit
  void shade(std::span<PixelSample> samples);    // gathers emission, samples a light, scatters
  void connect(std::span<PixelSample> samples);  // tests the light samples for shadow

  // `ray` is the one that the path came by, up to the surface.
  [[nodiscard]] ShadingContext context_of(const Path& path, const Ray& ray, const SurfacePoint& point) const;
  // Blender counts the bounce that a shadow ray stands for.
  [[nodiscard]] ShadingContext shadow_context(const Connection& connection, const SurfacePoint& point) const;
  static void set_bounces(ShadingContext& context, const Bounces& bounces);
  [[nodiscard]] static Color& sum_of(Destination destination, PixelSample& sample);
  static void cut_hole(const Path& path, Color share, PixelSample& sample);
  void add_light(const Path& path, Color radiance, int light_group, PixelSample& sample, bool is_environment = false);
  void gather_lamps(const Path& path, const Ray& ray, PixelSample& sample);
  void gather_distant_lamps(const Path& path, const Ray& ray, PixelSample& sample);
  void gather_lamp(const Path& path, const Ray& ray, const LightHit& hit, PixelSample& sample);
  void gather_environment(const Path& path, const Ray& ray, PixelSample& sample);
  void gather_emission(const Path& path, const Ray& ray, const SurfacePoint& point, Color emission,
                       PixelSample& sample);
  // What light samples leave of what an emissive surface sends to a path that ran into it.
  [[nodiscard]] float weight_of_emission(const Path& path, const Ray& ray, const SurfacePoint& point) const;
  [[nodiscard]] bool is_filed(const Path& path) const;
  void add_connection(const Connection& connection, PixelSample& sample);
  // Light that a path runs into, if only what dims it were in the way: path_linked.cpp.
  [[nodiscard]] bool has_links() const { return !scene_.shadow_links.empty(); }
  void look_for_linked_lights(const Path& path, const Ray& ray);
  void look_for_linked_emitters();
  void meet_linked_emitter(const Path& path, const Ray& ray, const SurfacePoint& point);
  void add_linked_connection(const Path& path, const Ray& ray, float distance, Color radiance, int light_group,
                             std::uint32_t shadow_kind);
  void record_surface(const Path& path, const Ray& ray, const SurfacePoint& point, const SurfaceShading& shading);
  // For baking and the pass Ambient Occlusion: path_surface.cpp.
  void keep_baked_parts(const Path& path, const Ray& ray, SurfaceShading& shading, PixelSample& sample) const;
  void note_first_surface(const Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf,
                          PixelSample& sample);
  void sample_occlusion(const Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf);
  void cut_out(const Path& path, const Ray& ray, const SurfacePoint& point, SurfaceShading& shading,
               PixelSample& sample) const;
  void sample_lights(Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf, PixelSample& sample);
  // Looks up what varies on the surface that a light sample is of.
  void look_up_emission(const Path& path, Vec3f position, float time, LightSample& light) const;
  // The radiance times what the lamp's material emits; `depth` counts scatterings.
  [[nodiscard]] Color radiance_of_lamp(const Path& path, const Ray& ray, const LightHit& hit) const;
  [[nodiscard]] Color with_emission(Color radiance, std::uint32_t lamp, const Ray& ray, const Path& path,
                                    int depth) const;
  [[nodiscard]] float terminator_share(const SurfacePoint& point, Vec3f wi) const;
  [[nodiscard]] BsdfValue eval_towards(const LightSample& light, const SurfacePoint& point, Vec3f wo,
                                       const Bsdf& bsdf) const;
  void pass_catcher(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point, const Bsdf& bsdf,
                    PixelSample& sample);
  [[nodiscard]] bool scatter(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point, const Bsdf& bsdf);
  void enter_body(const Path& path, const Ray& ray, const SurfacePoint& point, const BsdfSample& entering,
                  bool is_turned);
  void leave_bodies(std::span<PixelSample> samples);
  void count_bounce(Path& path, ScatterKind kind) const;
  [[nodiscard]] bool survives_roulette(Path& path) const;
  [[nodiscard]] bool survives_light_roulette(Path& path, Color& radiance) const;
  void connect_through_transparency(std::span<PixelSample> samples);

  // Volumes: path_volume.cpp. Only called where the scene has some.
  enum class Passage : std::uint8_t { passed, scattered, ended };
  void find_camera_media();
  [[nodiscard]] int receiver_set_in_media(const Path& path) const;
  [[nodiscard]] bool is_in_media(const Path& path) const { return has_volumes_ && !media_[path.media].is_empty(); }
  [[nodiscard]] Passage pass_media(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point,
                                   PixelSample& sample);
  void gather_lamps_in_media(const Path& path, const Ray& ray, Color extinction, PixelSample& sample);
  void sample_lights_in_media(Path& path, const Ray& ray, const MediaSum& media, float length, PixelSample& sample);
  [[nodiscard]] bool scatter_in_media(Path& path, Ray& ray, float distance);
  void cross_surface(MediaStack& media, const SurfacePoint& point) const;
  void connect_through_media(std::span<PixelSample> samples);

  const PreparedScene& scene_;
  SceneProbe probe_;
  bool has_volumes_;
  bool softens_caustics_;
  bool is_baking_ = false;
  BakedParts baked_parts_;
  std::vector<Path> paths_;
  std::vector<Ray> rays_;           // the next one of each path
  std::vector<Path> caught_paths_;  // those that leave shadow catchers
  std::vector<Ray> caught_rays_;
  std::vector<Path> linked_paths_;  // that may have run into linked emitters
  std::vector<Ray> linked_rays_;
  std::vector<SubsurfaceWalk> walks_;
  std::vector<WalkingPath> walking_paths_;  // of the walks
  SubsurfaceWalks walkers_;
  std::vector<Hit> hits_;
  SurfacePoints points_;  // of some of the hits at a time
  std::vector<Ray> shadow_rays_;
  std::vector<Connection> connections_;
  std::vector<std::uint8_t> occluded_;
  std::vector<MediaStack> media_;         // what paths are in, where there are volumes
  std::vector<MediaStack> shadow_media_;  // what each shadow ray is in
};

}  // namespace basicrt
