// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic of numbers and vectors. What has no value (a division by zero) gives 0, as in Blender.
#pragma once

#include <array>
#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class MathKind : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  multiply_add,
  power,
  logarithm,
  sqrt,
  inverse_sqrt,
  absolute,
  exponent,
  minimum,
  maximum,
  less_than,
  greater_than,
  sign,
  compare,
  smooth_min,
  smooth_max,
  round,
  floor,
  ceil,
  trunc,
  fraction,
  modulo,
  floored_modulo,
  wrap,
  snap,
  pingpong,
  sine,
  cosine,
  tangent,
  arcsine,
  arccosine,
  arctangent,
  arctan2,
  sinh,
  cosh,
  tanh,
  radians,
  degrees
};
template <>
inline constexpr std::array enum_names<MathKind> = std::to_array<std::string_view>(
    {"add",          "subtract",     "multiply", "divide",     "multiply_add",   "power",     "logarithm",
     "sqrt",         "inverse_sqrt", "absolute", "exponent",   "minimum",        "maximum",   "less_than",
     "greater_than", "sign",         "compare",  "smooth_min", "smooth_max",     "round",     "floor",
     "ceil",         "trunc",        "fraction", "modulo",     "floored_modulo", "wrap",      "snap",
     "pingpong",     "sine",         "cosine",   "tangent",    "arcsine",        "arccosine", "arctangent",
     "arctan2",      "sinh",         "cosh",     "tanh",       "radians",        "degrees"});

struct MathOperation {
  MathKind operation = MathKind::add;
  NumberInput a = 0.5f, b = 0.5f, c = 0.5f;
  bool is_clamped = false;

  bool operator==(const MathOperation&) const = default;
  static constexpr std::string_view kind = "math";
  static constexpr auto fields() {
    using M = MathOperation;
    return fields_of(field("operation", &M::operation, "named as in Blender's Math node, in small letters"),
                     field("a", &M::a, "first number"), field("b", &M::b, "second, where there is one"),
                     field("c", &M::c, "third, where there is one"),
                     field("clamp", &M::is_clamped, "limits the result to [0, 1]"));
  }
};

enum class VectorMathKind : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  multiply_add,
  cross_product,
  project,
  reflect,
  refract,
  faceforward,
  dot_product,
  distance,
  length,
  scale,
  normalize,
  absolute,
  power,
  sign,
  minimum,
  maximum,
  floor,
  ceil,
  fraction,
  modulo,
  wrap,
  snap,
  sine,
  cosine,
  tangent
};
template <>
inline constexpr std::array enum_names<VectorMathKind> = std::to_array<std::string_view>(
    {"add",     "subtract",    "multiply",    "divide",   "multiply_add", "cross_product", "project",   "reflect",
     "refract", "faceforward", "dot_product", "distance", "length",       "scale",         "normalize", "absolute",
     "power",   "sign",        "minimum",     "maximum",  "floor",        "ceil",          "fraction",  "modulo",
     "wrap",    "snap",        "sine",        "cosine",   "tangent"});

struct VectorMathOperation {
  VectorMathKind operation = VectorMathKind::add;
  ColorInput a{Vec3f(0.0f)}, b{Vec3f(0.0f)}, c{Vec3f(0.0f)};
  NumberInput scale = 1.0f;

  bool operator==(const VectorMathOperation&) const = default;
  static constexpr std::string_view kind = "vector_math";
  static constexpr auto fields() {
    using M = VectorMathOperation;
    return fields_of(field("operation", &M::operation, "named as in Blender's Vector Math node, in small letters"),
                     field("a", &M::a, "first vector"), field("b", &M::b, "second, where there is one"),
                     field("c", &M::c, "third, where there is one"),
                     field("scale", &M::scale, "of scale; the refractive index of refract"));
  }
};

enum class RangeInterpolation : std::uint8_t { linear, stepped, smoothstep, smootherstep };
template <>
inline constexpr std::array enum_names<RangeInterpolation> =
    std::to_array<std::string_view>({"linear", "stepped", "smoothstep", "smootherstep"});

// Each component by itself.
struct MapRangeOperation {
  ColorInput value{Vec3f(1.0f)}, from_min{Vec3f(0.0f)}, from_max{Vec3f(1.0f)}, to_min{Vec3f(0.0f)}, to_max{Vec3f(1.0f)},
      steps{Vec3f(4.0f)};
  RangeInterpolation interpolation = RangeInterpolation::linear;
  bool is_clamped = true;

  bool operator==(const MapRangeOperation&) const = default;
  static constexpr std::string_view kind = "map_range";
  static constexpr auto fields() {
    using M = MapRangeOperation;
    return fields_of(
        field("value", &M::value, "each number of it by itself"), field("from_min", &M::from_min, "becomes to_min"),
        field("from_max", &M::from_max, "becomes to_max"), field("to_min", &M::to_min, "what from_min becomes"),
        field("to_max", &M::to_max, "what from_max becomes"), field("steps", &M::steps, "stepped: how many"),
        field("interpolation", &M::interpolation, "linear, stepped, smoothstep or smootherstep"),
        field("clamp", &M::is_clamped, "limits linear and stepped results to the new range"));
  }
};

enum class Component : std::uint8_t { x, y, z, average, luminance };
template <>
inline constexpr std::array enum_names<Component> =
    std::to_array<std::string_view>({"x", "y", "z", "average", "luminance"});

// A number of a vector or a colour.
struct ComponentOperation {
  ColorInput value{Vec3f(0.0f)};
  Component component = Component::x;

  bool operator==(const ComponentOperation&) const = default;
  static constexpr std::string_view kind = "component";
  static constexpr auto fields() {
    return fields_of(field("value", &ComponentOperation::value, "a vector or a colour"),
                     field("component", &ComponentOperation::component, "x, y, z, average or luminance"));
  }
};

struct CombineOperation {
  NumberInput x = 0.0f, y = 0.0f, z = 0.0f;

  bool operator==(const CombineOperation&) const = default;
  static constexpr std::string_view kind = "combine";
  static constexpr auto fields() {
    return fields_of(field("x", &CombineOperation::x, "first number"),
                     field("y", &CombineOperation::y, "second number"),
                     field("z", &CombineOperation::z, "third number"));
  }
};

[[nodiscard]] Vec3f eval(const MathOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const VectorMathOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const MapRangeOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const ComponentOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const CombineOperation& node, const Evaluator& in);

}  // namespace basicrt
