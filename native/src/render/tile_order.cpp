// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles from the centre outwards.
#include "render/tile_order.h"

#include <algorithm>
#include <cstdint>

namespace basicrt {

std::vector<PixelRect> make_tiles(PixelRect rect, int tile_size) {
  std::vector<PixelRect> tiles;
  for (int y = 0; y < rect.height; y += tile_size)
    for (int x = 0; x < rect.width; x += tile_size)
      tiles.push_back(
          {rect.x + x, rect.y + y, std::min(tile_size, rect.width - x), std::min(tile_size, rect.height - y)});

  // Twice the distance between the centres, squared: integers, so that the order is the same everywhere.
  const auto distance = [&](const PixelRect& tile) {
    const std::int64_t dx = 2 * (tile.x - rect.x) + tile.width - rect.width;
    const std::int64_t dy = 2 * (tile.y - rect.y) + tile.height - rect.height;
    return dx * dx + dy * dy;
  };
  std::stable_sort(tiles.begin(), tiles.end(),
                   [&](const PixelRect& a, const PixelRect& b) { return distance(a) < distance(b); });
  return tiles;
}

}  // namespace basicrt
