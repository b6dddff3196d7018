// SPDX-License-Identifier: GPL-3.0-or-later
// Adds up the light that bounces inside a thin film, for each colour channel.
#include "bsdf/thin_film.h"

#include <algorithm>
#include <complex>

#include "bsdf/film_table.h"

namespace basicrt {
namespace {

using Complex = std::complex<float>;

// Reflection of one polarisation at one interface: the share of energy, and the phase as a number of length one.
struct Bounce {
  float reflectance;
  Complex phase;
};
struct Interface {
  Bounce s, p;  // across and along the plane of incidence
  float cos_transmitted = 0;
};

Bounce make_bounce(const Complex& amplitude) {
  const float size = std::abs(amplitude);
  return {std::min(size * size, 1.0f), size > 0 ? amplitude / size : Complex(1)};
}

// `eta` as in fresnel_dielectric(). Past the critical angle the transmitted cosine is zero and all is reflected.
Interface dielectric_interface(float cos_incident, float eta) {
  const float cos_transmitted = fresnel_dielectric(cos_incident, eta).cos_transmitted;
  const float s = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
  const float p = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
  return {make_bounce(s), make_bounce(p), cos_transmitted};
}

// Born and Wolf, "Principles of Optics", 14.4: a metal of index `metal`, seen from inside a film.
Interface metal_interface(float cos_incident, float film_ior, Complex metal) {
  const float sine = film_ior * std::sqrt(std::max(1 - cos_incident * cos_incident, 0.0f));
  const Complex inner = std::sqrt(metal * metal - sine * sine), squared = metal * metal * cos_incident;
  const float outer = film_ior * cos_incident;
  return {make_bounce((outer - inner) / (outer + inner)),
          make_bounce((squared - film_ior * inner) / (squared + film_ior * inner))};
}

Complex sensitivity(std::size_t channel, float difference) {
  const float place = std::min(difference / film_table::greatest_difference, 1.0f) * (film_table::nodes - 1);
  const int index = std::min(static_cast<int>(place), film_table::nodes - 2);
  const auto at = [&](const std::int16_t* table) {
    return lerp(float(table[index]), float(table[index + 1]), place - static_cast<float>(index)) / film_table::unit;
  };
  return {at(film_table::sensitivity[channel]), at(film_table::sensitivity[channel + 3])};
}

// The paper's equation 10: the mean, and a cosine for each further trip through the film; three are enough.
float add_up(const Bounce& top, const Bounce& bottom, float difference, std::size_t channel) {
  const float entering = 1 - top.reflectance, both = top.reflectance * bottom.reflectance;
  if (!(both < 1)) return 1;
  const float inside = entering * entering * bottom.reflectance / (1 - both);
  // Reflected from below, the top shifts the phase by half a wave against reflection from above.
  const Complex shift = -top.phase * bottom.phase;
  float sum = inside + top.reflectance, strength = inside - entering;
  Complex phase = 1;
  for (int trip = 1; trip <= 3; ++trip) {
    strength *= std::sqrt(both);
    phase *= shift;
    const Complex seen = sensitivity(channel, static_cast<float>(trip) * difference);
    sum += 2 * strength * (phase.real() * seen.real() + phase.imag() * seen.imag());
  }
  return sum;
}

// The film's index; one of less than a nanometre fades away, for waves don't apply to it.
float faded_ior(const ThinFilm& film) {
  const float t = std::min(film.thickness(), 1.0f);
  return 1 + (film.ior() - 1) * t * t * (3 - 2 * t);
}

// bottom_of(channel, cosine in the film) is the interface to what is below.
Color reflect(const ThinFilm& film, float cos_incident, auto&& bottom_of) {
  const float ior = faded_ior(film);
  const Interface top = dielectric_interface(cos_incident, ior);
  if (!(top.cos_transmitted > 0)) return Color(1.0f);
  const float difference = 2 * ior * film.thickness() * top.cos_transmitted;
  Color sum;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const Interface bottom = bottom_of(channel, ior, top.cos_transmitted);
    sum[channel] = (add_up(top.s, bottom.s, difference, channel) + add_up(top.p, bottom.p, difference, channel)) / 2;
  }
  return clamp_to_unit(sum);
}

}  // namespace

Color film_on_dielectric(const ThinFilm& film, float cos_incident, float eta) {
  return reflect(film, cos_incident, [&](std::size_t, float film_ior, float cosine) {
    return dielectric_interface(cosine, eta / film_ior);
  });
}

Color film_on_conductor(const ThinFilm& film, float cos_incident, Color eta, Color k, Color f82) {
  return reflect(film, cos_incident, [&](std::size_t channel, float film_ior, float cosine) {
    Interface bottom = metal_interface(cosine, film_ior, {eta[channel], k[channel]});
    if (f82[channel] >= 0) {
      const Color f0(fresnel_conductor(1, eta[channel] / film_ior, k[channel] / film_ior));
      const F82Fresnel model = make_f82_of_reflectance(f0, Color(f82[channel]));
      bottom.s.reflectance = bottom.p.reflectance = model(cosine).x;
    }
    return bottom;
  });
}

FilmConductorFresnel make_film_on_conductor(const ThinFilm& film, Color eta, Color k) {
  FilmConductorFresnel fresnel{.film = film};
  fresnel.eta = PackedColor<32>(eta);
  fresnel.k = PackedColor<32>(k);
  return fresnel;
}

FilmConductorFresnel make_film_on_f82(const ThinFilm& film, const F82Fresnel& metal) {
  const Color f82 = metal(1.0f / 7);
  Color eta, k;
  for (std::size_t c = 0; c < 3; ++c) {
    const float r = std::min(metal.f0[c], 0.999f), root = std::sqrt(r);
    eta[c] = lerp((1 + root) / (1 - root), (1 - r) / (1 + r), f82[c]);
    const float up = eta[c] + 1, down = eta[c] - 1;
    k[c] = std::sqrt(std::max((r * up * up - down * down) / (1 - r), 0.0f));
  }
  FilmConductorFresnel fresnel{.film = film, .is_f82 = true};
  fresnel.eta = PackedColor<32>(eta);
  fresnel.k = PackedColor<32>(k);
  fresnel.f82 = PackedColor<1>(f82);
  return fresnel;
}

}  // namespace basicrt
