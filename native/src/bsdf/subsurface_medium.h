// SPDX-License-Identifier: GPL-3.0-or-later
// What is beneath a surface that lets light in and out: a medium, by what can be seen of it from outside.
#pragma once

#include "bsdf/subsurface.h"

namespace basicrt {

struct SubsurfaceMedium {
  Color extinction;  // 1 / m
  Color albedo;      // of one scattering
  float anisotropy;  // of its Henyey-Greenstein phase function
  // What light is multiplied by on entering, so that a thick body comes out in its colour.
  Color weight;
};

[[nodiscard]] SubsurfaceMedium make_medium(const Subsurface& subsurface);

}  // namespace basicrt
