// SPDX-License-Identifier: GPL-3.0-or-later
// Each model has a file of its own.
#include "light/sky.h"

#include "light/sky_models.h"
#include "math/constants.h"

namespace basicrt {

Image draw_sky(const Sky& sky, int threads) {
  return std::visit([&](const auto& model) { return draw(model, threads); }, sky);
}

std::optional<SunDisc> find_sun(const Sky& sky) {
  return std::visit(
      []<class Model>(const Model& model) -> std::optional<SunDisc> {
        if constexpr (requires { model.has_sun_disc; })
          if (model.has_sun_disc && model.sun_size >= smallest_sun_disc) return sun_of(model);
        return std::nullopt;
      },
      sky);
}

float sun_azimuth(const Sky& sky) {
  return std::visit([](const auto& model) { return pi / 2 - model.sun_rotation; }, sky);
}

}  // namespace basicrt
