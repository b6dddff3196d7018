// SPDX-License-Identifier: GPL-3.0-or-later
// Files are whole or not there.
#include "io/file.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

TEST(NewFile, has_its_name_only_once_it_is_complete) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  {
    NewFile file(folder.path() / "a.txt");
    file.stream() << "new";
    file.stream().flush();
    EXPECT_EQ(read_file(folder.path() / "a.txt"), "old");
    file.commit();
  }
  EXPECT_EQ(read_file(folder.path() / "a.txt"), "new");
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.txt"});
}

TEST(NewFile, leaves_nothing_behind_without_commit) {
  const TemporaryFolder folder;
  {
    NewFile(folder.path() / "a.txt").stream() << "half";
  }
  EXPECT_TRUE(folder.files().empty());
}

TEST(NewFile, a_full_disk_is_an_error_and_no_file) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  const TemporaryFolder folder;
  NewFile file(folder.path() / "a.txt");
  file.stream().close();
  file.stream().open("/dev/full");  // every write to it fails as on a full disk
  file.stream() << "text";
  EXPECT_EQ(error_of([&] { file.commit(); }),
            (folder.path() / "a.txt").string() + ": can't be written: No space left on device");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.txt"));
}

TEST(NewFile, checking_changes_nothing) {
  const TemporaryFolder folder;
  check_writable(folder.path() / "a.txt");
  EXPECT_TRUE(folder.files().empty());
  EXPECT_NE(error_of([&] { check_writable(folder.path()); }), "");
}

TEST(ReadFile, a_folder_is_no_file) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of([&] { (void)read_file(folder.path()); }),
            folder.path().string() + ": can't be read: Is a directory");
}

}  // namespace
}  // namespace basicrt
