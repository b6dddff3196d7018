// SPDX-License-Identifier: GPL-3.0-or-later
// The integrators by name: a new one is one line here.
#include "integrator/integrator.h"

#include "integrator/intersection_test.h"
#include "integrator/path.h"

namespace basicrt {

std::unique_ptr<Integrator> make_integrator(const PreparedScene& scene) {
  switch (scene.settings.integrator) {
    case IntegratorKind::path:
      return std::make_unique<PathIntegrator>(scene);
    case IntegratorKind::intersection_test:
      return std::make_unique<IntersectionTest>(scene);
  }
  return nullptr;
}

}  // namespace basicrt
