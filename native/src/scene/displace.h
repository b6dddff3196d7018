// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that materials displace: vertices are moved, none are added.
#pragma once

#include "geometry/mesh.h"
#include "scene/prepare.h"

namespace basicrt {

// Whether materials move what an instance is of.
[[nodiscard]] bool is_displaced(const PreparedScene& scene, const PreparedScene::PreparedInstance& instance);

// The mesh of such an instance, with its vertices where they are to be. A vertex is moved once, by the material of the first
// of its triangles that has one that moves things. In motion it is moved by the same at all times. Normals that were
// smooth across an edge still are.
[[nodiscard]] Mesh displaced_mesh(const PreparedScene& scene, std::uint32_t instance, int threads);

}  // namespace basicrt
