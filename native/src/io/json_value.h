// SPDX-License-Identifier: GPL-3.0-or-later
// A JSON value that knows where in the file it stands, so that every message can name it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "base/report.h"
#include "base/suggest.h"
#include "base/validate_fields.h"
#include "io/json.h"
#include "light/link_sets.h"
#include "math/transform.h"
#include "math/vec.h"

namespace basicrt {

// A reference: the Json must outlive it.
class JsonValue {
 public:
  // `path` leads to the value, as in "objects[3].light"; the root's is empty.
  JsonValue(const Json& json, std::string path) : json_(&json), path_(std::move(path)) {}

  [[nodiscard]] const Json& json() const { return *json_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[noreturn]] void fail(std::string_view problem) const;
  // "must be <what>, is a string", or with the value where that is short.
  [[noreturn]] void fail_type(std::string_view what) const;

  void warn(Report& report, std::string_view message) const;

  void expect_object() const;
  void expect_array() const;
  [[nodiscard]] std::size_t size() const { return json_->size(); }
  [[nodiscard]] JsonValue item(std::size_t index) const;  // of an array
  [[nodiscard]] JsonValue member(const std::string& key) const;
  [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;  // of an object
  [[nodiscard]] JsonValue require(std::string_view key) const;
  // Throws for the first member that is none of `known`, with the nearest of them.
  void check_keys(std::span<const std::string_view> known) const;

 private:
  const Json* json_;
  std::string path_;
};

void read(const JsonValue& value, bool& out);
void read(const JsonValue& value, int& out);
void read(const JsonValue& value, std::int64_t& out);
void read(const JsonValue& value, std::uint32_t& out);
void read(const JsonValue& value, float& out);
void read(const JsonValue& value, std::string& out);
void read(const JsonValue& value, Vec2f& out);
void read(const JsonValue& value, Vec3f& out);
// 16 numbers, row by row, or 4 rows of 4; the last row must be 0 0 0 1.
void read(const JsonValue& value, Transform& out);

// The index of a string among `names`; `what` says what they are names of.
[[nodiscard]] std::size_t read_choice(const JsonValue& value, std::span<const std::string_view> names,
                                      std::string_view what);

template <class Enum>
  requires std::is_enum_v<Enum>
void read(const JsonValue& value, Enum& out) {
  out = static_cast<Enum>(read_choice(value, enum_names<Enum>, "name"));
}

// An array of plain numbers, such as a mesh's positions.
void read_numbers(const JsonValue& value, std::vector<float>& out);
void read_numbers(const JsonValue& value, std::vector<std::uint32_t>& out);

inline void read(const JsonValue& value, std::vector<float>& out) { read_numbers(value, out); }
void read(const JsonValue& value, std::vector<Transform>& out);
void read(const JsonValue& value, LinkSets& out);

// Reads the member `key` where there is one.
template <class T>
void read_optional(const JsonValue& object, std::string_view key, T& out) {
  if (const auto value = object.find(key)) read(*value, out);
}
template <class T>
[[nodiscard]] T read_required(const JsonValue& object, std::string_view key) {
  T out{};
  read(object.require(key), out);
  return out;
}

}  // namespace basicrt
