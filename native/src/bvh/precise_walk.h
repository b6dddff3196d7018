// SPDX-License-Identifier: GPL-3.0-or-later
// One ray against one shape, all in double precision and in plain C++: for shapes and sizes that kernels leave out.
#pragma once

#include <cstdint>
#include <optional>

#include "bvh/mesh_tree.h"
#include "geometry/hit.h"
#include "geometry/precise_ray.h"
#include "geometry/sphere.h"

namespace basicrt {

// The nearest hit in [t_min, t_max], without its instance. `skipped_primitive` is the triangle that the ray starts on, or Hit::none.
[[nodiscard]] std::optional<Hit> intersect_mesh_precisely(const MeshTree& mesh, PreciseRay ray,
                                                          std::uint32_t skipped_primitive);
// At the ray's time.
[[nodiscard]] std::optional<Hit> intersect_mesh_precisely(const MovingMeshTree& mesh, PreciseRay ray,
                                                          std::uint32_t skipped_primitive);
[[nodiscard]] std::optional<Hit> intersect_sphere_precisely(const Sphere& sphere, PreciseRay ray);

}  // namespace basicrt
