// SPDX-License-Identifier: GPL-3.0-or-later
// Normals that turn around a mesh's edges as if these were rounded: Blender's Bevel.
#pragma once

#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

// The mean normal of what the same object has nearby, estimated by so many rays each time. The surface's own normal where
// rays can't be sent, as for shadows, and on what blurred light arrives at.
struct BevelOperation {
  NumberInput radius = 0.05f;
  ColorInput normal{Vec3f(0.0f)};
  int samples = 4;

  bool operator==(const BevelOperation&) const = default;
  static constexpr std::string_view kind = "bevel";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    using B = BevelOperation;
    return fields_of(field("radius", &B::radius, "of the rounding, metres; 0 gives the normal as it is"),
                     field("normal", &B::normal, "which is turned as the surface's own; world space; zero is that one"),
                     field("samples", &B::samples, "rays at each point", within(1, 128)));
  }
};

[[nodiscard]] Vec3f eval(const BevelOperation& node, const Evaluator& in);

}  // namespace basicrt
