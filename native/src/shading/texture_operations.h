// SPDX-License-Identifier: GPL-3.0-or-later
// Images and simple patterns over any coordinates.
#pragma once

#include <array>
#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

// How a texture is wrapped: flat over x and y; on the six sides of a box, by the normal in object space; around a sphere
// or a tube, which stand upright in the middle of the unit cube; over directions as in EnvironmentProjection.
enum class TextureProjection : std::uint8_t { flat, box, sphere, tube, equirectangular, mirror_ball };
template <>
inline constexpr std::array enum_names<TextureProjection> =
    std::to_array<std::string_view>({"flat", "box", "sphere", "tube", "equirectangular", "mirror_ball"});

// The look-up of a texture of the scene.
struct ImageOperation {
  Id<Texture> texture{};
  ColorInput vector{Vec3f(0.0f)};
  bool is_alpha = false;
  TextureProjection projection = TextureProjection::flat;
  float blend = 0;

  bool operator==(const ImageOperation&) const = default;
  static constexpr std::string_view kind = "texture";
  static constexpr bool reads_point = true;
  static constexpr auto fields() {
    return fields_of(field("texture", &ImageOperation::texture, "of the scene"),
                     field("vector", &ImageOperation::vector, "instead of uv"),
                     field("alpha", &ImageOperation::is_alpha, "gives its alpha instead of its colour"),
                     field("projection", &ImageOperation::projection,
                           "flat: over x and y; box: on six sides, by the normal; sphere and tube: around z; "
                           "equirectangular and mirror_ball: over directions"),
                     field("blend", &ImageOperation::blend, "how softly the sides of the box meet", within(0, 1)));
  }
};

// 1 where the cells' indices add up to an odd number, else 0.
struct CheckerOperation {
  ColorInput vector{Vec3f(0.0f)};
  NumberInput scale = 5.0f;

  bool operator==(const CheckerOperation&) const = default;
  static constexpr std::string_view kind = "checker";
  static constexpr auto fields() {
    return fields_of(field("vector", &CheckerOperation::vector, "where"),
                     field("scale", &CheckerOperation::scale, "cells in one metre"));
  }
};

enum class GradientKind : std::uint8_t { linear, quadratic, easing, diagonal, radial, quadratic_sphere, spherical };
template <>
inline constexpr std::array enum_names<GradientKind> = std::to_array<std::string_view>(
    {"linear", "quadratic", "easing", "diagonal", "radial", "quadratic_sphere", "spherical"});

struct GradientOperation {
  GradientKind gradient = GradientKind::linear;
  ColorInput vector{Vec3f(0.0f)};

  bool operator==(const GradientOperation&) const = default;
  static constexpr std::string_view kind = "gradient";
  static constexpr auto fields() {
    return fields_of(field("gradient", &GradientOperation::gradient,
                           "linear, quadratic, easing, diagonal, radial, quadratic_sphere or spherical"),
                     field("vector", &GradientOperation::vector, "where"));
  }
};

enum class WaveDirection : std::uint8_t { x, y, z, diagonal, spherical };
template <>
inline constexpr std::array enum_names<WaveDirection> =
    std::to_array<std::string_view>({"x", "y", "z", "diagonal", "spherical"});
enum class WaveProfile : std::uint8_t { sine, saw, triangle };
template <>
inline constexpr std::array enum_names<WaveProfile> = std::to_array<std::string_view>({"sine", "saw", "triangle"});

struct WaveOperation {
  bool is_rings = false;
  WaveDirection direction = WaveDirection::x;
  WaveProfile profile = WaveProfile::sine;
  ColorInput vector{Vec3f(0.0f)};
  NumberInput scale = 5.0f, distortion = 0.0f, detail = 2.0f, detail_scale = 1.0f, detail_roughness = 0.5f,
              phase = 0.0f;

  bool operator==(const WaveOperation&) const = default;
  static constexpr std::string_view kind = "wave";
  static constexpr auto fields() {
    using W = WaveOperation;
    return fields_of(field("rings", &W::is_rings, "rings instead of bands"),
                     field("direction", &W::direction, "x, y, z, diagonal (of bands) or spherical (of rings)"),
                     field("profile", &W::profile, "sine, saw or triangle"), field("vector", &W::vector, "where"),
                     field("scale", &W::scale, "multiplies the vector"),
                     field("distortion", &W::distortion, "by noise"), field("detail", &W::detail, "of the noise"),
                     field("detail_scale", &W::detail_scale, "of the noise"),
                     field("detail_roughness", &W::detail_roughness, "of the noise"),
                     field("phase", &W::phase, "moves the waves, radians"));
  }
};

struct MagicOperation {
  int depth = 2;
  ColorInput vector{Vec3f(0.0f)};
  NumberInput scale = 5.0f, distortion = 1.0f;

  bool operator==(const MagicOperation&) const = default;
  static constexpr std::string_view kind = "magic";
  static constexpr auto fields() {
    return fields_of(field("depth", &MagicOperation::depth, "iterations", within(0, 10)),
                     field("vector", &MagicOperation::vector, "where"),
                     field("scale", &MagicOperation::scale, "multiplies the vector"),
                     field("distortion", &MagicOperation::distortion, "how much"));
  }
};

// x is 1 in the mortar, y is the tint of the brick: the share of the second colour.
struct BrickOperation {
  ColorInput vector{Vec3f(0.0f)};
  NumberInput scale = 5.0f, mortar_size = 0.02f, mortar_smooth = 0.1f, bias = 0.0f, brick_width = 0.5f,
              row_height = 0.25f;
  float offset = 0.5f, squash = 1;
  int offset_frequency = 2, squash_frequency = 2;

  bool operator==(const BrickOperation&) const = default;
  static constexpr std::string_view kind = "brick";
  static constexpr auto fields() {
    using B = BrickOperation;
    return fields_of(field("vector", &B::vector, "where"), field("scale", &B::scale, "multiplies the vector"),
                     field("mortar_size", &B::mortar_size, "0 is none"),
                     field("mortar_smooth", &B::mortar_smooth, "0 is a sharp edge"),
                     field("bias", &B::bias, "-1 is all the first colour, 1 all the second"),
                     field("brick_width", &B::brick_width, "of a brick"),
                     field("row_height", &B::row_height, "of a row"), field("offset", &B::offset, "of shifted rows"),
                     field("squash", &B::squash, "of squashed rows"),
                     field("offset_frequency", &B::offset_frequency, "how often rows are shifted", at_least(0)),
                     field("squash_frequency", &B::squash_frequency, "how often rows are squashed", at_least(0)));
  }
};

[[nodiscard]] Vec3f eval(const ImageOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const CheckerOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const GradientOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const WaveOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const MagicOperation& node, const Evaluator& in);
[[nodiscard]] Vec3f eval(const BrickOperation& node, const Evaluator& in);

}  // namespace basicrt
