// SPDX-License-Identifier: GPL-3.0-or-later
// Texture lookups against their conventions.
#include "shading/texture.h"

#include <gtest/gtest.h>

#include "shading/texture_values.h"

namespace basicrt {
namespace {

// 2 x 2 texels, red 1 2 in the lower row and 3 4 in the upper.
ImageTexture make_image(int channels) {
  std::vector<float> pixels;
  for (int texel = 0; texel < 4; ++texel)
    for (int channel = 0; channel < channels; ++channel) pixels.push_back(static_cast<float>(texel + 1 + 10 * channel));
  return {.image = {.width = 2, .height = 2, .channels = channels, .pixels = std::move(pixels), .path = {}}};
}

Color eval_color(const Texture& texture, Vec2f uv) { return eval_texture(texture, uv).color; }

void expect_color(Color actual, Color expected) {
  EXPECT_FLOAT_EQ(actual.x, expected.x);
  EXPECT_FLOAT_EQ(actual.y, expected.y);
  EXPECT_FLOAT_EQ(actual.z, expected.z);
}

TEST(Texture, constant_is_the_same_everywhere) {
  expect_color(eval_color(ConstantTexture{{0.1f, 0.2f, 0.3f}}, {7, -3}), {0.1f, 0.2f, 0.3f});
}

TEST(Texture, checkerboard_alternates_from_cell_to_cell_also_left_of_zero) {
  const Texture board =
      CheckerboardTexture{.color0 = Color(0.0f), .color1 = Color(1.0f), .scale = {4, 2}, .delta = {0, 0}};
  const auto value = [&](float u, float v) { return eval_color(board, {u, v}).x; };
  EXPECT_EQ(value(0.1f, 0.1f), 0);
  EXPECT_EQ(value(0.3f, 0.1f), 1);
  EXPECT_EQ(value(0.3f, 0.6f), 0);
  EXPECT_EQ(value(0.1f, 0.6f), 1);
  EXPECT_EQ(value(-0.1f, 0.1f), 1);
  EXPECT_EQ(value(-0.1f, -0.1f), 0);
  EXPECT_EQ(value(-0.3f, -0.1f), 1);
}

TEST(Texture, checkerboard_is_moved_by_delta_after_scaling) {
  const Texture board =
      CheckerboardTexture{.color0 = Color(0.0f), .color1 = Color(1.0f), .scale = {2, 2}, .delta = {0.5f, 0}};
  EXPECT_EQ(eval_color(board, {0.24f, 0.1f}).x, 0);
  EXPECT_EQ(eval_color(board, {0.26f, 0.1f}).x, 1);
}

TEST(Texture, texels_are_centred_at_half_integers_and_v_points_up) {
  const Texture image = make_image(3);
  expect_color(eval_color(image, {0.25f, 0.25f}), {1, 11, 21});
  expect_color(eval_color(image, {0.75f, 0.25f}), {2, 12, 22});
  expect_color(eval_color(image, {0.25f, 0.75f}), {3, 13, 23});
  expect_color(eval_color(image, {0.75f, 0.75f}), {4, 14, 24});
}

TEST(Texture, values_may_be_negative_and_colours_are_not) {
  const ImageTexture image{
      .image = {.width = 1, .height = 1, .channels = 3, .pixels = std::vector{-11.0f, -1.0f, 9.0f}, .path = {}}};
  expect_color(eval_texture_values(image, {0.5f, 0.5f}).color, {-11, -1, 9});
  expect_color(eval_color(image, {0.5f, 0.5f}), {0, 0, 9});
}

TEST(Texture, images_are_bilinear_between_texels) {
  expect_color(eval_color(make_image(3), {0.5f, 0.5f}), {2.5f, 12.5f, 22.5f});
  expect_color(eval_color(make_image(3), {0.375f, 0.25f}), {1.25f, 11.25f, 21.25f});
}

TEST(Texture, images_repeat_across_their_edges) {
  const Texture image = make_image(3);
  expect_color(eval_color(image, {0, 0.25f}), {1.5f, 11.5f, 21.5f});  // halfway from the last to the first column
  expect_color(eval_color(image, {1, 0.25f}), {1.5f, 11.5f, 21.5f});
  for (const Vec2f uv : {Vec2f{0.3f, 0.4f}, Vec2f{0.95f, 0.02f}})
    for (const float shift : {-2.0f, -1.0f, 1.0f, 4.0f}) {
      const Color here = eval_color(image, uv), there = eval_color(image, uv + Vec2f{shift, -shift});
      EXPECT_NEAR(here.x, there.x, 1e-5f);
    }
}

TEST(Texture, one_channel_is_grey_and_alpha_is_left_out) {
  expect_color(eval_color(make_image(1), {0.25f, 0.25f}), Color(1.0f));
  expect_color(eval_color(make_image(2), {0.75f, 0.25f}), Color(2.0f));
  expect_color(eval_color(make_image(4), {0.75f, 0.25f}), {2, 12, 22});
}

TEST(Texture, an_image_of_one_texel_is_constant) {
  const Texture image = ImageTexture{.image = {.width = 1, .height = 1, .channels = 1, .pixels = {0.25f}, .path = {}}};
  for (const float u : {-0.3f, 0.0f, 0.2f, 0.9f, 1.0f}) expect_color(eval_color(image, {u, u}), Color(0.25f));
}

}  // namespace
}  // namespace basicrt
