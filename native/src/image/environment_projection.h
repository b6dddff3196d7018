// SPDX-License-Identifier: GPL-3.0-or-later
// From directions to places in pictures of everything around, and back.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/describe.h"
#include "math/vec.h"

namespace basicrt {

// How a direction finds its place in a picture. Equirectangular: u = 1/2 - longitude / 2 pi, v = latitude / pi + 1/2,
// so that z is up and x lies in the middle. Mirror ball: as a camera that looks along y sees it in a mirror sphere.
// Horizon: as equirectangular, but v - 1/2 goes with the root of the latitude, so that rows are dense at the horizon.
enum class EnvironmentProjection : std::uint8_t { equirectangular, mirror_ball, horizon };
template <>
inline constexpr std::array enum_names<EnvironmentProjection> =
    std::to_array<std::string_view>({"equirectangular", "mirror_ball", "horizon"});

// For a direction in the picture's own space, of any length.
[[nodiscard]] Vec2f project_direction(EnvironmentProjection projection, Vec3f direction);

// Of unit length, for a place in an equirectangular picture.
[[nodiscard]] Vec3f equirectangular_direction(Vec2f uv);

}  // namespace basicrt
