// SPDX-License-Identifier: GPL-3.0-or-later
// Files by the standard library, with errno's words in the errors.
#include "io/file.h"

#include <unistd.h>

#include <cerrno>
#include <sstream>
#include <system_error>

#include "base/error.h"

namespace basicrt {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
  const std::string reason = error == 0 ? "" : ": " + std::generic_category().message(error);
  throw SceneError(path.string(), what + reason);
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored)) fail(path, "can't be read", EISDIR);
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail(path, "can't be opened", errno);
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad()) fail(path, "can't be read", errno);
  return std::move(text).str();
}

NewFile::NewFile(const std::filesystem::path& path) : path_(path) {
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored)) fail(path, "can't be written", EISDIR);
  std::string name = ".";
  name.append(path.filename().string()).append(".").append(std::to_string(getpid())).append(".tmp");
  temporary_path_ = path.parent_path() / name;
  errno = 0;
  stream_.open(temporary_path_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail(path, "can't be written", errno);
}

NewFile::~NewFile() {
  if (temporary_path_.empty()) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_path_, ignored);
}

void NewFile::commit() {
  errno = 0;
  stream_.close();
  if (!stream_) fail(path_, "can't be written", errno);
  std::error_code error;
  std::filesystem::rename(temporary_path_, path_, error);
  if (error) fail(path_, "can't be written", error.value());
  temporary_path_.clear();
}

void check_writable(const std::filesystem::path& path) { const NewFile file(path); }

}  // namespace basicrt
