// SPDX-License-Identifier: GPL-3.0-or-later
// Follows light out of the lamp, in all its directions.
#include "scene/lamp_estimate.h"

#include <algorithm>
#include <optional>

#include "sampling/sobol.h"
#include "scene/shade_lamp.h"

namespace basicrt {

float estimate_lamp(const PreparedScene& scene, const PreparedScene::LampMaterial& of_lamp, const Lamp& lamp,
                    const Bounds3f& bounds) {
  constexpr std::uint32_t count = 1024;
  constexpr float least_share = 0.05f;  // of the brightest that was seen
  if (bounds.is_empty()) return 1;
  const Vec3f center = (bounds.lower + bounds.upper) * 0.5f;
  const float radius = std::max(length(bounds.upper - bounds.lower) / 2, 1e-3f);
  const bool is_distant = std::holds_alternative<SunLight>(lamp.kind);
  double sum = 0;
  float most = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::optional<EmissionSample> sample =
        sample_emission(lamp, sobol_2d(i, 1, 2), sobol_2d(i, 3, 4), center, radius);
    if (!sample) continue;
    // Anything from next to the lamp to the other end of the scene.
    const float distance = is_distant ? infinity : 2 * radius * (static_cast<float>(i) + 0.5f) / count;
    const Vec3f wi = -sample->ray.direction;
    const Vec3f place = is_distant ? center : sample->ray.origin - wi * distance;
    const Color emission =
        lamp_emission(scene, of_lamp, {.lamp = lamp, .position = place, .wi = wi, .distance = distance},
                      [](ShadingContext& context) { context.bounces = 1; });
    const float brightness = std::clamp(luminance(emission), 0.0f, 1e30f);
    sum += double(brightness);
    most = std::max(most, brightness);
  }
  const float estimate = std::max(static_cast<float>(sum / count), most * least_share);
  return estimate > 0 ? estimate : 1;
}

}  // namespace basicrt
