// SPDX-License-Identifier: GPL-3.0-or-later
// PNG, JPEG, HDR and the other formats that stb_image reads.
#pragma once

#include <filesystem>

#include "image/image.h"

namespace basicrt {

// 8-bit files are taken as sRGB and made linear; HDR as linear. Row 0 is the bottom row. Throws SceneError.
[[nodiscard]] Image read_image_file(const std::filesystem::path& path);

}  // namespace basicrt
