// SPDX-License-Identifier: GPL-3.0-or-later
// What a program reads of the surface, the object and the ray; and normals made of it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class SurfaceValue : std::uint8_t {
  position,
  normal,
  true_normal,
  incoming,
  parametric,
  backfacing,
  uv,
  generated,
  object_position,
  object_normal,
  camera_position,
  window,
  reflection,
  tangent,
  object_location,
  object_color,
  object_alpha,
  object_index,
  object_random,
  material_index,
  view_vector,
  view_depth,
  view_distance,
  is_camera_ray,
  is_shadow_ray,
  is_diffuse_ray,
  is_glossy_ray,
  is_transmission_ray,
  is_reflection_ray,
  is_volume_ray,
  is_singular_ray,
  ray_length,
  ray_depth,
  diffuse_depth,
  glossy_depth,
  transmission_depth,
  transparent_depth,
  is_strand,
  strand_intercept,
  strand_length,
  strand_thickness,
  strand_tangent_normal,
  strand_random,
  point_position,
  point_radius,
  point_random
};
template <>
inline constexpr std::array enum_names<SurfaceValue> = std::to_array<std::string_view>({"position",
                                                                                        "normal",
                                                                                        "true_normal",
                                                                                        "incoming",
                                                                                        "parametric",
                                                                                        "backfacing",
                                                                                        "uv",
                                                                                        "generated",
                                                                                        "object_position",
                                                                                        "object_normal",
                                                                                        "camera_position",
                                                                                        "window",
                                                                                        "reflection",
                                                                                        "tangent",
                                                                                        "object_location",
                                                                                        "object_color",
                                                                                        "object_alpha",
                                                                                        "object_index",
                                                                                        "object_random",
                                                                                        "material_index",
                                                                                        "view_vector",
                                                                                        "view_depth",
                                                                                        "view_distance",
                                                                                        "is_camera_ray",
                                                                                        "is_shadow_ray",
                                                                                        "is_diffuse_ray",
                                                                                        "is_glossy_ray",
                                                                                        "is_transmission_ray",
                                                                                        "is_reflection_ray",
                                                                                        "is_volume_ray",
                                                                                        "is_singular_ray",
                                                                                        "ray_length",
                                                                                        "ray_depth",
                                                                                        "diffuse_depth",
                                                                                        "glossy_depth",
                                                                                        "transmission_depth",
                                                                                        "transparent_depth",
                                                                                        "is_strand",
                                                                                        "strand_intercept",
                                                                                        "strand_length",
                                                                                        "strand_thickness",
                                                                                        "strand_tangent_normal",
                                                                                        "strand_random",
                                                                                        "point_position",
                                                                                        "point_radius",
                                                                                        "point_random"});

struct SurfaceOperation {
  SurfaceValue value = SurfaceValue::position;

  bool operator==(const SurfaceOperation&) const = default;
  static constexpr std::string_view kind = "surface";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("value", &SurfaceOperation::value, "what of the point: see docs/scene_format.md"));
  }
};

// A named attribute of the mesh, interpolated.
struct AttributeOperation {
  std::string name;
  float missing = 0;

  bool operator==(const AttributeOperation&) const = default;
  static constexpr std::string_view kind = "attribute";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("name", &AttributeOperation::name, "of the mesh's attribute"),
                     field("missing", &AttributeOperation::missing, "where the mesh has none of that name"));
  }
};

// A named property of the object.
struct ObjectPropertyOperation {
  std::string name;
  float missing = 0;

  bool operator==(const ObjectPropertyOperation&) const = default;
  static constexpr std::string_view kind = "object_property";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("name", &ObjectPropertyOperation::name, "of the object's property"),
                     field("missing", &ObjectPropertyOperation::missing, "where the object has none of that name"));
  }
};

enum class FresnelKind : std::uint8_t { fresnel, layer_fresnel, facing };
template <>
inline constexpr std::array enum_names<FresnelKind> =
    std::to_array<std::string_view>({"fresnel", "layer_fresnel", "facing"});

struct FresnelOperation {
  FresnelKind of = FresnelKind::fresnel;
  NumberInput value = 1.5f;
  ColorInput normal{Vec3f(0.0f)};

  bool operator==(const FresnelOperation&) const = default;
  static constexpr std::string_view kind = "fresnel";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("of", &FresnelOperation::of, "fresnel, or Blender's Layer Weight: layer_fresnel or facing"),
                     field("value", &FresnelOperation::value, "the refractive index, or the layer weight's blend"),
                     field("normal", &FresnelOperation::normal, "world space; zero is the surface's own"));
  }
};

enum class NormalMapSpace : std::uint8_t { tangent, object, world };
template <>
inline constexpr std::array enum_names<NormalMapSpace> =
    std::to_array<std::string_view>({"tangent", "object", "world"});

