// SPDX-License-Identifier: GPL-3.0-or-later
// EXR files: what is written reads back, and nothing is left of what can't be written.
#include "io/exr.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

// Every value of every pass differs.
Film make_film(PassLayout layout) {
  constexpr int width = 3, height = 2;
  Tile tile{.rect = {0, 0, width, height}, .layout = layout, .values = {}};
  for (int i = 0; i < width * height * layout.channel_count(); ++i)
    tile.values.push_back(0.1f * static_cast<float>(i) + 1e-7f);
  Film film(width, height, layout);
  film.write(tile);
  return film;
}

TEST(Exr, combined_reads_back_to_the_bit_with_its_rows_in_order) {
  const TemporaryFolder folder;
  const Film film = make_film({});
  write_exr(folder.path() / "a.exr", film, {{"software", "test"}});
  const Image image = read_exr(folder.path() / "a.exr");
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 4);
  EXPECT_EQ(image.pixels, film.values(Pass::combined));
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, other_passes_are_channels_with_the_pass_in_front) {
  const TemporaryFolder folder;
  PassLayout layout;
  for (const PassInfo& info : passes) layout.enable(info.pass);
  const Film film = make_film(layout);
  const auto path = folder.path() / "a.exr";
  write_exr(path, film);
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  const std::string header = bytes.substr(0, bytes.find("dataWindow"));
  for (const std::string_view name : {"Depth.Z", "Normal.X", "Normal.Y", "Normal.Z"})
    EXPECT_NE(header.find(name), std::string::npos) << name;
  EXPECT_EQ(read_exr(path).pixels, film.values(Pass::combined));
}

TEST(Exr, the_same_film_is_the_same_bytes) {
  const TemporaryFolder folder;
  const auto bytes_of = [&](const char* name) {
    write_exr(folder.path() / name, make_film({}));
    std::ifstream stream(folder.path() / name, std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(stream)), {});
  };
  EXPECT_EQ(bytes_of("a.exr"), bytes_of("b.exr"));
}

TEST(Exr, a_folder_that_does_not_exist_can_t_be_written_to) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "none" / "a.exr";
  EXPECT_EQ(error_of([&] { write_exr(path, make_film({})); }),
            path.string() + ": can't be written: No such file or directory");
  EXPECT_TRUE(folder.files().empty());
}

TEST(Exr, a_folder_is_no_file_to_write) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "a.exr");
  EXPECT_EQ(error_of([&] { write_exr(folder.path() / "a.exr", make_film({})); }),
            (folder.path() / "a.exr").string() + ": can't be written: Is a directory");
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

TEST(Exr, what_is_no_exr_is_named) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.exr", "not a picture");
  EXPECT_TRUE(error_of([&] { (void)read_exr(path); }).starts_with(path.string() + ": can't be read"));
}

}  // namespace
}  // namespace basicrt
