// SPDX-License-Identifier: GPL-3.0-or-later
// Clear skies, computed from where the sun stands and what is in the air.
#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include "base/describe.h"
#include "image/image.h"
#include "light/sun_disc.h"

namespace basicrt {

// Where the sun is, whatever the sky; z is up.
template <class Sky>
constexpr auto sun_place() {
  return fields_of(field("sun_elevation", &Sky::sun_elevation, "above the horizon, radians"),
                   field("sun_rotation", &Sky::sun_rotation, "from y towards x, radians"));
}

// The sun's disc, and the air around a round planet: 1 is as dense as over a city.
template <class Sky>
constexpr auto sun_and_air() {
  return joined(sun_place<Sky>(),
                fields_of(field("sun_disc", &Sky::has_sun_disc, "the sun itself is seen and sends light"),
                          field("sun_size", &Sky::sun_size, "full angle of the disc, radians", within(0, 1.570797)),
                          field("sun_intensity", &Sky::sun_intensity, "of the disc", at_least(0)),
                          field("altitude", &Sky::altitude, "of the eye above the sea, metres", at_least(0)),
                          field("air_density", &Sky::air_density, "molecules", at_least(0)),
                          field("aerosol_density", &Sky::aerosol_density, "dust and droplets", at_least(0)),
                          field("ozone_density", &Sky::ozone_density, "ozone high above", at_least(0))));
}

// Preetham et al. 1999, "A practical analytic model for daylight". It has no sun disc.
struct PreethamSky {
  float sun_elevation = 0.261799f, sun_rotation = 0;
  float turbidity = 2.2f;
  static constexpr std::string_view kind = "preetham";
  static constexpr auto fields() {
    return joined(sun_place<PreethamSky>(),
                  fields_of(field("turbidity", &PreethamSky::turbidity, "haze: 2 is clear, 10 hazy", within(1, 10))));
  }
};

// Nishita et al. 1993: light that is scattered once on its way. Black well below the horizon.
struct SingleScatteringSky {
  float sun_elevation = 0.261799f, sun_rotation = 0;
  bool has_sun_disc = true;
  float sun_size = 0.009512f, sun_intensity = 1;
  float altitude = 100;
  float air_density = 1, aerosol_density = 1, ozone_density = 1;
  static constexpr std::string_view kind = "single_scattering";
  static constexpr auto fields() { return sun_and_air<SingleScatteringSky>(); }
};

// Light that is scattered any number of times, and reflected by the ground.
struct MultipleScatteringSky {
  float sun_elevation = 0.261799f, sun_rotation = 0;
  bool has_sun_disc = true;
  float sun_size = 0.009512f, sun_intensity = 1;
  float altitude = 100;
  float air_density = 1, aerosol_density = 1, ozone_density = 1;
  static constexpr std::string_view kind = "multiple_scattering";
  static constexpr auto fields() { return sun_and_air<MultipleScatteringSky>(); }
};

using Sky = std::variant<PreethamSky, SingleScatteringSky, MultipleScatteringSky>;

// A sky has a space of its own: z is up, and the sun stands over the x axis.

// Without the sun's disc. EnvironmentProjection::horizon; values may be below 0, where colours are outside of Rec.709.
// Takes so many threads, 0: one per processor.
[[nodiscard]] Image draw_sky(const Sky& sky, int threads);
[[nodiscard]] std::optional<SunDisc> find_sun(const Sky& sky);
// The angle from the x axis to the sun, counter-clockwise as seen from above.
[[nodiscard]] float sun_azimuth(const Sky& sky);

}  // namespace basicrt
