// SPDX-License-Identifier: GPL-3.0-or-later
// JSON through nlohmann's library, with its messages in our form.
#include "io/json.h"

#include <algorithm>

#include "base/error.h"

namespace basicrt {
namespace {

// Deeper text is refused: what reads it may recurse.
constexpr int max_depth = 200;

// "file:3:14", counted from one, of the byte at `offset`.
std::string place(std::string_view name, std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::ranges::count(before, '\n');
  const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  return std::string(name) + ":" + std::to_string(line) + ":" + std::to_string(before.size() - line_begin + 1);
}

void check_depth(std::string_view text, std::string_view name) {
  int depth = 0;
  bool is_in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_in_string && c == '\\')
      ++i;
    else if (c == '"')
      is_in_string = !is_in_string;
    else if (!is_in_string && (c == '{' || c == '['))
      ++depth;
    else if (!is_in_string && (c == '}' || c == ']'))
      --depth;
    if (depth > max_depth)
      throw SceneError(place(name, text, i), "nested more than " + std::to_string(max_depth) + " deep");
  }
}

// Without "[json.exception.parse_error.101] parse error at line 3, column 5: ".
std::string strip_prefix(std::string message) {
  const std::size_t id_end = message.find("] ");
  if (id_end != std::string::npos) message.erase(0, id_end + 2);
  if (message.starts_with("parse error")) {
    const std::size_t colon = message.find(": ");
    if (colon != std::string::npos) message.erase(0, colon + 2);
  }
  return message;
}

bool is_plain(const Json& json) { return json.is_primitive(); }

std::string leaf_text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

void append_text(std::string& text, const Json& json, std::size_t indent) {
  const bool is_object = json.is_object();
  if (json.empty() || is_plain(json) || (json.is_array() && std::ranges::all_of(json, is_plain))) {
    text += leaf_text(json);
    return;
  }
  text += is_object ? "{" : "[";
  const char* separator = "\n";
  for (const auto& [key, value] : json.items()) {
    text.append(separator).append(indent + 2, ' ');
    if (is_object) text += leaf_text(Json(key)) + ": ";
    append_text(text, value, indent + 2);
    separator = ",\n";
  }
  text.append("\n").append(indent, ' ').append(is_object ? "}" : "]");
}

}  // namespace

Json parse_json(std::string_view text, std::string_view name) {
  check_depth(text, name);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw SceneError(place(name, text, error.byte == 0 ? 0 : error.byte - 1), strip_prefix(error.what()));
  } catch (const Json::out_of_range& error) {
    // "number overflow parsing '1e999'": the library does not say where.
    const std::string message = strip_prefix(error.what());
    const std::size_t quote = message.find('\'');
    const std::string number = quote == std::string::npos ? "" : message.substr(quote + 1, message.size() - quote - 2);
    const std::size_t offset = text.find(number);
    throw SceneError(place(name, text, offset), message);
  }
}

std::string to_text(const Json& json) {
  std::string text;
  append_text(text, json, 0);
  return text + "\n";
}

}  // namespace basicrt
