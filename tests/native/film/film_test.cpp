// SPDX-License-Identifier: GPL-3.0-or-later
// Sums of samples and the picture made of tiles.
#include "film/film.h"

#include <gtest/gtest.h>

namespace basicrt {
namespace {

PassLayout two_passes() {
  PassLayout layout;
  layout.enable(Pass::depth);
  layout.enable(Pass::normal);
  return layout;
}

TEST(TileAccumulator, combined_is_the_mean) {
  TileAccumulator accumulator({0, 0, 1, 1}, {});
  accumulator.add(0, 0, {.radiance = Color(1, 2, 3), .alpha = 1});
  accumulator.add(0, 0, {.radiance = Color(5, 6, 7), .alpha = 0});
  EXPECT_EQ(accumulator.finish().values, (std::vector<float>{3, 4, 5, 0.5f}));
}

TEST(TileAccumulator, negative_samples_are_taken_off_by_the_mass_they_stand_for) {
  TileAccumulator accumulator({0, 0, 1, 1}, two_passes(), {.negative_mass = 0.25f});
  accumulator.add(0, 0, {.radiance = Color(4.0f), .has_hit = true, .normal = {0, 0, 1}});
  accumulator.add(0, 0, {.radiance = Color(8.0f), .has_hit = true, .normal = {0, 1, 0}}, true);
  accumulator.add(0, 0, {.radiance = Color(2.0f), .alpha = 0});
  // Positive: radiance 3, alpha 1/2, normal (0, 0, 1/2).
  EXPECT_EQ(accumulator.finish().values, (std::vector<float>{1.75f, 1.75f, 1.75f, 0.375f, 0, 0, -0.25f, 0.625f}));
}

// Whatever the signs: what all samples agree on is the pixel, and it is never out of bounds.
TEST(TileAccumulator, few_samples_of_a_filter_with_negative_lobes_stay_bounded) {
  constexpr float mass = 0.2f;
  for (int count = 1; count <= 4; ++count) {
    for (unsigned signs = 0; signs < 1u << count; ++signs) {
      for (unsigned lit = 0; lit < 1u << count; ++lit) {
        TileAccumulator accumulator({0, 0, 1, 1}, {}, {.negative_mass = mass});
        for (int i = 0; i < count; ++i)
          accumulator.add(0, 0, {.radiance = Color(lit >> i & 1 ? 1.0f : 0.0f)}, signs >> i & 1);
        const std::vector<float> values = accumulator.finish().values;
        EXPECT_FLOAT_EQ(values[3], 1);
        EXPECT_GE(values[0], -mass - 1e-6f) << count << " samples, signs " << signs << ", lit " << lit;
        EXPECT_LE(values[0], 1 + mass + 1e-6f) << count << " samples, signs " << signs << ", lit " << lit;
        const bool is_flat = lit == 0 || lit == (1u << count) - 1;
        if (is_flat) {
          EXPECT_FLOAT_EQ(values[0], lit == 0 ? 0 : 1);
        }
      }
    }
  }
}

TEST(TileAccumulator, depth_is_of_the_first_hit_and_the_background_is_far) {
  TileAccumulator accumulator({0, 0, 2, 1}, two_passes());
  accumulator.add(0, 0, {});
  accumulator.add(0, 0, {.has_hit = true, .depth = 3, .normal = {0, 0, 1}});
  accumulator.add(0, 0, {.has_hit = true, .depth = 9, .normal = {0, 0, 1}});
  accumulator.add(1, 0, {});
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
  accumulator.add(0, 0, {.radiance = Color(7.0f)});
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
