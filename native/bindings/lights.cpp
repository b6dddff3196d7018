// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps and the environment.
#include "described.h"
#include "light/light_set.h"
#include "register.h"

namespace basicrt::bindings {

void register_lights(pybind11::module_& m) {
  bind_described<PointLight>(m, "PointLight", "A point, or a sphere that shines alike everywhere.");
  bind_described<SpotLight>(m, "SpotLight", "A point or sphere that shines in a cone.");
  bind_described<SunLight>(m, "SunLight", "Light from infinitely far.");
  bind_described<AreaLight>(m, "AreaLight", "A rectangle or ellipse that shines to one side.");
  bind_described<Environment>(m, "Environment", "What a ray sees that hits nothing.");
}

}  // namespace basicrt::bindings
