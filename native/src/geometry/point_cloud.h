// SPDX-License-Identifier: GPL-3.0-or-later
// Many spheres in one shape.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "geometry/mesh.h"
#include "math/bounds.h"
#include "math/vec.h"

namespace basicrt {

// Each is an exact sphere with Sphere's texture coordinates.
struct PointCloud {
  std::vector<Vec3f> positions;           // object space, metres
  std::vector<float> radii;               // of each, metres; one of 0 can't be hit
  std::vector<float> randoms;             // of each, or none at all: 0
  std::vector<MeshAttribute> attributes;  // of the domain vertex: one value for each point
  static constexpr std::string_view kind = "points";
};

[[nodiscard]] Bounds3f point_bounds(const PointCloud& cloud, std::uint32_t point);  // empty where its radius is 0
[[nodiscard]] Bounds3f bounds(const PointCloud& cloud);

// Throws SceneError, naming `item`, when a number is not finite or an array has the wrong length.
void validate(const PointCloud& cloud, std::string_view item);

}  // namespace basicrt
