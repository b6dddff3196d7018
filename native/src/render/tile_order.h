// SPDX-License-Identifier: GPL-3.0-or-later
// How a picture is cut into tiles, and which come first.
#pragma once

#include <vector>

#include "film/film.h"

namespace basicrt {

// Tiles that cover the rectangle exactly once, those near its centre first.
[[nodiscard]] std::vector<PixelRect> make_tiles(PixelRect rect, int tile_size);

}  // namespace basicrt
