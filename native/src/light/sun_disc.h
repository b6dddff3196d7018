// SPDX-License-Identifier: GPL-3.0-or-later
// The sun as a sky shows it: dimmer towards its limb, and redder towards the horizon, which may cut it.
#pragma once

#include "math/color.h"
#include "math/vec.h"

namespace basicrt {

// It stands over the x axis; z is up.
struct SunDisc {
  double elevation = 0, radius = 0;  // radians
  Color low{0.0f}, high{0.0f};       // radiance at its centre, were that as high as its lowest and its highest place
  double horizon = 0;                // nothing below this elevation is seen
};

// Radians: anything narrower is nothing.
inline constexpr float smallest_sun_disc = 1e-6f;

// Of directions of unit length.
[[nodiscard]] Color eval_sun_disc(const SunDisc& disc, Vec3d direction);
[[nodiscard]] Vec3d sample_sun_disc(const SunDisc& disc, Vec2f u);
[[nodiscard]] double pdf_sun_disc(const SunDisc& disc, Vec3d direction);  // over solid angle
// Radiance times solid angle, of the whole disc: about what a surface that faces it receives.
[[nodiscard]] Color sun_disc_irradiance(const SunDisc& disc);

}  // namespace basicrt