// A normal in world space from a colour.
struct NormalMapOperation {
  ColorInput color{Vec3f(0.5f, 0.5f, 1.0f)};
  NumberInput strength = 1.0f;
  NormalMapSpace space = NormalMapSpace::tangent;
  ColorInput tangent{Vec3f(0.0f)};
  NumberInput tangent_sign = 1.0f;

  bool operator==(const NormalMapOperation&) const = default;
  static constexpr std::string_view kind = "normal_map";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("color", &NormalMapOperation::color, "the normal, halved and moved by a half"),
                     field("strength", &NormalMapOperation::strength, "0 is the surface's own normal", at_least(0)),
                     field("space", &NormalMapOperation::space, "tangent, object or world"),
                     field("tangent", &NormalMapOperation::tangent,
                           "an operation that gives the colour's x axis, object space; else it is that of uv"),
                     field("tangent_sign", &NormalMapOperation::tangent_sign,
                           "the y axis is so often the normal cross the tangent"));
  }
};

// Along the surface, as near as can be to a direction that turns as the object's normals do.
struct TangentOperation {
  ColorInput direction{Vec3f(0.0f)};

  bool operator==(const TangentOperation&) const = default;
  static constexpr std::string_view kind = "tangent";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("direction", &TangentOperation::direction, "object space; zero gives zero"));
  }
};

// 1 near the edges of the mesh's triangles, else 0.
struct WireframeOperation {
  NumberInput size = 0.01f;
  bool is_in_pixels = false;

  bool operator==(const WireframeOperation&) const = default;
  static constexpr std::string_view kind = "wireframe";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("size", &WireframeOperation::size, "width of the edges, metres"),
                     field("in_pixels", &WireframeOperation::is_in_pixels, "the size is in pixels"));
  }
};

// The normal of the surface, in world space, were it raised by a height (Blinn 1978, "Simulation of wrinkled surfaces";
// Mikkelsen 2010, "Bump mapping unparametrized surfaces on the GPU").
struct BumpOperation {
  NumberInput height = 1.0f;
  NumberInput strength = 1.0f, distance = 1.0f;
  ColorInput normal{Vec3f(0.0f)};
  bool is_inverted = false;
  float filter_width = 1;
  bool is_local = false, is_undisplaced = false;
  // The operations that the height needs, in order: compile() finds them. None: all that come before.
  std::vector<std::uint32_t> steps;

  bool operator==(const BumpOperation&) const = default;
  static constexpr std::string_view kind = "bump";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("height", &BumpOperation::height, "an operation that gives metres over distance"),
                     field("strength", &BumpOperation::strength, "0 is the normal as it was", at_least(0)),
                     field("distance", &BumpOperation::distance, "multiplies the height"),
                     field("normal", &BumpOperation::normal, "world space; zero is the surface's own"),
                     field("invert", &BumpOperation::is_inverted, "bumps become dents"),
                     field("filter_width", &BumpOperation::filter_width,
                           "how far apart the height is looked at, in pixels", above(0)),
                     field("local", &BumpOperation::is_local, "the distance is in object space"),
                     field("undisplaced", &BumpOperation::is_undisplaced,
                           "the bumps are those of the surface as it was before it was displaced, in object space"));
  }
};

[[nodiscard]] Vec3f eval(const SurfaceOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const AttributeOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const ObjectPropertyOperation& node, const Evaluator& in);
// Of the surface, on the viewer's side.
[[nodiscard]] Vec3f viewed_normal(const Evaluator& in);
// The shading normal that the surface had before it was displaced, on the same side of it as its normals were.
[[nodiscard]] Vec3f undisplaced_normal(const Evaluator& in);
[[nodiscard]] Vec3f eval(const FresnelOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const NormalMapOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const TangentOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const WireframeOperation& node, const Evaluator& in);

// How the height changes: its values here and at two points beside, which lie at dpdx and dpdy from here.
struct HeightChange {
  float here = 0, at_dx = 0, at_dy = 0;
  Vec3f dpdx, dpdy;
};
[[nodiscard]] Vec3f bumped_normal(const BumpOperation& node, const Evaluator& in, const HeightChange& height);

// Whether a SurfacePoint must have its derivatives for this.
[[nodiscard]] inline bool needs_derivatives(const SurfaceOperation& node) {
  return node.value == SurfaceValue::tangent || node.value == SurfaceValue::strand_tangent_normal;
}
[[nodiscard]] inline bool needs_derivatives(const NormalMapOperation& node) {
  return node.space == NormalMapSpace::tangent && !node.tangent.is_varying();
}
[[nodiscard]] inline bool needs_derivatives(const auto& /*others*/) { return false; }

}  // namespace basicrt
