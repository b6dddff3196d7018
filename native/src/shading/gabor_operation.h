// SPDX-License-Identifier: GPL-3.0-or-later
// Waves of one frequency in random places (Lagae et al. 2009, "Procedural noise using sparse Gabor convolution").
#pragma once

#include <array>
#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class GaborOutput : std::uint8_t { value, phase, intensity };
template <>
inline constexpr std::array enum_names<GaborOutput> = std::to_array<std::string_view>({"value", "phase", "intensity"});

struct GaborOperation {
  GaborOutput output = GaborOutput::value;
  int dimensions = 2;
  ColorInput vector{Vec3f(0.0f)}, direction{Vec3f(1, 1, 0)};
  NumberInput scale = 5.0f, frequency = 2.0f, anisotropy = 1.0f, angle = 0.78539816f;

  bool operator==(const GaborOperation&) const = default;
  static constexpr std::string_view kind = "gabor";
  static constexpr auto fields() {
    using G = GaborOperation;
    return fields_of(field("output", &G::output, "value, phase or intensity, all within [0, 1]"),
                     field("dimensions", &G::dimensions, "two or all three of the vector's", within(2, 3)),
                     field("vector", &G::vector, "where"), field("scale", &G::scale, "multiplies it"),
                     field("frequency", &G::frequency, "waves per cell"),
                     field("anisotropy", &G::anisotropy, "1: all waves go one way, 0: any way"),
                     field("angle", &G::angle, "that way in two dimensions, radians"),
                     field("direction", &G::direction, "that way in three dimensions"));
  }
};

[[nodiscard]] Vec3f eval(const GaborOperation& node, const Evaluator& in);

}  // namespace basicrt
