// SPDX-License-Identifier: GPL-3.0-or-later
// Image files: row order, transfer curve, errors.
#include "io/image_file.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

using namespace std::string_literals;

TEST(ImageFile, eight_bits_are_srgb_and_the_first_row_is_the_lowest) {
  const TemporaryFolder folder;
  // Two rows of one pixel: the file begins with the top one.
  const Image image = read_image_file(folder.write("a.ppm", "P6 1 2 255\n\xff\x80\x00\x00\x00\xff"s));
  EXPECT_EQ(image.width, 1);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(image.pixels, (std::vector<float>{0, 0, 1, 1, srgb_to_linear(128 / 255.0f), 0}));
  EXPECT_EQ(image.path, (folder.path() / "a.ppm").string());
}

TEST(ImageFile, radiance_files_are_linear) {
  const TemporaryFolder folder;
  // RGBE: mantissa / 256 * 2^(exponent - 128); 2^1 here.
  const std::string pixel = "\x80\x40\x20\x81"s;
  const Image image =
      read_image_file(folder.write("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + pixel));
  EXPECT_EQ(image.pixels, (std::vector<float>{1.0f, 0.5f, 0.25f}));
}

TEST(ImageFile, what_is_no_image_is_named) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.png", "not a picture");
  EXPECT_TRUE(
      error_of([&] { (void)read_image_file(path); }).starts_with(path.string() + ": can't be read as an image"));
  EXPECT_TRUE(error_of([&] { (void)read_image_file(folder.write("empty.png", "")); }).find("can't be read") !=
              std::string::npos);
  EXPECT_EQ(error_of([&] { (void)read_image_file(folder.path() / "none.png"); }),
            (folder.path() / "none.png").string() + ": can't be opened: No such file or directory");
}

}  // namespace
}  // namespace basicrt
