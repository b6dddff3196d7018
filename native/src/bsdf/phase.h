// SPDX-License-Identifier: GPL-3.0-or-later
// Phase functions: how far particles in a volume turn the light that they scatter. Each kind is a small value with
//
//   float eval(float cos_theta) const;  per solid angle: integrates to one over the sphere
//   float sample(float u) const;        a cos_theta with that density, u in [0, 1)
//
// where theta is the angle by which the light is turned: 1 is straight on.
#pragma once

#include <utility>
#include <variant>

namespace basicrt {

// Henyey and Greenstein 1941, "Diffuse radiation in the Galaxy". g is the mean of cos theta, in (-1, 1).
class HenyeyGreenstein {
 public:
  explicit HenyeyGreenstein(float g);
  [[nodiscard]] float eval(float cos_theta) const;
  [[nodiscard]] float sample(float u) const;
  bool operator==(const HenyeyGreenstein&) const = default;

 private:
  float g_;  // 0 where it is next to that
};

// Draine 2003, "Scattering by interstellar dust grains. I": the above times 1 + alpha cos^2 theta. With g = 0 and
// alpha = 1 it is Rayleigh's.
class Draine {
 public:
  Draine(float g, float alpha);
  [[nodiscard]] float eval(float cos_theta) const;
  [[nodiscard]] float sample(float u) const;
  bool operator==(const Draine&) const = default;

 private:
  [[nodiscard]] double antiderivative(double s) const;
  [[nodiscard]] double cdf(double cos_theta) const;  // from -1

  double g_, alpha_, norm_;
};

// Fournier and Forand 1994, "Analytic phase function for ocean water", with the parameters of Mobley, Sundman and Boss
// 2002: the particles' refractive index (above 1), and the share of the light that turns by more than 90 degrees. Only
// the mean over small angles is kept of its infinite peak.
class FournierForand {
 public:
  FournierForand(float ior, float backscatter);
  [[nodiscard]] float eval(float cos_theta) const;
  [[nodiscard]] float sample(float u) const;
  bool operator==(const FournierForand&) const = default;

 private:
  [[nodiscard]] double cdf(double x) const;  // by x = sin^2(theta / 2), from 0

  double delta_scale_, nu_;  // delta = delta_scale_ x
  double back_;              // what the correction of the backward peak is multiplied by
  double in_peak_ = 0;       // the share of the light that turns next to nothing
};

using Phase = std::variant<HenyeyGreenstein, Draine, FournierForand>;

[[nodiscard]] inline float eval_phase(const Phase& phase, float cos_theta) {
  return std::visit([&](const auto& kind) { return kind.eval(cos_theta); }, phase);
}
[[nodiscard]] inline float sample_phase(const Phase& phase, float u) {
  return std::visit([&](const auto& kind) { return kind.sample(u); }, phase);
}

// Jendersie and d'Eon 2023, "An Approximate Mie Scattering Function for Fog and Cloud Rendering": a mixture.
struct MieMixture {
  HenyeyGreenstein henyey_greenstein;
  Draine draine;
  float draine_share;
};
[[nodiscard]] MieMixture make_mie(float diameter);  // of water droplets, micrometres

}  // namespace basicrt
