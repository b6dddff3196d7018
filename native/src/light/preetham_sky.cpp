// SPDX-License-Identifier: GPL-3.0-or-later
// Preetham, Shirley and Smits 1999: luminance and chromaticity at the zenith, and Perez' five-parameter formula for how
// they change over the sky, all fitted to simulations.
#include <algorithm>
#include <array>
#include <cmath>

#include "light/sky_grid.h"
#include "light/sky_models.h"
#include "math/constants.h"

namespace basicrt {
namespace {

// From kcd / m^2 to what Blender shows.
constexpr float blender_scale = 0.06f;
// The formula has a pole at the horizon; from here down the sky stays as it is.
constexpr float largest_zenith_angle = pi / 2 - 0.001f;

// Perez' formula: the darkening towards the horizon (a, b), the glow around the sun (c, d), backscattering (e).
struct Perez {
  float a, b, c, d, e;

  [[nodiscard]] float at(float zenith_angle, float sun_angle) const {
    const float cos_sun = std::cos(sun_angle);
    return (1 + a * std::exp(b / std::cos(zenith_angle))) * (1 + c * std::exp(d * sun_angle) + e * cos_sun * cos_sun);
  }
};

// Table 2 of the paper.
Perez luminance_of(float t) {
  return {0.1787f * t - 1.4630f, -0.3554f * t + 0.4275f, -0.0227f * t + 5.3251f, 0.1206f * t - 2.5771f,
          -0.0670f * t + 0.3703f};
}
Perez chromaticity_x_of(float t) {
  return {-0.0193f * t - 0.2592f, -0.0665f * t + 0.0008f, -0.0004f * t + 0.2125f, -0.0641f * t - 0.8989f,
          -0.0033f * t + 0.0452f};
}
Perez chromaticity_y_of(float t) {
  return {-0.0167f * t - 0.2608f, -0.0950f * t + 0.0092f, -0.0079f * t + 0.2102f, -0.0441f * t - 1.6537f,
          -0.0109f * t + 0.0529f};
}

// Polynomials of the sun's zenith angle, the constant first, for turbidity to the power 0, 1 and 2.
using ZenithFit = std::array<std::array<float, 4>, 3>;
constexpr ZenithFit zenith_x = {{{0.25886f, 0.06052f, -0.21196f, 0.11693f},
                                 {0.00394f, -0.03202f, 0.06377f, -0.02903f},
                                 {0.0f, 0.00209f, -0.00375f, 0.00166f}}};
constexpr ZenithFit zenith_y = {{{0.26688f, 0.06670f, -0.26756f, 0.15346f},
                                 {0.00516f, -0.04153f, 0.08970f, -0.04214f},
                                 {0.0f, 0.00317f, -0.00610f, 0.00275f}}};

float zenith_chromaticity(const ZenithFit& fit, float turbidity, float sun_zenith) {
  float sum = 0, power = 1;
  for (const auto& [c0, c1, c2, c3] : fit) {
    sum += power * (c0 + sun_zenith * (c1 + sun_zenith * (c2 + sun_zenith * c3)));
    power *= turbidity;
  }
  return sum;
}

// In kcd / m^2.
float zenith_luminance(float turbidity, float sun_zenith) {
  const float chi = (4.0f / 9 - turbidity / 120) * (pi - 2 * sun_zenith);
  return (4.0453f * turbidity - 4.9710f) * std::tan(chi) - 0.2155f * turbidity + 2.4192f;
}

class Preetham {
 public:
  explicit Preetham(const PreethamSky& sky)
      : sun_zenith_(pi / 2 - sky.sun_elevation),
        luminance_{luminance_of(sky.turbidity), zenith_luminance(sky.turbidity, sun_zenith_) * blender_scale},
        x_{chromaticity_x_of(sky.turbidity), zenith_chromaticity(zenith_x, sky.turbidity, sun_zenith_)},
        y_{chromaticity_y_of(sky.turbidity), zenith_chromaticity(zenith_y, sky.turbidity, sun_zenith_)} {}

  [[nodiscard]] Color color(SkyPlace place) const {
    const float zenith = pi / 2 - place.elevation;
    const float cosine =
        std::sin(zenith) * std::sin(sun_zenith_) * std::cos(place.azimuth) + std::cos(zenith) * std::cos(sun_zenith_);
    const float sun_angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
    const float clamped = std::min(zenith, largest_zenith_angle);
    const float brightness = value(luminance_, clamped, sun_angle);
    const float x = value(x_, clamped, sun_angle), y = value(y_, clamped, sun_angle);
    if (y == 0) return Color(0.0f);
    return color_from_xyz({brightness * x / y, brightness, brightness * (1 - x - y) / y});
  }

 private:
  struct Quantity {
    Perez perez;
    float at_zenith;
  };
  [[nodiscard]] float value(const Quantity& quantity, float zenith, float sun_angle) const {
    return quantity.at_zenith * quantity.perez.at(zenith, sun_angle) / quantity.perez.at(0, sun_zenith_);
  }

  float sun_zenith_;
  Quantity luminance_, x_, y_;
};

}  // namespace

Image draw(const PreethamSky& sky, int threads) {
  const Preetham model(sky);
  const SkyGrid fine{.width = 1024, .height = 512, .place = {}};  // for the glow's peak
  return draw_sky_grid(fine, [&](SkyPlace place) { return model.color(place); }, threads);
}

}  // namespace basicrt
