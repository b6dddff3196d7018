// SPDX-License-Identifier: GPL-3.0-or-later
// The unidirectional path tracer: lights and BSDFs sampled, combined by multiple importance sampling.
#pragma once

#include <cstdint>
#include <vector>

#include "bsdf/bsdf.h"
#include "integrator/hit_shading.h"
#include "integrator/integrator.h"

namespace basicrt {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const PreparedScene& scene) : scene_(scene) {}
  void render(const CameraPaths& paths, std::span<PixelSample> samples) override;

 private:
  // Scatterings so far, by kind.
  struct Bounces {
    int total = 0, diffuse = 0, glossy = 0, transmission = 0, transparent = 0;
  };
  struct Path {
    std::uint32_t sample;  // which of the batch's samples it is for
    Sampler sampler;
    Color throughput{1.0f};
    Bounces bounces = {};
    Vec3f lit_side = {};      // of the last scattering, as light was chosen for it: see LitPoint
    float bsdf_pdf = 0;       // of the last scattering's direction, over solid angle
    bool is_specular = true;  // no light sample could have found this ray (a camera ray, or after a delta lobe)
    bool is_last = false;     // only what the next surface emits still counts
    bool is_camera_ray = true;
  };
  // A light sample that is worth testing for shadow.
  struct Connection {
    std::uint32_t sample;
    Color radiance;           // if nothing is in the way
    int transparent_bounces;  // before it
  };

  void begin(const CameraPaths& paths, std::span<PixelSample> samples);
  void extend();                                 // finds each path's next hit
  void shade(std::span<PixelSample> samples);    // gathers emission, samples a light, scatters
  void connect(std::span<PixelSample> samples);  // tests the light samples for shadow

  // `ray` is the one that the path came by, up to the surface.
  void gather_lamps(const Path& path, const Ray& ray, PixelSample& sample) const;
  void gather_distant_lamps(const Path& path, const Ray& ray, PixelSample& sample) const;
  static void gather_lamp(const Path& path, const LightHit& hit, PixelSample& sample);
  void gather_environment(const Path& path, PixelSample& sample) const;
  void gather_emission(const Path& path, const Ray& ray, const SurfacePoint& point, Color emission,
                       PixelSample& sample) const;
  void sample_lights(Path& path, const Ray& ray, const SurfacePoint& point, const Bsdf& bsdf, PixelSample& sample);
  [[nodiscard]] bool scatter(Path& path, Ray& ray, const Hit& hit, const SurfacePoint& point, const Bsdf& bsdf) const;
  [[nodiscard]] bool count_bounce(Path& path, ScatterKind kind) const;
  [[nodiscard]] bool survives_roulette(Path& path) const;
  void connect_through_transparency(std::span<PixelSample> samples);

  const PreparedScene& scene_;
  std::vector<Path> paths_;
  std::vector<Ray> rays_;  // the next one of each path
  std::vector<Hit> hits_;
  SurfacePoints points_;  // of some of the hits at a time
  std::vector<Ray> shadow_rays_;
  std::vector<Connection> connections_;
  std::vector<std::uint8_t> occluded_;
};

}  // namespace basicrt
