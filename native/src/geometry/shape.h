// SPDX-License-Identifier: GPL-3.0-or-later
// What an instance can place: a closed set of kinds of geometry.
#pragma once

#include <string_view>
#include <variant>

#include "base/describe.h"
#include "geometry/curves.h"
#include "geometry/mesh.h"
#include "geometry/point_cloud.h"

namespace basicrt {

// A sphere, exact: neither tessellated nor approximated. u is longitude, v latitude, both in [0, 1], poles on z.
struct Sphere {
  Vec3f center;
  float radius = 1;
  static constexpr std::string_view kind = "sphere";
  static constexpr auto fields() {
    return fields_of(field("center", &Sphere::center, "object space, metres"),
                     field("radius", &Sphere::radius, "metres", above(0)));
  }
};

using Shape = std::variant<Mesh, Sphere, PointCloud, Curves>;

[[nodiscard]] Bounds3f bounds(const Shape& shape);
[[nodiscard]] bool is_empty(const Shape& shape);  // a mesh without triangles and the like: nothing can hit it
void validate(const Shape& shape, std::string_view item);

}  // namespace basicrt
