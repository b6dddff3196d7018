// SPDX-License-Identifier: GPL-3.0-or-later
// Checks a described struct's numbers against the ranges that its fields name.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/describe.h"

namespace basicrt {

// "<item>.<field>", or the one of them that is not empty.
[[nodiscard]] std::string join_path(std::string_view item, std::string_view field);

// The shortest text that reads back as the same number.
[[nodiscard]] std::string number_text(float value);
[[nodiscard]] std::string number_text(double value);
[[nodiscard]] std::string number_text(std::int64_t value);

// What is wrong with a number, as in "must be in [0, 1], is 1.5"; empty: nothing.
[[nodiscard]] std::string find_problem(double value, const Range& range, const std::string& text);

// Throws SceneError("<item>.<field>: <problem>").
[[noreturn]] void throw_field_error(std::string_view item, std::string_view field, std::string_view problem);

// A field's numbers. Vectors and other compound values have their own overloads, beside the type; what holds no
// number, such as an enumeration, has none to visit.
template <class Number, class Visitor>
  requires std::is_scalar_v<Number>
constexpr void for_each_number(const Number& value, Visitor&& visit) {
  if constexpr (std::floating_point<Number>)
    visit(value);
  else if constexpr (std::integral<Number> && !std::same_as<Number, bool>)
    visit(static_cast<std::int64_t>(value));
}

// Each number of each element.
template <class T, class Visitor>
  requires requires(const T& value, Visitor&& visit) { for_each_number(value, visit); }
constexpr void for_each_number(const std::vector<T>& values, Visitor&& visit) {
  for (const T& value : values) for_each_number(value, visit);
}

template <class Visitor>
constexpr void for_each_number(const std::string& /*text*/, Visitor&& /*visit*/) {}

// Throws SceneError naming `item` and `field` for the first of the value's numbers that is out of range.
template <class Value>
void validate_field(const Value& value, const Range& range, std::string_view item, std::string_view field) {
  for_each_number(value, [&](auto number) {
    const std::string problem = find_problem(static_cast<double>(number), range, number_text(number));
    if (!problem.empty()) throw_field_error(item, field, problem);
  });
}

template <Described Struct>
void validate_fields(const Struct& object, std::string_view item) {
  for_each_field<Struct>(
      [&](const auto& field) { validate_field(object.*field.member, field.range, item, field.name); });
}

}  // namespace basicrt
