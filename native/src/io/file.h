// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files: read at once, and written so that nobody ever sees half of one.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace basicrt {

// Throws SceneError naming the path.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

// A file under a temporary name in the same folder. commit() gives it its name; without that it goes away.
// All throw SceneError naming the path.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  [[nodiscard]] std::ofstream& stream() { return stream_; }
  [[nodiscard]] const std::filesystem::path& temporary_path() const { return temporary_path_; }
  void commit();

 private:
  std::filesystem::path path_, temporary_path_;
  std::ofstream stream_;
};

// Throws what writing the file would throw, before the work that goes into it.
void check_writable(const std::filesystem::path& path);

}  // namespace basicrt
