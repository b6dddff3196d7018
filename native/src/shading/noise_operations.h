// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth and white noise over one to four dimensions.
#pragma once

#include <array>
#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class NoiseKind : std::uint8_t { multifractal, fbm, hybrid_multifractal, ridged_multifractal, hetero_terrain };
template <>
inline constexpr std::array enum_names<NoiseKind> = std::to_array<std::string_view>(
    {"multifractal", "fbm", "hybrid_multifractal", "ridged_multifractal", "hetero_terrain"});

struct NoiseOperation {
  NoiseKind noise = NoiseKind::fbm;
  int dimensions = 3;
  ColorInput vector{Vec3f(0.0f)};
  NumberInput w = 0.0f, scale = 5.0f, detail = 2.0f, roughness = 0.5f, lacunarity = 2.0f, offset = 0.0f, gain = 1.0f,
              distortion = 0.0f;
  bool is_normalized = true, gives_color = false;

  bool operator==(const NoiseOperation&) const = default;
  static constexpr std::string_view kind = "noise";
  static constexpr auto fields() {
    using N = NoiseOperation;
    return fields_of(
        field("noise", &N::noise, "multifractal, fbm, hybrid_multifractal, ridged_multifractal or hetero_terrain"),
        field("dimensions", &N::dimensions, "of w alone, of the vector, or of both", within(1, 4)),
        field("vector", &N::vector, "where"), field("w", &N::w, "of one and of four dimensions"),
        field("scale", &N::scale, "multiplies both"), field("detail", &N::detail, "octaves, less one"),
        field("roughness", &N::roughness, "an octave's share of the one before"),
        field("lacunarity", &N::lacunarity, "an octave's frequency over that of the one before"),
        field("offset", &N::offset, "of hybrid, ridged and hetero terrain"),
        field("gain", &N::gain, "of hybrid and ridged"),
        field("distortion", &N::distortion, "how far noise moves the point"),
        field("normalize", &N::is_normalized, "fbm: within [0, 1]"),
        field("color", &N::gives_color, "gives three noises instead of one"));
  }
};

struct WhiteNoiseOperation {
  int dimensions = 3;
  ColorInput vector{Vec3f(0.0f)};
  NumberInput w = 0.0f;
  bool gives_color = false;

  bool operator==(const WhiteNoiseOperation&) const = default;
  static constexpr std::string_view kind = "white_noise";
  static constexpr auto fields() {
    using W = WhiteNoiseOperation;
    return fields_of(field("dimensions", &W::dimensions, "of w alone, of the vector, or of both", within(1, 4)),
                     field("vector", &W::vector, "where"), field("w", &W::w, "of one and of four dimensions"),
                     field("color", &W::gives_color, "gives three numbers instead of one"));
  }
};

[[nodiscard]] Vec3f eval(const NoiseOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const WhiteNoiseOperation& node, const Evaluator& in);

}  // namespace basicrt
