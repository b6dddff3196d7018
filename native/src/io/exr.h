// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR files: a library of its own, so that the wheel need not carry OpenEXR.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "film/film.h"
#include "image/image.h"

namespace basicrt {

// 32-bit floats, ZIP compressed; Combined as R G B A, other passes as <Pass>.<channel>; of a range of the
// samples, the sums as whole numbers too. Written to a temporary name
// in the same folder, then renamed. Throws SceneError.
void write_exr(const std::filesystem::path& path, const Film& film,
               const std::vector<std::pair<std::string, std::string>>& metadata = {});
// R, G, B and A where present. Row 0 is the bottom row. Throws SceneError.
[[nodiscard]] Image read_exr(const std::filesystem::path& path);

}  // namespace basicrt
