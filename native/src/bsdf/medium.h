// SPDX-License-Identifier: GPL-3.0-or-later
// What fills a shape or all space: a volume that is the same everywhere.
#pragma once

#include <vector>

#include "bsdf/phase.h"
#include "math/color.h"
#include "shading/material.h"

namespace basicrt {

// Particles that scatter light in one way.
struct Scatterer {
  Color scattering;  // 1 / m
  Phase phase;
};

struct Medium {
  Color extinction{0.0f};  // by absorption and scattering, 1 / m
  Color scattering{0.0f};  // of all scatterers, 1 / m
  Color emission{0.0f};    // W / (m^3 sr)
  std::vector<Scatterer> scatterers;

  [[nodiscard]] bool is_nothing() const { return is_black(extinction) && is_black(emission); }
};

// Of the nodes that the material's volume reaches: what volumes add up to, surfaces being nothing. Textures count as
// their constants.
[[nodiscard]] Medium make_medium(const Material& material);

}  // namespace basicrt
