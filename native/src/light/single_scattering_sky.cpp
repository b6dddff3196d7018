// SPDX-License-Identifier: GPL-3.0-or-later
// Nishita et al. 1993, "Display of the earth taking into account atmospheric scattering": sunlight that molecules and
// aerosols scatter once on its way to the eye, in 21 wavelengths, dimmed by both and by ozone.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "light/air_ray.h"
#include "light/sky_grid.h"
#include "light/sky_models.h"
#include "light/solid_angle.h"
#include "math/constants.h"

namespace basicrt {
namespace {

// Metres. The heights are those in which densities fall to 1 / e.
constexpr double planet_radius = 6360e3, air_radius = 6420e3;
constexpr float molecule_height = 8000, aerosol_height = 1200;
// Ozone's density falls evenly from 1 to 0 around a height.
constexpr float ozone_height = 25000, ozone_reach = 15000;

constexpr float aerosol_scattering = 2e-5f;  // at the sea, per metre, all wavelengths alike
constexpr float aerosol_extinction = 1.11f * aerosol_scattering;
constexpr float aerosol_asymmetry = 0.76f;

// The eye's ray is cut into so many pieces, as in Blender: near the horizon they are long enough to be seen.
constexpr int piece_count = 32;

constexpr double first_wavelength = 380e-9, wavelength_step = 20e-9;  // metres
constexpr int wavelength_count = 21;
// CIE 1931, 2 degrees, every 20 nm from 380 to 780.
constexpr std::array<std::array<float, 3>, wavelength_count> color_matching = {{{0.001368f, 0.000039f, 0.00645f},
                                                                                {0.01431f, 0.000396f, 0.06785f},
                                                                                {0.13438f, 0.004f, 0.6456f},
                                                                                {0.34828f, 0.023f, 1.74706f},
                                                                                {0.2908f, 0.06f, 1.6692f},
                                                                                {0.09564f, 0.13902f, 0.81295f},
                                                                                {0.0049f, 0.323f, 0.272f},
                                                                                {0.06327f, 0.71f, 0.07825f},
                                                                                {0.2904f, 0.954f, 0.0203f},
                                                                                {0.5945f, 0.995f, 0.0039f},
                                                                                {0.9163f, 0.87f, 0.00165f},
                                                                                {1.0622f, 0.631f, 0.0008f},
                                                                                {0.85445f, 0.381f, 0.00019f},
                                                                                {0.4479f, 0.175f, 0.00002f},
                                                                                {0.1649f, 0.061f, 0},
                                                                                {0.04677f, 0.017f, 0},
                                                                                {0.011359f, 0.004102f, 0},
                                                                                {0.002899f, 0.001047f, 0},
                                                                                {0.00069f, 0.000249f, 0},
                                                                                {0.000166f, 0.00006f, 0},
                                                                                {0.0000415f, 0.000015f, 0}}};
// What ozone absorbs where it is densest, per metre, times 1e9.
constexpr std::array<float, wavelength_count> ozone_absorption = {
    3.251f,  5.854f,  19.77f,  73.10f,  200.8f, 403.8f, 635.5f, 967.1f, 1548.0f, 2090.4f, 2461.3f,
    2735.5f, 2151.3f, 1590.5f, 1123.6f, 735.3f, 464.5f, 331.0f, 225.1f, 148.8f,  168.3f};

// Equation 2 of the paper, of air at the sea, per metre.
double molecule_scattering(double wavelength) {
  constexpr double refraction = 1.0002926, molecules = 2.504e25;  // per cubic metre
  const double excess = refraction * refraction - 1, cubed_pi = std::pow(std::numbers::pi, 3);
  return 8 * cubed_pi * excess * excess / (3 * molecules * std::pow(wavelength, 4));
}

// W / m^2 for each nanometre: Planck's law for 5778 K, seen in the sun's solid angle.
double sun_irradiance(double wavelength) {
  constexpr double planck = 6.62607015e-34, light_speed = 299792458, boltzmann = 1.380649e-23;
  constexpr double temperature = 5778, solid_angle = 6.79016e-5;
  const double exponent = planck * light_speed / (wavelength * boltzmann * temperature);
  const double radiance = 2 * planck * light_speed * light_speed / (std::pow(wavelength, 5) * std::expm1(exponent));
  return radiance * solid_angle * 1e-9;
}

// Vectors of these are of molecules, aerosols and ozone.
struct Wavelength {
  Vec3f extinction;  // per metre, where each is as dense as can be
  float scattering;  // by molecules
  Color sunlight;    // its share of it
};

std::array<Wavelength, wavelength_count> make_wavelengths() {
  std::array<Wavelength, wavelength_count> made;
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double wavelength = first_wavelength + double(i) * wavelength_step;
    const auto scattering = static_cast<float>(molecule_scattering(wavelength));
    const auto& [x, y, z] = color_matching[i];
    made[i] = {.extinction = {scattering, aerosol_extinction, ozone_absorption[i] * 1e-9f},
               .scattering = scattering,
               .sunlight = color_from_xyz(Vec3f{x, y, z} *
                                          static_cast<float>(sun_irradiance(wavelength) * wavelength_step * 1e9))};
  }
  return made;
}

// Gauss and Laguerre's rule with eight points, for integrals from 0 to infinity of what falls as exp(-x): Abramowitz
// and Stegun, table 25.9, the weights times exp(x).
struct QuadraturePoint {
  double x, weight;
};
constexpr std::array<QuadraturePoint, 8> laguerre_points = {{{0.170279632305, 0.437723410493},
                                                             {0.903701776799, 1.033869347666},
                                                             {2.251086629866, 1.669709765659},
                                                             {4.266700170288, 2.376924701758},
                                                             {7.045905402393, 3.208540913348},
                                                             {10.758516010181, 4.268575510825},
                                                             {15.740678641278, 5.818083368672},
                                                             {22.863131736889, 8.906226215292}}};
// Where the air's end is taken to be.
constexpr double laguerre_end = 25;

float molecule_phase(float cosine) { return 3 / (16 * pi) * (1 + cosine * cosine); }
// Cornette and Shanks 1992.
float aerosol_phase(float cosine) {
  constexpr float g = aerosol_asymmetry, g2 = g * g;
  const float base = 1 + g2 - 2 * g * cosine;
  return 3 / (8 * pi) * (1 - g2) / (2 + g2) * (1 + cosine * cosine) / (base * std::sqrt(base));
}

class SingleScattering {
 public:
  explicit SingleScattering(const SingleScatteringSky& sky)
      : sky_(sky),
        wavelengths_(make_wavelengths()),
        eye_radius_(planet_radius + std::clamp(double(sky.altitude), 1.0, air_radius - planet_radius - 1)),
        sun_sine_(std::sin(double(sky.sun_elevation))),
        sun_cosine_(std::cos(double(sky.sun_elevation))) {}

