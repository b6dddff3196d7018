// SPDX-License-Identifier: GPL-3.0-or-later
// Sunlight scattered any number of times, in four wavelengths that were chosen so that they give the colours: Garcia
// Linan 2024, fgarlin.com/posts/2024-12-06-spectral_sky, whose numbers these are. What is scattered more than once comes
// from all directions alike, by a fit and by what the ground reflects; the steps along the eye's ray are those of
// Hillaire 2016, "Physically based sky, atmosphere and cloud rendering in Frostbite".
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/parallel_for.h"
#include "light/air_ray.h"
#include "light/sky_grid.h"
#include "light/sky_models.h"
#include "light/solid_angle.h"
#include "math/constants.h"

namespace basicrt {
namespace {

// Kilometres.
constexpr double planet_radius = 6371, air_thickness = 100, air_radius = planet_radius + air_thickness;
constexpr float ground_albedo = 0.3f;
constexpr float aerosol_asymmetry = 0.8f;
constexpr int step_count = 64;

// 630, 560, 490 and 430 nm. Vectors of these are of molecules, aerosols and ozone.
constexpr int wavelength_count = 4;
using Spectrum = std::array<float, wavelength_count>;

struct Wavelength {
  float sunlight;    // W / (m^2 nm) above the air
  Vec3f scattering;  // per kilometre, where the density is 1
  Vec3f extinction;
  float more_scattered;  // its share of light that is scattered more than once
  Vec3f xyz;             // its part of the colour
};

// Aerosols and ozone where their densities are 1: cross sections in m^2 times numbers per m^3, per kilometre.
constexpr float aerosol_number = 1.3681e20f, ozone_number = 3.78547397e20f * 334.5f;
constexpr Wavelength make_wavelength(float sunlight, float molecules, float aerosol_scattering,
                                     float aerosol_absorption, float ozone, float more_scattered, Vec3f xyz) {
  return {.sunlight = sunlight,
          .scattering = {molecules, aerosol_number * aerosol_scattering, 0},
          .extinction = {molecules, aerosol_number * (aerosol_scattering + aerosol_absorption), ozone_number * ozone},
          .more_scattered = more_scattered,
          .xyz = xyz};
}
constexpr std::array<Wavelength, wavelength_count> wavelengths = {
    make_wavelength(1.679f, 6.605e-3f, 1.5908e-22f, 2.8722e-24f, 3.472e-25f, 0.217f, {53.38692f, 22.98134f, 0}),
    make_wavelength(1.828f, 1.067e-2f, 1.7711e-22f, 4.6168e-24f, 3.914e-25f, 0.347f, {43.90484f, 71.34780f, 0.10251f}),
    make_wavelength(1.986f, 1.842e-2f, 2.0942e-22f, 7.9706e-24f, 1.349e-25f, 0.594f, {1.61373f, 18.42296f, 31.74292f}),
    make_wavelength(1.307f, 3.156e-2f, 2.4033e-22f, 1.3578e-23f, 1.103e-26f, 1.0f, {20.76267f, 2.36142f, 110.48010f})};

float molecule_density(float height) { return std::exp(-0.07771971f * std::pow(height, 1.16364243f)); }
float aerosol_density(float height) {
  constexpr float background = 2e6f / aerosol_number, scale_height = 0.73f;
  return std::exp(-height / scale_height) + background;
}
// Log-normal around 25 km.
float ozone_density(float height) {
  const float log_height = std::log(std::max(height, 1e-4f)), from_peak = log_height - 3.22261f;
  return std::exp(-from_peak * from_peak / 0.18f - log_height);
}

float molecule_phase(float cosine) { return 3 / (16 * pi) * (1 + cosine * cosine); }
// Henyey and Greenstein 1941.
float aerosol_phase(float cosine) {
  constexpr float g = aerosol_asymmetry, g2 = g * g;
  const float base = 1 + g2 - 2 * g * cosine;
  return 1 / (4 * pi) * (1 - g2) / (base * std::sqrt(base));
}
constexpr float isotropic_phase = 1 / (4 * pi);

Color color_of(const Spectrum& spectrum) {
  Vec3f xyz(0.0f);
  for (std::size_t i = 0; i < spectrum.size(); ++i) xyz += wavelengths[i].xyz * spectrum[i];
  return color_from_xyz(xyz);
}

class Air {
 public:
  explicit Air(const MultipleScatteringSky& sky) : amounts_(sky.air_density, sky.aerosol_density, sky.ozone_density) {}

  [[nodiscard]] Vec3f densities(double radius) const {
    const float height = std::max(static_cast<float>(radius - planet_radius), 0.0f);
    return amounts_ * Vec3f{molecule_density(height), aerosol_density(height), ozone_density(height)};
  }
  // The share of light that gets to the end of the air. The planet is no hindrance, but dense air.
  [[nodiscard]] Spectrum transmittance(const AirRay& ray) const {
    const double step = ray.distance_out_of(air_radius) / step_count;
    Vec3f passed(0.0f);
    for (int i = 0; i < step_count; ++i) passed += densities(ray.radius_at((i + 0.5) * step));
    passed = passed * static_cast<float>(step);
    Spectrum shares;
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = std::exp(-dot(passed, wavelengths[i].extinction));
    return shares;
  }

 private:
  Vec3f amounts_;
};

// Air::transmittance by cosine and height, between which it is linear.
class TransmittanceTable {
 public:
  TransmittanceTable(const Air& air, int threads) : entries_(std::size_t{columns} * rows) {
    parallel_for(rows, threads, [&](std::size_t row) {
      const double radius = planet_radius + air_thickness * double(row) / (rows - 1);
      for (std::size_t column = 0; column < columns; ++column)
        entries_[row * columns + column] = air.transmittance({radius, 2.0 * double(column) / (columns - 1) - 1});
    });
  }

