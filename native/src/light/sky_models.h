// SPDX-License-Identifier: GPL-3.0-or-later
// What draw_sky() and find_sun() choose from.
#pragma once

#include "light/sky.h"

namespace basicrt {

[[nodiscard]] Image draw(const PreethamSky& sky, int threads);
[[nodiscard]] Image draw(const SingleScatteringSky& sky, int threads);
[[nodiscard]] Image draw(const MultipleScatteringSky& sky, int threads);

[[nodiscard]] SunDisc sun_of(const SingleScatteringSky& sky);
[[nodiscard]] SunDisc sun_of(const MultipleScatteringSky& sky);

}  // namespace basicrt
