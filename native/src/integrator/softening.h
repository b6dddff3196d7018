// SPDX-License-Identifier: GPL-3.0-or-later
// What Blender offers to trade truth for less noise: clamping, blurred caustics, none at all. All of it is off in a
// neutral picture.
#pragma once

#include <algorithm>
#include <cmath>

#include "bsdf/bsdf.h"
#include "math/color.h"
#include "scene/settings.h"

namespace basicrt {

// Light that a path adds, scaled down to where r, g and b have the mean `limit`; a limit of 0 is none.
[[nodiscard]] inline Color clamp_light(Color radiance, float limit) {
  const float mean = average(radiance);
  return limit > 0 && mean > limit ? radiance * (limit / mean) : radiance;
}

// Whether soften_caustics() does anything.
[[nodiscard]] inline bool softens_caustics(const RenderSettings& settings) {
  return settings.blur_glossy > 0 || !settings.has_reflective_caustics || !settings.has_refractive_caustics;
}

// Caustics are what a diffuse reflection gathers by way of mirrors and glass: where they are switched off, a surface met
// after one has no such lobes. Filter Glossy instead roughens whatever is met after a scattering that blurs anyhow. How
// much one blurs, its density says: with `least_pdf` the least of the path's, alpha is made sqrt(1 - least_pdf /
// blur_glossy) / 2 or more. That is Cycles' rule; it leaves the weights of lobes as they were before.
inline void soften_caustics(const RenderSettings& settings, bool is_after_diffuse, float least_pdf, Bsdf& bsdf) {
  if (is_after_diffuse && !(settings.has_reflective_caustics && settings.has_refractive_caustics))
    bsdf.remove_glossy(!settings.has_reflective_caustics, !settings.has_refractive_caustics);
  if (settings.blur_glossy > 0 && least_pdf < settings.blur_glossy)
    bsdf.roughen(std::sqrt(1 - least_pdf / settings.blur_glossy) / 2);
}

}  // namespace basicrt
