// SPDX-License-Identifier: GPL-3.0-or-later
// Points and directions moved, turned and taken to other spaces.
#pragma once

#include <array>
#include <string_view>

#include "base/describe.h"
#include "math/transform.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class MappingKind : std::uint8_t { point, texture, vector, normal };
template <>
inline constexpr std::array enum_names<MappingKind> =
    std::to_array<std::string_view>({"point", "texture", "vector", "normal"});

// Blender's Mapping node. Rotations are about x, then y, then z.
struct MappingOperation {
  MappingKind mapping = MappingKind::point;
  ColorInput vector{Vec3f(0.0f)}, location{Vec3f(0.0f)}, rotation{Vec3f(0.0f)}, scale{Vec3f(1.0f)};

  bool operator==(const MappingOperation&) const = default;
  static constexpr std::string_view kind = "mapping";
  static constexpr auto fields() {
    using M = MappingOperation;
    return fields_of(field("mapping", &M::mapping, "what is mapped: point, texture (backwards), vector or normal"),
                     field("vector", &M::vector, "what is mapped"), field("location", &M::location, "added"),
                     field("rotation", &M::rotation, "radians about x, then y, then z"),
                     field("scale", &M::scale, "multiplied before the rotation"));
  }
};

enum class RotateKind : std::uint8_t { axis_angle, x_axis, y_axis, z_axis, euler_xyz };
template <>
inline constexpr std::array enum_names<RotateKind> =
    std::to_array<std::string_view>({"axis_angle", "x_axis", "y_axis", "z_axis", "euler_xyz"});

struct RotateOperation {
  RotateKind about = RotateKind::axis_angle;
  ColorInput vector{Vec3f(0.0f)}, center{Vec3f(0.0f)}, axis{Vec3f(0, 0, 1)}, rotation{Vec3f(0.0f)};
  NumberInput angle = 0.0f;
  bool is_inverted = false;

  bool operator==(const RotateOperation&) const = default;
  static constexpr std::string_view kind = "rotate";
  static constexpr auto fields() {
    using R = RotateOperation;
    return fields_of(field("about", &R::about, "axis_angle, x_axis, y_axis, z_axis or euler_xyz"),
                     field("vector", &R::vector, "what is turned"), field("center", &R::center, "stays where it is"),
                     field("axis", &R::axis, "axis_angle: of any length"),
                     field("rotation", &R::rotation, "euler_xyz: radians about x, then y, then z"),
                     field("angle", &R::angle, "radians"), field("invert", &R::is_inverted, "turns the other way"));
  }
};

enum class VectorKind : std::uint8_t { point, vector, normal };
template <>
inline constexpr std::array enum_names<VectorKind> = std::to_array<std::string_view>({"point", "vector", "normal"});

struct TransformOperation {
  ColorInput vector{Vec3f(0.0f)};
  Transform transform;
  VectorKind quantity = VectorKind::point;

  bool operator==(const TransformOperation&) const = default;
  static constexpr std::string_view kind = "transform";
  static constexpr auto fields() {
    return fields_of(field("vector", &TransformOperation::vector, "what is transformed"),
                     field("transform", &TransformOperation::transform, "of columns, rows first"),
                     field("quantity", &TransformOperation::quantity, "what it is: point, vector or normal"));
  }
};

enum class Space : std::uint8_t { world, object, camera };
template <>
inline constexpr std::array enum_names<Space> = std::to_array<std::string_view>({"world", "object", "camera"});

struct ChangeSpaceOperation {
  ColorInput vector{Vec3f(0.0f)};
  Space source = Space::world, target = Space::object;
  VectorKind quantity = VectorKind::point;

  bool operator==(const ChangeSpaceOperation&) const = default;
  static constexpr std::string_view kind = "change_space";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(
        field("vector", &ChangeSpaceOperation::vector, "what is transformed"),
        field("source", &ChangeSpaceOperation::source, "world, object or camera (where z points forwards)"),
        field("target", &ChangeSpaceOperation::target, "world, object or camera (where z points forwards)"),
        field("quantity", &ChangeSpaceOperation::quantity, "what it is: point, vector or normal"));
  }
};

[[nodiscard]] Vec3f eval(const MappingOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const RotateOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const TransformOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const ChangeSpaceOperation& node, const Evaluator& in);

}  // namespace basicrt
