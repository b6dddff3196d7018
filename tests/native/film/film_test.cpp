// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of samples and the picture made of tiles.
#include "film/film.h"

#include <gtest/gtest.h>

namespace basicrt {
namespace {

PassLayout all_passes() {
  PassLayout layout;
  for (const PassInfo& info : passes) layout.enable(info.pass);
  return layout;
}

TEST(TileAccumulator, combined_is_the_weighted_mean) {
  TileAccumulator accumulator({0, 0, 1, 1}, {});
  accumulator.add(0, 0, {.radiance = Color(1, 2, 3), .alpha = 1}, 3);
  accumulator.add(0, 0, {.radiance = Color(5, 6, 7), .alpha = 0}, 1);
  EXPECT_EQ(accumulator.finish().values, (std::vector<float>{2, 3, 4, 0.75f}));
}

TEST(TileAccumulator, negative_weights_cancel_as_the_filter_means_them) {
  TileAccumulator accumulator({0, 0, 1, 1}, {});
  accumulator.add(0, 0, {.radiance = Color(4.0f)}, 1);
  accumulator.add(0, 0, {.radiance = Color(4.0f)}, 1);
  accumulator.add(0, 0, {.radiance = Color(4.0f)}, -1);
  EXPECT_EQ(accumulator.finish().values, (std::vector<float>{4, 4, 4, 1}));
}

TEST(TileAccumulator, depth_is_of_the_first_hit_and_the_background_is_far) {
  TileAccumulator accumulator({0, 0, 2, 1}, all_passes());
  accumulator.add(0, 0, {}, 1);
  accumulator.add(0, 0, {.has_hit = true, .depth = 3, .normal = {0, 0, 1}}, 1);
  accumulator.add(0, 0, {.has_hit = true, .depth = 9, .normal = {0, 0, 1}}, 1);
  accumulator.add(1, 0, {}, 1);
  const Tile tile = accumulator.finish();
  const float* depth = tile.values.data() + tile.pass_begin(Pass::depth);
  EXPECT_EQ(depth[0], 3);
  EXPECT_EQ(depth[1], 1e10f);
  const float* normal = tile.values.data() + tile.pass_begin(Pass::normal);
  EXPECT_FLOAT_EQ(normal[2], 2.0f / 3);
  EXPECT_EQ(normal[5], 0);
}

TEST(Film, tiles_land_where_they_belong_with_the_bottom_row_first) {
  Film film(3, 2, {});
  TileAccumulator accumulator({2, 1, 1, 1}, {});
  accumulator.add(0, 0, {.radiance = Color(7.0f)}, 1);
  film.write(accumulator.finish());
  const std::vector<float>& combined = film.values(Pass::combined);
  for (std::size_t i = 0; i < combined.size(); ++i) EXPECT_EQ(combined[i], i / 4 == 5 ? (i % 4 == 3 ? 1 : 7) : 0);
}

TEST(PassLayout, offsets_follow_the_table) {
  PassLayout layout;
  layout.enable(Pass::normal);
  EXPECT_EQ(layout.offset(Pass::combined), 0);
  EXPECT_EQ(layout.offset(Pass::normal), 4);
  EXPECT_EQ(layout.channel_count(), 7);
  EXPECT_FALSE(layout.has(Pass::depth));
}

}  // namespace
}  // namespace basicrt
