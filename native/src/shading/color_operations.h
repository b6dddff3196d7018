// SPDX-License-Identifier: GPL-3.0-or-later
// Colours mixed, looked up and changed.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class BlendKind : std::uint8_t {
  mix,
  darken,
  multiply,
  burn,
  lighten,
  screen,
  dodge,
  add,
  overlay,
  soft_light,
  linear_light,
  difference,
  exclusion,
  subtract,
  divide,
  hue,
  saturation,
  color,
  value
};
template <>
inline constexpr std::array enum_names<BlendKind> = std::to_array<std::string_view>(
    {"mix", "darken", "multiply", "burn", "lighten", "screen", "dodge", "add", "overlay", "soft_light", "linear_light",
     "difference", "exclusion", "subtract", "divide", "hue", "saturation", "color", "value"});

struct MixOperation {
  BlendKind blend = BlendKind::mix;
  ColorInput factor{Vec3f(0.5f)}, a{Vec3f(0.5f)}, b{Vec3f(0.5f)};
  bool is_factor_clamped = true, is_result_clamped = false;

  bool operator==(const MixOperation&) const = default;
  static constexpr std::string_view kind = "mix";
  static constexpr auto fields() {
    using M = MixOperation;
    return fields_of(field("blend", &M::blend, "named as in Blender's Mix node, in small letters"),
                     field("factor", &M::factor, "0 is all a, 1 all b blended; only mix has one for each channel"),
                     field("a", &M::a, "first colour"), field("b", &M::b, "second colour"),
                     field("clamp_factor", &M::is_factor_clamped, "limits the factor to [0, 1]"),
                     field("clamp", &M::is_result_clamped, "limits the result to [0, 1]"));
  }
};

// A table of colours over a range, equally spaced: what colour ramps and curves are made into.
struct TableOperation {
  ColorInput value{Vec3f(0.5f)};
  NumberInput factor = 1.0f;
  std::vector<float> colors{0, 0, 0, 1, 1, 1};  // three numbers each, at least one colour
  float minimum = 0, maximum = 1;
  bool is_interpolated = true, is_extrapolated = false;

  bool operator==(const TableOperation&) const = default;
  static constexpr std::string_view kind = "table";
  static constexpr auto fields() {
    using T = TableOperation;
    return fields_of(field("value", &T::value, "what is looked up, each channel by itself"),
                     field("factor", &T::factor, "0 leaves the value as it is"),
                     field("colors", &T::colors, "three numbers for each entry"),
                     field("minimum", &T::minimum, "the first entry's value"),
                     field("maximum", &T::maximum, "the last entry's value"),
                     field("interpolate", &T::is_interpolated, "linearly between entries"),
                     field("extrapolate", &T::is_extrapolated, "beyond the ends straight on, else constant"));
  }
};

enum class ColorModel : std::uint8_t { rgb, hsv, hsl };
template <>
inline constexpr std::array enum_names<ColorModel> = std::to_array<std::string_view>({"rgb", "hsv", "hsl"});

struct ConvertColorOperation {
  ColorInput color{Vec3f(0.8f)};
  ColorModel source = ColorModel::rgb, target = ColorModel::hsv;

  bool operator==(const ConvertColorOperation&) const = default;
  static constexpr std::string_view kind = "convert_color";
  static constexpr auto fields() {
    return fields_of(field("color", &ConvertColorOperation::color, "three numbers"),
                     field("source", &ConvertColorOperation::source, "what they are: rgb, hsv or hsl"),
                     field("target", &ConvertColorOperation::target, "what they become: rgb, hsv or hsl"));
  }
};

struct HueSaturationOperation {
  ColorInput color{Vec3f(0.8f)};
  NumberInput hue = 0.5f, saturation = 1.0f, value = 1.0f, factor = 1.0f;

  bool operator==(const HueSaturationOperation&) const = default;
  static constexpr std::string_view kind = "hue_saturation";
  static constexpr auto fields() {
    using H = HueSaturationOperation;
    return fields_of(field("color", &H::color, "the colour to change"),
                     field("hue", &H::hue, "0.5 leaves it as it is; 1 is once around"),
                     field("saturation", &H::saturation, "multiplies the saturation"),
                     field("value", &H::value, "multiplies the value"),
                     field("factor", &H::factor, "0 leaves the colour as it is"));
  }
};

enum class ToneKind : std::uint8_t { gamma, bright_contrast, invert };
template <>
inline constexpr std::array enum_names<ToneKind> =
    std::to_array<std::string_view>({"gamma", "bright_contrast", "invert"});

// Each channel by itself.
struct ToneOperation {
  ToneKind change = ToneKind::gamma;
  ColorInput color{Vec3f(0.8f)};
  NumberInput a = 1.0f, b = 0.0f;

  bool operator==(const ToneOperation&) const = default;
  static constexpr std::string_view kind = "tone";
  static constexpr auto fields() {
    using T = ToneOperation;
    return fields_of(field("change", &T::change, "gamma, bright_contrast or invert"),
                     field("color", &T::color, "the colour to change"),
                     field("a", &T::a, "the exponent, the brightness, or the share that is inverted"),
                     field("b", &T::b, "bright_contrast: the contrast"));
  }
};

[[nodiscard]] Vec3f eval(const MixOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const TableOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const ConvertColorOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const HueSaturationOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const ToneOperation& node, const Evaluator& in);

}  // namespace basicrt
