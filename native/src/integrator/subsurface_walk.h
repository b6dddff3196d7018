// SPDX-License-Identifier: GPL-3.0-or-later
// Follows light beneath a surface by a random walk, until it meets the same object's surface from within.
#pragma once

#include <span>
#include <vector>

#include "bsdf/subsurface_medium.h"
#include "integrator/hit_shading.h"
#include "sampling/sampler.h"

namespace basicrt {

// One walk. Directions are picked by the medium's phase function or towards the surface that the light came in by, where
// it most likely leaves, or towards the one opposite (Křivánek and d'Eon 2014, "A Zero-variance-based Sampling Scheme for
// Monte Carlo Subsurface Scattering"; Meng, Hanika and Dachsbacher 2016, "Improving the Dwivedi Sampling Scheme"); colours
// and ways are combined by multiple importance sampling.
class SubsurfaceWalk {
 public:
  // `normal` is the surface's as the light sees it, on the side that it comes from. `throughput` is the path's before it enters.
  SubsurfaceWalk(const Subsurface& subsurface, const SurfacePoint& entry, Vec3f normal, Vec3f direction, float time,
                 Color throughput, const Sampler& sampler);

  enum class State : std::uint8_t { walking, out, lost };
  [[nodiscard]] State state() const { return state_; }
  // Walking: of the step to come. Out: the last one.
  [[nodiscard]] const Ray& ray() const { return ray_; }
  [[nodiscard]] Color throughput() const { return throughput_; }
  [[nodiscard]] const Sampler& sampler() const { return sampler_; }
  [[nodiscard]] const Hit& exit() const { return exit_; }

  // What the ray met: goes one step on, or passes another object that is in the body.
  void advance(const PreparedScene& scene, const Hit& hit);

 private:
  // How a direction is picked after a scattering: with a share of those near the one or the other surface.
  struct Guide {
    float share = 0;           // of directions that are guided at all
    float backward_share = 0;  // of those, the ones towards the surface opposite
    float cosine = 0;          // of the direction picked, to the normal
    float phase = 1;           // density of the phase function for that direction, per solid angle
  };

  void begin_step();
  [[nodiscard]] Guide pick_direction(float& stretching);
  void finish_step(float length, bool is_out);
  [[nodiscard]] Color guided_pdf(const Guide& guide, float length, bool is_out) const;
  [[nodiscard]] float guide_density(float cosine) const;

  SubsurfaceMedium medium_;
  Vec3f start_, normal_;
  float diffusion_length_, log_ratio_;  // of Dwivedi's directions
  float opposite_distance_ = -1;        // below 0: nothing is opposite, or it is far away
  Color throughput_;
  Sampler sampler_;
  std::uint32_t instance_;
  int steps_ = 0;
  State state_ = State::walking;
  // Of the step under way.
  Ray ray_;
  Color channel_shares_{};
  float step_length_ = 0;
  Guide guide_;
  Hit exit_;
};

// Takes all of them to their ends, one step of each at a time.
class SubsurfaceWalks {
 public:
  void run(const PreparedScene& scene, std::span<SubsurfaceWalk> walks);

 private:
  std::vector<std::uint32_t> active_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
};

}  // namespace basicrt
