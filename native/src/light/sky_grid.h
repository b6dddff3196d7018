// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels of a sky's picture, and their colours by a function of the place in the sky.
#pragma once

#include <functional>

#include "image/image.h"
#include "math/color.h"

namespace basicrt {

// A place in the sky, in radians; the azimuth is from the sun's.
struct SkyPlace {
  float elevation, azimuth;
  int column;  // of the grid, with that azimuth
};

// Where in its pixel a place is: (1/2, 1/2) is its centre, (0, 0) its corner that is lowest and farthest from the sun.
struct PixelPlace {
  float row = 0.5f, column = 0.5f;
};

struct SkyGrid {
  int width = 512, height = 256;
  PixelPlace place;
};

// Of the left half's columns.
[[nodiscard]] float azimuth_of(const SkyGrid& grid, int column);

// EnvironmentProjection::horizon, the sun in the middle. Both halves of a sky are alike: color_of(place) is called for
// places on one side of the sun, from several threads.
[[nodiscard]] Image draw_sky_grid(const SkyGrid& grid, const std::function<Color(SkyPlace)>& color_of, int threads);

// From the CIE's XYZ (2 degrees, 1931) to linear Rec.709 with D65 white.
[[nodiscard]] Color color_from_xyz(Vec3f xyz);

}  // namespace basicrt
