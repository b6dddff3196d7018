// SPDX-License-Identifier: GPL-3.0-or-later
// What a batch of paths says of the passes: of what the camera sees, and under which heading light goes. Light is filed by
// the way its path was scattered first, straight passage through transparent surfaces apart.
#pragma once

#include <cstdint>
#include <vector>

#include "bsdf/bsdf.h"
#include "film/pass_values.h"
#include "scene/prepare.h"

namespace basicrt {

// How much of some light goes under each kind of scattering; adds up to one in each channel.
struct LightShares {
  Color diffuse{0.0f}, glossy{0.0f}, transmission{0.0f}, volume{0.0f};
};

class PassRecorder {
 public:
  static constexpr std::uint32_t unfiled = ~0u;

  explicit PassRecorder(const PreparedScene& scene);

  void begin(std::size_t samples);
  [[nodiscard]] bool is_active() const { return is_active_; }
  [[nodiscard]] bool records_light() const { return records_light_; }
  [[nodiscard]] const PassValues& values() const { return values_; }
  [[nodiscard]] const PreparedScene& scene() const { return scene_; }

  // Of the first thing that a sample sees.
  void record_first_hit(std::uint32_t sample, const SurfacePoint& point);
  // Of a sample that sees nothing before `ray` leaves the scene.
  void record_background(std::uint32_t sample, const Ray& ray);
  // Of whatever the camera sees, through transparent surfaces too. `wo` is where the path came from.
  void record_seen(std::uint32_t sample, Vec3f wo, const SurfacePoint& point, const Bsdf& bsdf, Color throughput);
  // For denoisers: of the first surface that is no perfect mirror or pane, by way of such.
  void record_features(std::uint32_t sample, Vec3f wo, const SurfacePoint& point, const Bsdf& bsdf, Color throughput);
  // What shines there, or behind everything, is its colour too.
  void record_glow(std::uint32_t sample, Color radiance) {
    if (is_active_ && has_features_[sample] == 0) values_.add(sample, Pass::denoising_albedo, radiance);
  }

  [[nodiscard]] bool records_aovs() const { return records_aovs_; }
  void record_aov(std::uint32_t sample, const AovShader& aov) {
    values_.add(sample, aov_color_pass(aov.number), aov.color.constant, 1);
    values_.add(sample, aov_value_pass(aov.number), aov.value.constant);
  }
  void record_roughness(std::uint32_t sample, float roughness) { values_.add(sample, Pass::roughness, roughness); }
  // How much of the sky is to be seen of a surface that the camera sees, and of the surface itself.
  void record_openness(std::uint32_t sample, Color share) { values_.add(sample, Pass::ambient_occlusion, share); }

  // A path's first scattering.
  void note_scattering(std::uint32_t sample, const Bsdf& bsdf, Vec3f wo, const BsdfSample& scattered);
  void note_volume_scattering(std::uint32_t sample);

  // Light of a group that a path ran into after so many scatterings.
  void add_found_light(std::uint32_t sample, int scatterings, Color radiance, int light_group, bool is_environment);
  // Where light of a group goes that a path with so many scatterings sampled; `shares_here` is called if this is its first surface.
  template <class Shares>
  [[nodiscard]] std::uint32_t file(std::uint32_t sample, int scatterings, int light_group, Shares&& shares_here) {
    if (!records_light_) return unfiled;
    const bool is_direct = scatterings == 0;
    filings_.push_back({is_direct ? shares_here() : shares_[sample], is_direct, light_group});
    return static_cast<std::uint32_t>(filings_.size() - 1);
  }
  // The same of light that a path may have run into after so many scatterings, at least one.
  [[nodiscard]] std::uint32_t file_found(std::uint32_t sample, int scatterings, int light_group) {
    return file(sample, scatterings - 1, light_group, [&] { return shares_[sample]; });
  }
  void add_sampled_light(std::uint32_t sample, std::uint32_t filing, Color radiance);
  // Filings are of no use any more.
  void clear_filings() { filings_.clear(); }

 private:
  struct Filing {
    LightShares shares;
    bool is_direct;
    int light_group;
  };
  template <class FilmPlace>
  void record_motion(std::uint32_t sample, float time, FilmPlace&& film_place);
  void add_to_group(std::uint32_t sample, int light_group, Color radiance);
  void add(std::uint32_t sample, const Filing& filing, Color radiance);

  const PreparedScene& scene_;
  PassValues values_;
  bool has_mattes_, is_active_, records_light_, records_aovs_;
  std::vector<LightShares> shares_;         // of each sample's path, once it was scattered
  std::vector<std::uint8_t> has_features_;  // of each sample
  std::vector<Filing> filings_;             // of light samples
};

// Of light that arrives along `wi` and is scattered towards `wo`, if it is of the kinds (RayKind bits) that a lamp lights.
[[nodiscard]] LightShares light_shares(const Bsdf& bsdf, Vec3f wo, Vec3f wi, std::uint32_t kinds = ray_all);
[[nodiscard]] LightShares light_shares(ScatterKind kind);

}  // namespace basicrt