  [[nodiscard]] Spectrum at(double radius, double cosine) const {
    const Step column = step(cosine / 2 + 0.5, columns), row = step((radius - planet_radius) / air_thickness, rows);
    const Spectrum* lower = &entries_[row.index * columns + column.index];
    const Spectrum* upper = lower + columns;
    Spectrum mixed;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
      const float below = lower[0][i] + column.inside * (lower[1][i] - lower[0][i]);
      const float above = upper[0][i] + column.inside * (upper[1][i] - upper[0][i]);
      mixed[i] = below + row.inside * (above - below);
    }
    return mixed;
  }

 private:
  static constexpr std::size_t columns = 256, rows = 64;
  struct Step {
    std::size_t index;  // the one after it exists, too
    float inside;
  };
  static Step step(double share, std::size_t count) {
    const double place = std::clamp(share, 0.0, 1.0) * double(count - 1);
    const auto index = std::min(static_cast<std::size_t>(place), count - 2);
    return {index, static_cast<float>(place - double(index))};
  }

  std::vector<Spectrum> entries_;
};

double eye_radius(const MultipleScatteringSky& sky) {
  return planet_radius + std::clamp(double(sky.altitude) / 1000, 0.001, air_thickness - 0.001);
}

class MultipleScattering {
 public:
  MultipleScattering(const MultipleScatteringSky& sky, int threads)
      : air_(sky),
        table_(air_, threads),
        eye_radius_(eye_radius(sky)),
        sun_sine_(std::sin(double(sky.sun_elevation))),
        sun_cosine_(std::cos(double(sky.sun_elevation))) {}

  [[nodiscard]] Color color(SkyPlace place) const;

 private:
  [[nodiscard]] Spectrum scattered_before(double radius, double sun_cosine) const;

  Air air_;
  TransmittanceTable table_;
  double eye_radius_, sun_sine_, sun_cosine_;
};

// Light for each watt of the sun's that comes to a place from air and ground, in its mean over directions, times the
// phase function.
Spectrum MultipleScattering::scattered_before(double radius, double sun_cosine) const {
  const double ratio = planet_radius / radius;
  const auto ground_angle = static_cast<float>(2 * std::numbers::pi * (1 - std::sqrt(1 - ratio * ratio)));
  const Spectrum sun_to_ground = table_.at(planet_radius, sun_cosine);
  const Spectrum from_ground = table_.at(planet_radius, 1), from_here = table_.at(radius, 1);
  const auto cosine = static_cast<float>(sun_cosine);
  const float from_air = 0.02f / (1 + 5 * std::exp(-17.92f * cosine));
  Spectrum light;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const float ground = ground_albedo * inv_pi * sun_to_ground[i] * cosine * from_ground[i] / from_here[i];
    light[i] = isotropic_phase * ground_angle * ground + from_air * wavelengths[i].more_scattered;
  }
  return light;
}

Color MultipleScattering::color(SkyPlace place) const {
  const double sine = std::sin(double(place.elevation));
  const double sun_angle_cosine =
      sine * sun_sine_ + std::cos(double(place.elevation)) * std::cos(double(place.azimuth)) * sun_cosine_;
  const AirRay ray{eye_radius_, sine};
  const double end = ray.meets(planet_radius) ? ray.distance_into(planet_radius) : ray.distance_out_of(air_radius);
  const double step = end / step_count;
  const float molecules = molecule_phase(static_cast<float>(sun_angle_cosine));
  const float aerosols = aerosol_phase(static_cast<float>(sun_angle_cosine));

  Spectrum sum{}, left;  // left: of light on its way from here to the eye
  left.fill(1);
  for (int i = 0; i < step_count; ++i) {
    const double distance = (i + 0.5) * step, radius = ray.radius_at(distance);
    const double sun_cosine = (eye_radius_ * sun_sine_ + distance * sun_angle_cosine) / radius;
    const Vec3f here = air_.densities(radius);
    const Spectrum direct = table_.at(radius, sun_cosine), before = scattered_before(radius, sun_cosine);
    for (std::size_t w = 0; w < sum.size(); ++w) {
      const Vec3f scattering = here * wavelengths[w].scattering;
      const float source =
          scattering.x * (molecules * direct[w] + before[w]) + scattering.y * (aerosols * direct[w] + before[w]);
      const float extinction = dot(here, wavelengths[w].extinction);
      const float passing = std::exp(-static_cast<float>(step) * extinction);
      sum[w] += left[w] * wavelengths[w].sunlight * source * (1 - passing) / std::max(extinction, 1e-7f);
      left[w] *= passing;
    }
  }
  return color_of(sum);
}

}  // namespace

Image draw(const MultipleScatteringSky& sky, int threads) {
  const MultipleScattering model(sky, threads);
  return draw_sky_grid({}, [&](SkyPlace place) { return model.color(place); }, threads);
}

SunDisc sun_of(const MultipleScatteringSky& sky) {
  const Air air(sky);
  const double elevation = sky.sun_elevation, radius = double(sky.sun_size) / 2, eye = eye_radius(sky);
  const float scale = sky.sun_intensity / static_cast<float>(2 * std::numbers::pi * one_minus_cos(radius));
  const auto radiance_at = [&](double at) {
    Spectrum spectrum = air.transmittance({eye, std::sin(at)});
    for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] *= wavelengths[i].sunlight * scale;
    return max(color_of(spectrum), Color(0.0f));
  };
  return {.elevation = elevation,
          .radius = radius,
          .low = radiance_at(elevation - radius),
          .high = radiance_at(elevation + radius),
          .horizon = -std::acos(planet_radius / eye)};
}

}  // namespace basicrt
