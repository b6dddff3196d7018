// SPDX-License-Identifier: GPL-3.0-or-later
// The words for numbers that are out of range.
#include "base/validate_fields.h"

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace basicrt {
namespace {

template <class Number>
std::string shortest_text(Number value) {
  char buffer[64];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string rule_text(const Range& range) {
  const std::string minimum = shortest_text(range.minimum);
  if (std::isfinite(range.maximum))
    return "must be in " + std::string(range.is_minimum_excluded ? "(" : "[") + minimum + ", " +
           shortest_text(range.maximum) + "]";
  return (range.is_minimum_excluded ? "must be above " : "must be at least ") + minimum;
}

}  // namespace

std::string join_path(std::string_view item, std::string_view field) {
  const std::string_view dot = item.empty() || field.empty() ? "" : ".";
  return std::string(item).append(dot).append(field);
}

std::string number_text(float value) { return shortest_text(value); }
std::string number_text(double value) { return shortest_text(value); }
std::string number_text(std::int64_t value) { return shortest_text(value); }

std::string find_problem(double value, const Range& range, const std::string& text) {
  if (std::isnan(value) || (std::isinf(value) && !range.may_be_infinite)) return "must be a finite number, is " + text;
  const bool is_too_small = range.is_minimum_excluded ? value <= range.minimum : value < range.minimum;
  if (is_too_small || value > range.maximum) return rule_text(range) + ", is " + text;
  return {};
}

void throw_field_error(std::string_view item, std::string_view field, std::string_view problem) {
  throw SceneError(join_path(item, field), problem);
}

}  // namespace basicrt
