// SPDX-License-Identifier: GPL-3.0-or-later
// The names of the kinds of rays, in the order of their bits in RayKind.
#pragma once

#include <array>
#include <string_view>

#include "math/ray.h"

namespace basicrt {

inline constexpr std::array<std::string_view, 6> ray_kind_names = {"camera",       "diffuse", "glossy",
                                                                   "transmission", "volume",  "shadow"};
static_assert(ray_camera == 1u << 0 && ray_diffuse == 1u << 1 && ray_glossy == 1u << 2 && ray_transmission == 1u << 3 &&
              ray_volume == 1u << 4 && ray_shadow == 1u << 5);

}  // namespace basicrt
