// SPDX-License-Identifier: GPL-3.0-or-later
// Typed access to JSON values, with messages that name the place.
#include "io/json_value.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace basicrt {
namespace {

template <class Integer>
void read_integer(const JsonValue& value, Integer& out) {
  const Json& json = value.json();
  if (!json.is_number_integer()) value.fail_type("an integer");
  constexpr std::int64_t minimum = std::numeric_limits<Integer>::min();
  constexpr std::int64_t maximum = std::numeric_limits<Integer>::max();
  const bool is_huge = json.is_number_unsigned() && json.get<std::uint64_t>() > static_cast<std::uint64_t>(maximum);
  if (is_huge || json.get<std::int64_t>() < minimum)
    value.fail("must be in [" + std::to_string(minimum) + ", " + std::to_string(maximum) + "], is " + json.dump());
  out = json.get<Integer>();
}

template <class Number>
void read_array(const JsonValue& value, Number* out, std::size_t count) {
  if (!value.json().is_array() || value.size() != count)
    value.fail_type("an array of " + std::to_string(count) + " numbers");
  for (std::size_t i = 0; i < count; ++i) read(value.item(i), out[i]);
}

// One JsonValue for each number would spend its time on paths that no message needs.
template <class Number, class IsGood>
void read_many(const JsonValue& value, std::vector<Number>& out, IsGood&& is_good) {
  value.expect_array();
  out.clear();
  out.reserve(value.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const Json& json = value.json()[i];
    if (is_good(json))
      out.push_back(json.get<Number>());
    else
      read(value.item(i), out.emplace_back());  // throws, with the reason
  }
}

}  // namespace

void JsonValue::fail(std::string_view problem) const { throw SceneError(path_.empty() ? "scene" : path_, problem); }

void JsonValue::fail_type(std::string_view what) const {
  std::string is = std::string("is ") +
                   (json_->is_null()                          ? ""
                    : json_->is_array() || json_->is_object() ? "an "
                                                              : "a ") +
                   json_->type_name();
  if (json_->is_array()) is += " of " + std::to_string(json_->size());
  if (json_->is_number()) is = "is " + json_->dump();
  fail("must be " + std::string(what) + ", " + is);
}

void JsonValue::warn(Report& report, std::string_view message) const {
  report.warn(path_ + ": " + std::string(message));
}

void JsonValue::expect_object() const {
  if (!json_->is_object()) fail_type("an object");
}

void JsonValue::expect_array() const {
  if (!json_->is_array()) fail_type("an array");
}

JsonValue JsonValue::item(std::size_t index) const {
  return {(*json_)[index], path_ + "[" + std::to_string(index) + "]"};
}

JsonValue JsonValue::member(const std::string& key) const { return {json_->at(key), join_path(path_, key)}; }

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
  expect_object();
  const auto found = json_->find(std::string(key));
  if (found == json_->end()) return std::nullopt;
  return JsonValue(*found, join_path(path_, key));
}

JsonValue JsonValue::require(std::string_view key) const {
  if (auto value = find(key)) return *value;
  fail("\"" + std::string(key) + "\" is missing");
}

void JsonValue::check_keys(std::span<const std::string_view> known) const {
  expect_object();
  for (const auto& [key, value] : json_->items())
    if (std::ranges::find(known, key) == known.end())
      throw SceneError(join_path(path_, key), "unknown key; " + suggest(key, known));
}

void read(const JsonValue& value, bool& out) {
  if (!value.json().is_boolean()) value.fail_type("true or false");
  out = value.json().get<bool>();
}

void read(const JsonValue& value, int& out) { read_integer(value, out); }
void read(const JsonValue& value, std::int64_t& out) { read_integer(value, out); }
void read(const JsonValue& value, std::uint32_t& out) { read_integer(value, out); }

void read(const JsonValue& value, float& out) {
  if (!value.json().is_number()) value.fail_type("a number");
  const double number = value.json().get<double>();
  if (std::abs(number) > std::numeric_limits<float>::max()) value.fail_type("a number that a 32-bit float can hold");
  out = static_cast<float>(number);
}

void read(const JsonValue& value, std::string& out) {
  if (!value.json().is_string()) value.fail_type("a string");
  out = value.json().get<std::string>();
}

void read(const JsonValue& value, Vec2f& out) {
  float numbers[2];
  read_array(value, numbers, 2);
  out = {numbers[0], numbers[1]};
}

void read(const JsonValue& value, Vec3f& out) {
  float numbers[3];
  read_array(value, numbers, 3);
  out = {numbers[0], numbers[1], numbers[2]};
}

void read(const JsonValue& value, Transform& out) {
  float m[16];
  if (value.json().is_array() && value.size() == 4)
    for (std::size_t i = 0; i < 4; ++i) read_array(value.item(i), m + 4 * i, 4);
  else
    read_array(value, m, 16);
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) value.fail("the last row must be 0 0 0 1");
  for (std::size_t i = 0; i < 12; ++i) out.rows[i / 4][i % 4] = m[i];
}

std::size_t read_choice(const JsonValue& value, std::span<const std::string_view> names, std::string_view what) {
  std::string name;
  read(value, name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) value.fail("unknown " + std::string(what) + " \"" + name + "\"; " + suggest(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

void read_numbers(const JsonValue& value, std::vector<float>& out) {
  read_many(value, out, [](const Json& json) {
    return json.is_number() && std::abs(json.get<double>()) <= std::numeric_limits<float>::max();
  });
}

void read_numbers(const JsonValue& value, std::vector<std::uint32_t>& out) {
  read_many(value, out, [](const Json& json) {
    return json.is_number_unsigned() && json.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
  });
}

void read(const JsonValue& value, std::vector<Transform>& out) {
  value.expect_array();
  out.clear();
  for (std::size_t i = 0; i < value.size(); ++i) read(value.item(i), out.emplace_back());
}

void read(const JsonValue& value, LinkSets& out) {
  value.expect_array();
  out = LinkSets::none();
  for (std::size_t i = 0; i < value.size(); ++i) {
    int set = 0;
    read(value.item(i), set);
    validate_field(set, within(0, LinkSets::count - 1), value.item(i).path(), "");
    out.add(set);
  }
}

}  // namespace basicrt
