// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ meshes.
#pragma once

#include <filesystem>

#include "base/report.h"
#include "geometry/mesh.h"

namespace basicrt {

// Polygons are triangulated. Where a face has normals it is wound to agree with them. Throws SceneError.
[[nodiscard]] Mesh read_obj(const std::filesystem::path& path, Report& report);

}  // namespace basicrt