  // Radians; the azimuth is from the sun's.
  [[nodiscard]] Color color(float elevation, float azimuth) const;
  [[nodiscard]] SunDisc sun() const;

 private:
  [[nodiscard]] Vec3f densities(double radius) const;
  [[nodiscard]] Vec3f column(const AirRay& ray) const;
  [[nodiscard]] Color scattered(Vec3f passed, float by_molecules, float by_aerosols) const;
  [[nodiscard]] Color sunlight_at(double elevation) const;

  SingleScatteringSky sky_;
  std::array<Wavelength, wavelength_count> wavelengths_;
  double eye_radius_, sun_sine_, sun_cosine_;
};

Vec3f SingleScattering::densities(double radius) const {
  const auto height = static_cast<float>(radius - planet_radius);
  const float ozone = std::max(1 - std::abs(height - ozone_height) / ozone_reach, 0.0f);
  return {sky_.air_density * std::exp(-height / molecule_height),
          sky_.aerosol_density * std::exp(-height / aerosol_height), sky_.ozone_density * ozone};
}

// Densities integrated from the ray's start to the air's end.
Vec3f SingleScattering::column(const AirRay& ray) const {
  const double unit = ray.distance_out_of(air_radius) / laguerre_end;
  Vec3f sum(0.0f);
  for (const auto& [x, weight] : laguerre_points)
    sum += densities(ray.radius_at(x * unit)) * static_cast<float>(weight * unit);
  return sum;
}

// What reaches the eye of sunlight that has passed these columns in all.
Color SingleScattering::scattered(Vec3f passed, float by_molecules, float by_aerosols) const {
  Color sum(0.0f);
  for (const Wavelength& wavelength : wavelengths_) {
    const float share = std::exp(-dot(passed, wavelength.extinction));
    sum += wavelength.sunlight * (share * (by_molecules * wavelength.scattering + by_aerosols * aerosol_scattering));
  }
  return sum;
}

Color SingleScattering::color(float elevation, float azimuth) const {
  const double sine = std::sin(double(elevation));
  const double sun_angle_cosine =
      sine * sun_sine_ + std::cos(double(elevation)) * std::cos(double(azimuth)) * sun_cosine_;
  const AirRay ray{eye_radius_, sine};
  const double piece = ray.distance_out_of(air_radius) / piece_count;
  const float molecules = molecule_phase(static_cast<float>(sun_angle_cosine));
  const float aerosols = aerosol_phase(static_cast<float>(sun_angle_cosine));

  Color sum(0.0f);
  Vec3f passed(0.0f);  // from the eye
  for (int i = 0; i < piece_count; ++i) {
    const double distance = (i + 0.5) * piece, radius = ray.radius_at(distance);
    const Vec3f here = densities(radius) * static_cast<float>(piece);
    passed += here;
    const AirRay to_sun{radius, (eye_radius_ * sun_sine_ + distance * sun_angle_cosine) / radius};
    if (to_sun.meets(planet_radius)) continue;
    sum += scattered(passed + column(to_sun), here.x * molecules, here.y * aerosols);
  }
  return sum;
}

// W / m^2, on its way to the eye; as in Blender ozone doesn't dim it.
Color SingleScattering::sunlight_at(double elevation) const {
  Vec3f passed = column({eye_radius_, std::sin(elevation)});
  passed.z = 0;
  Color sum(0.0f);
  for (const Wavelength& wavelength : wavelengths_)
    sum += wavelength.sunlight * std::exp(-dot(passed, wavelength.extinction));
  return sum;
}

SunDisc SingleScattering::sun() const {
  const double elevation = sky_.sun_elevation, radius = double(sky_.sun_size) / 2;
  const float scale = sky_.sun_intensity / static_cast<float>(2 * std::numbers::pi * one_minus_cos(radius));
  return {.elevation = elevation,
          .radius = radius,
          .low = max(sunlight_at(std::max(elevation - radius, 0.0)) * scale, Color(0.0f)),
          .high = max(sunlight_at(std::max(elevation + radius, 0.0)) * scale, Color(0.0f)),
          .horizon = 0};
}

// The air below the horizon is drawn as that at the horizon, darker and darker.
float fade(float elevation) {
  const float share = std::max(1 + 2.5f * std::sin(elevation), 0.0f);
  return share * share * share;
}

}  // namespace

Image draw(const SingleScatteringSky& sky, int threads) {
  const SingleScattering model(sky);
  // Blender takes the colours at pixels' corners.
  const SkyGrid grid{.width = 512, .height = 256, .place = {.row = 0, .column = 0}};
  std::vector<Color> horizon;
  for (int x = 0; 2 * x < grid.width; ++x) horizon.push_back(model.color(0, azimuth_of(grid, x)));
  const auto color_of = [&](SkyPlace place) {
    if (place.elevation >= 0) return model.color(place.elevation, place.azimuth);
    return horizon[static_cast<std::size_t>(place.column)] * fade(place.elevation);
  };
  return draw_sky_grid(grid, color_of, threads);
}

SunDisc sun_of(const SingleScatteringSky& sky) { return SingleScattering(sky).sun(); }

}  // namespace basicrt
