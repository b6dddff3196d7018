// SPDX-License-Identifier: GPL-3.0-or-later
// How a luminaire spreads its light, as it was measured.
#pragma once

#include <string_view>
#include <vector>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

// Blender's IES Texture: values at horizontal and vertical angles, interpolated by cubic splines. Beyond the angles it
// is 0. Vertical angles are counted from -z, horizontal ones about z from -y towards -x.
struct IesOperation {
  ColorInput vector{Vec3f(0.0f, 0.0f, -1.0f)};
  NumberInput strength = 1.0f;
  std::vector<float> horizontal{0.0f, 6.2831855f}, vertical{0.0f, 3.1415927f};  // radians, ascending
  std::vector<float> values{1, 1, 1, 1};  // for each horizontal angle one for each vertical

  bool operator==(const IesOperation&) const = default;
  static constexpr std::string_view kind = "ies";
  static constexpr auto fields() {
    using I = IesOperation;
    return fields_of(
        field("vector", &I::vector, "the direction, of any length: its angles are looked up"),
        field("strength", &I::strength, "multiplies the value"),
        field("horizontal", &I::horizontal, "angles about z, from -y towards -x, radians, ascending"),
        field("vertical", &I::vertical, "angles from -z, radians, ascending"),
        field("values", &I::values, "for each horizontal angle, one for each vertical angle; interpolated by cubics"));
  }
};

[[nodiscard]] Vec3f eval(const IesOperation& node, const Evaluator& in);

}  // namespace basicrt
