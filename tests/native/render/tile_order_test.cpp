// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles cover the picture once, from the centre outwards.
#include "render/tile_order.h"

#include <gtest/gtest.h>

#include <vector>

namespace basicrt {
namespace {

TEST(MakeTiles, covers_each_pixel_exactly_once) {
  for (const int tile_size : {1, 7, 32, 1000}) {
    const PixelRect rect{5, 3, 61, 40};
    std::vector<int> covered(rect.width * rect.height);
    for (const PixelRect& tile : make_tiles(rect, tile_size))
      for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) ++covered[(tile.y - rect.y + y) * rect.width + tile.x - rect.x + x];
    for (const int count : covered) ASSERT_EQ(count, 1) << "tile size " << tile_size;
  }
}

TEST(MakeTiles, the_centre_comes_first) {
  const std::vector<PixelRect> tiles = make_tiles({0, 0, 96, 96}, 32);
  EXPECT_EQ(tiles.front(), (PixelRect{32, 32, 32, 32}));
}

}  // namespace
}  // namespace basicrt
