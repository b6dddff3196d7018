// SPDX-License-Identifier: GPL-3.0-or-later
// What a ray sees that hits nothing: the same radiance from everywhere, pictures around the scene, and skies.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "image/environment_projection.h"
#include "image/image_lookup.h"
#include "light/light_group.h"
#include "light/sky.h"
#include "math/color.h"
#include "math/transform.h"

namespace basicrt {

enum class EnvironmentRays : std::uint8_t { all, camera, scattered };
template <>
inline constexpr std::array enum_names<EnvironmentRays> =
    std::to_array<std::string_view>({"all", "camera", "scattered"});

// All layers that a ray sees add up.
struct EnvironmentLayer {
  Color radiance{1.0f};
  Image image;                  // none: the same from everywhere
  std::optional<Sky> sky = {};  // instead of an image
  EnvironmentProjection projection = EnvironmentProjection::equirectangular;
  ImageInterpolation interpolation = ImageInterpolation::linear;
  Transform to_image;  // of a direction of unit length, as if that were a point
  EnvironmentRays seen_by = EnvironmentRays::all;
  static constexpr auto fields() {
    using L = EnvironmentLayer;
    return fields_of(
        field("radiance", &L::radiance, "W / (m^2 sr); multiplies the image or sky where there is one", at_least(0)),
        field("projection", &L::projection, "of the image: equirectangular, mirror_ball or horizon"),
        field("interpolation", &L::interpolation, "between pixels: linear, closest or cubic"),
        field("transform", &L::to_image, "of a direction, as a point, before the image or sky is looked up"),
        field("seen_by", &L::seen_by, "which rays see it: all, those from the camera, or those that have scattered"));
  }
};

struct Environment {
  Color radiance{0.0f};
  std::vector<EnvironmentLayer> layers;
  int light_group = 0;
  static constexpr auto fields() {
    return fields_of(
        field("radiance", &Environment::radiance, "W / (m^2 sr), each direction alike", at_least(0)),
        field("light_group", &Environment::light_group,
              "its light is in the pass Light Group of this number too; 0: in none", within(0, light_groups)));
  }
};

// What arrives from a direction of unit length, by whatever rays see the layer. Skies must have been drawn: a layer is
// its image.
[[nodiscard]] Color eval_layer(const EnvironmentLayer& layer, Vec3f direction);
[[nodiscard]] Color eval_environment(const Environment& environment, Vec3f direction, bool is_camera_ray);

}  // namespace basicrt
