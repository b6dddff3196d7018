// SPDX-License-Identifier: GPL-3.0-or-later
// How open the surroundings of a point are: Blender's Ambient Occlusion.
#pragma once

#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

// The share of rays, spread like diffuse light around the normal, that meet nothing within a distance: estimated by so
// many of them each time. 1 where rays can't be sent, as for shadows.
struct AmbientOcclusionOperation {
  NumberInput distance = 1.0f;
  ColorInput normal{Vec3f(0.0f)};
  int samples = 16;
  bool is_inside = false, is_local = false;

  bool operator==(const AmbientOcclusionOperation&) const = default;
  static constexpr std::string_view kind = "ambient_occlusion";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    using A = AmbientOcclusionOperation;
    return fields_of(field("distance", &A::distance, "how far rays go, metres; 0 gives 1"),
                     field("normal", &A::normal, "in world space, on the viewer's side; zero is the surface's own"),
                     field("samples", &A::samples, "rays at each point", within(1, 128)),
                     field("inside", &A::is_inside, "rays go below the surface instead of above"),
                     field("only_local", &A::is_local, "rays meet the object itself alone"));
  }
};

[[nodiscard]] Vec3f eval(const AmbientOcclusionOperation& node, const Evaluator& in);

}  // namespace basicrt
