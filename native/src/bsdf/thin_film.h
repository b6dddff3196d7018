// SPDX-License-Identifier: GPL-3.0-or-later
// Reflection by a dielectric or a metal under a film so thin that light interferes with itself: soap, oil, tempered steel.
// Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence".
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "bsdf/fresnel.h"
#include "math/color.h"

namespace basicrt {

// Lobes have little room. The thickness is kept in steps of 1/16 nm, up to 4 micrometres, beyond which hardly any light
// interferes; the index in steps of 1/8192, up to 8.
class ThinFilm {
 public:
  ThinFilm() = default;
  // In nanometres, and relative to what is around.
  ThinFilm(float thickness, float ior) : thickness_(steps(thickness, 16)), ior_(steps(ior, 8192)) {}

  [[nodiscard]] bool is_none() const { return thickness_ <= 1; }  // Blender's limit is .1 nm
  [[nodiscard]] float thickness() const { return static_cast<float>(thickness_) / 16; }
  [[nodiscard]] float ior() const { return static_cast<float>(ior_) / 8192; }

 private:
  [[nodiscard]] static std::uint16_t steps(float x, float per_unit) {
    return static_cast<std::uint16_t>(std::clamp(x * per_unit + 0.5f, 0.0f, 65535.0f));
  }
  std::uint16_t thickness_ = 0, ior_ = 8192;
};

// Three numbers in [0, limit] that take little room.
template <int limit>
class PackedColor {
 public:
  PackedColor() = default;
  explicit PackedColor(Color c) : channels_{pack(c.x), pack(c.y), pack(c.z)} {}
  [[nodiscard]] Color color() const {
    return Color{float(channels_[0]), float(channels_[1]), float(channels_[2])} * (limit / 65535.0f);
  }

 private:
  [[nodiscard]] static std::uint16_t pack(float x) {
    return static_cast<std::uint16_t>(std::clamp(x, 0.0f, float(limit)) * (65535.0f / limit) + 0.5f);
  }
  std::array<std::uint16_t, 3> channels_{};
};

// The reflectance, averaged over both polarisations. All is relative to the index on the viewer's side.
[[nodiscard]] Color film_on_dielectric(const ThinFilm& film, float cos_incident, float eta);
// Where `f82` isn't negative, the metal's own reflectance is the F82 model's with this value at 82 degrees, and its
// indices only shift the phase.
[[nodiscard]] Color film_on_conductor(const ThinFilm& film, float cos_incident, Color eta, Color k, Color f82);

// As TintedInterfaceFresnel, under a film.
struct FilmInterfaceFresnel {
  ThinFilm film;
  float eta;
  Color f0;
  [[nodiscard]] Color operator()(float cos_incident) const {
    const Color value = film_on_dielectric(film, cos_incident, eta);
    const float untinted = reflectance_from_ior(eta);
    if (untinted <= 1e-5f || min_component(value) >= 1) return value;
    // The film may take the reflectance below that at normal incidence: it is scaled instead, towards normal incidence.
    const Color share = clamp_to_unit((Color(1.0f) - value) / (1 - untinted));
    return clamp_to_unit(value * (Color(1.0f) + (f0 / untinted - Color(1.0f)) * share));
  }
};

struct FilmConductorFresnel {
  ThinFilm film;
  PackedColor<32> eta, k;
  PackedColor<1> f82;
  bool is_f82 = false;

  [[nodiscard]] Color operator()(float cos_incident) const {
    return film_on_conductor(film, cos_incident, eta.color(), k.color(), is_f82 ? f82.color() : Color(-1.0f));
  }
};
[[nodiscard]] FilmConductorFresnel make_film_on_conductor(const ThinFilm& film, Color eta, Color k);
// Indices are found that reflect as the model does: Gulbrandsen 2014, "Artist Friendly Metallic Fresnel".
[[nodiscard]] FilmConductorFresnel make_film_on_f82(const ThinFilm& film, const F82Fresnel& metal);

}  // namespace basicrt
