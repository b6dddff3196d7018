// SPDX-License-Identifier: GPL-3.0-or-later
// Lookups between pixels and beyond edges.
#include "image/image_lookup.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "math/constants.h"

namespace basicrt {
namespace {

constexpr ImageExtension extensions[] = {ImageExtension::repeat, ImageExtension::extend, ImageExtension::clip,
                                         ImageExtension::mirror};
constexpr ImageInterpolation interpolations[] = {ImageInterpolation::linear, ImageInterpolation::closest,
                                                 ImageInterpolation::cubic};

std::string text(ImageInterpolation interpolation, ImageExtension extension) {
  return std::string(enum_names<ImageInterpolation>[static_cast<int>(interpolation)]) + " " +
         std::string(enum_names<ImageExtension>[static_cast<int>(extension)]);
}

// One row of greys that are the columns' numbers plus one.
Image ramp(int width) {
  std::vector<float> pixels;
  for (int x = 0; x < width; ++x) pixels.push_back(float(x + 1));
  return {.width = width, .height = 1, .channels = 1, .pixels = std::move(pixels), .path = ""};
}

Image row_of_bytes(std::vector<std::uint8_t> bytes, int channels, ByteEncoding encoding = ByteEncoding::srgb) {
  const int width = static_cast<int>(bytes.size()) / channels;
  return {.width = width,
          .height = 1,
          .channels = channels,
          .pixels = {},
          .path = "",
          .bytes = std::move(bytes),
          .encoding = encoding};
}

// Along the middle of a picture of one row, which repeats upwards, so that only u counts.
float value_at(const Image& image, ImageInterpolation interpolation, ImageExtension extension, float u) {
  return eval_image(image, {interpolation, extension}, {u, 0.5f}).color.x;
}

TEST(ImageLookup, every_interpolation_follows_a_ramp_but_for_the_steps_of_the_closest) {
  const Image image = ramp(16);
  for (float u = 0.15f; u < 0.85f; u += 0.013f) {
    const float expected = u * 16 + 0.5f;
    for (const ImageInterpolation smooth : {ImageInterpolation::linear, ImageInterpolation::cubic})
      EXPECT_NEAR(value_at(image, smooth, ImageExtension::extend, u), expected, 1e-4f);
    EXPECT_EQ(value_at(image, ImageInterpolation::closest, ImageExtension::extend, u), std::floor(u * 16) + 1);
  }
}

TEST(ImageLookup, cubic_is_the_b_spline) {
  // At a pixel's centre it has 2/3 of that and 1/6 of each neighbour.
  EXPECT_FLOAT_EQ(value_at(ramp(3), ImageInterpolation::cubic, ImageExtension::extend, 0.5f), 2);
  EXPECT_FLOAT_EQ(value_at(ramp(3), ImageInterpolation::cubic, ImageExtension::extend, 0.5f / 3),
                  5.0f / 6 * 1 + 1.0f / 6 * 2);
  // Halfway between two, 23/48 of each and 1/48 of the next.
  EXPECT_FLOAT_EQ(value_at(ramp(4), ImageInterpolation::cubic, ImageExtension::extend, 0.75f),
                  (2 + 23 * 3 + 23 * 4 + 4) / 48.0f);
}

TEST(ImageLookup, beyond_the_edges_is_what_the_extension_says) {
  const Image image = ramp(4);
  for (const ImageInterpolation interpolation : interpolations) {
    for (float u = -2.9f; u < 3; u += 0.0437f) {
      SCOPED_TRACE(text(interpolation, ImageExtension::repeat) + " " + std::to_string(u));
      const auto at = [&](ImageExtension extension, float place) {
        return value_at(image, interpolation, extension, place);
      };
      EXPECT_NEAR(at(ImageExtension::repeat, u), at(ImageExtension::repeat, u + 1), 1e-4f);
      EXPECT_NEAR(at(ImageExtension::mirror, u), at(ImageExtension::mirror, -u), 1e-4f);
      EXPECT_NEAR(at(ImageExtension::mirror, u), at(ImageExtension::mirror, u + 2), 1e-4f);
      if (u >= -0.5f && u <= 1.5f) continue;
      EXPECT_FLOAT_EQ(at(ImageExtension::extend, u), u < 0 ? 1 : 4);
      EXPECT_EQ(at(ImageExtension::clip, u), 0);
    }
  }
}

TEST(ImageLookup, a_clipped_picture_is_transparent_outside) {
  const auto alpha_at = [](ImageInterpolation interpolation, float u) {
    return eval_image(ramp(2), {interpolation, ImageExtension::clip}, {u, 0.5f}).alpha;
  };
  EXPECT_EQ(alpha_at(ImageInterpolation::closest, 0.01f), 1);
  EXPECT_EQ(alpha_at(ImageInterpolation::closest, -0.01f), 0);
  EXPECT_FLOAT_EQ(alpha_at(ImageInterpolation::linear, 0.5f), 1);
  EXPECT_FLOAT_EQ(alpha_at(ImageInterpolation::linear, 0), 0.5f);  // half a pixel of nothing
  EXPECT_EQ(alpha_at(ImageInterpolation::linear, -0.3f), 0);
}

TEST(ImageLookup, wild_coordinates_stay_in_the_picture) {
  for (const ImageInterpolation interpolation : interpolations)
    for (const ImageExtension extension : extensions)
      for (const float wild : {1e30f, -1e30f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN(), 1e9f}) {
        SCOPED_TRACE(text(interpolation, extension) + " " + std::to_string(wild));
        const Rgba value = eval_image(ramp(5), {interpolation, extension}, {wild, wild});
        EXPECT_GE(value.color.x, 0);
        EXPECT_LE(value.color.x, 5.00001f);  // cubic weights round
      }
}

TEST(ImageLookup, every_byte_is_decoded_by_the_exact_curve) {
  for (int byte = 0; byte < 256; ++byte) {
    const Image image = row_of_bytes({static_cast<std::uint8_t>(byte)}, 1);
    EXPECT_NEAR(value_at(image, ImageInterpolation::closest, ImageExtension::repeat, 0.5f),
                srgb_to_linear(float(byte) / 255), 5e-7f);  // a few roundings
    const Image plain = row_of_bytes({static_cast<std::uint8_t>(byte)}, 1, ByteEncoding::linear);
    EXPECT_FLOAT_EQ(value_at(plain, ImageInterpolation::linear, ImageExtension::repeat, 0.5f), float(byte) / 255);
  }
}

TEST(ImageLookup, bytes_are_decoded_after_interpolation) {
  const Image image = row_of_bytes({0, 255}, 1);
  for (float u = 0.25f; u <= 0.75f; u += 0.01f)
    EXPECT_NEAR(value_at(image, ImageInterpolation::linear, ImageExtension::extend, u), srgb_to_linear(2 * u - 0.5f),
                1e-6f);
}

TEST(ImageLookup, alpha_is_not_encoded_and_colour_is_divided_by_it_where_wanted) {
  const Image image = row_of_bytes({64, 32, 0, 128}, 4);
  const Rgba kept = eval_image(image, {}, {0.5f, 0.5f});
  EXPECT_FLOAT_EQ(kept.alpha, 128.0f / 255);
  EXPECT_NEAR(kept.color.x, srgb_to_linear(64 / 255.0f), 1e-6f);
  const Rgba divided = eval_image(image, {.is_divided_by_alpha = true}, {0.5f, 0.5f});
  EXPECT_FLOAT_EQ(divided.alpha, 128.0f / 255);
  EXPECT_NEAR(divided.color.x, srgb_to_linear(0.5f), 1e-6f);
  EXPECT_NEAR(divided.color.y, srgb_to_linear(0.25f), 1e-6f);
}

TEST(Image, copies_share_their_pixels) {
  const Image image = ramp(3), copy = image;
  EXPECT_EQ(copy.pixels.data(), image.pixels.data());
  EXPECT_TRUE(copy.has_same_pixels(image));
  EXPECT_FALSE(ramp(3).has_same_pixels(image));
}

}  // namespace
}  // namespace basicrt
