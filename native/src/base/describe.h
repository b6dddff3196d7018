// SPDX-License-Identifier: GPL-3.0-or-later
// Described structs: a struct names its fields once, and the JSON reader, the Python constructor and repr, the
// validation messages and the parameter docs all come from that list.
//
//   struct PointLight {
//     Vec3f position;
//     float radius = 0;
//     static constexpr std::string_view kind = "point";
//     static constexpr auto fields() {
//       return fields_of(field("position", &PointLight::position, "world space, metres"),
//                         field("radius", &PointLight::radius, "metres; 0 is a point", at_least(0)));
//     }
//   };
#pragma once

#include <concepts>
#include <limits>
#include <string_view>

namespace basicrt {

// The values that a number, or each number of a vector, may take. Numbers must be finite unless the range says more.
struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool is_minimum_excluded = false;
  bool may_be_infinite = false;

  constexpr bool operator==(const Range&) const = default;
};

constexpr Range at_least(double minimum) { return {.minimum = minimum}; }
constexpr Range above(double minimum) { return {.minimum = minimum, .is_minimum_excluded = true}; }
constexpr Range above_or_infinite(double minimum) {
  return {.minimum = minimum, .is_minimum_excluded = true, .may_be_infinite = true};
}
constexpr Range within(double minimum, double maximum) { return {.minimum = minimum, .maximum = maximum}; }

template <class Struct, class Value>
struct Field {
  std::string_view name;
  Value Struct::* member;
  std::string_view doc;
  Range range;
};

template <class Struct, class Value>
constexpr Field<Struct, Value> field(std::string_view name, Value Struct::* member, std::string_view doc,
                                     Range range = {}) {
  return {name, member, doc, range};
}

// A list of fields: a function that hands them all to another one. (The same as a std::tuple would take seconds of each
// compilation that includes it.)
template <class... Fields>
constexpr auto fields_of(Fields... fields) {
  return [=](auto&& visit_all) { return visit_all(fields...); };
}

// One list after another.
template <class First, class Second>
constexpr auto joined(First first, Second second) {
  return [=](auto&& visit_all) {
    return first([&](const auto&... a) { return second([&](const auto&... b) { return visit_all(a..., b...); }); });
  };
}

template <class T>
concept Described = requires { T::fields(); };

// Calls visit(field) for each field of Struct, in the order in which they were named.
template <Described Struct, class Visitor>
constexpr void for_each_field(Visitor&& visit) {
  Struct::fields()([&](const auto&... fields) { (visit(fields), ...); });
}

// The names of an enumeration's values, in order of their numbers: specialise as
//   template <> inline constexpr std::array enum_names<Filter> = {"box", "gaussian"};
template <class Enum>
inline constexpr auto enum_names = nullptr;

}  // namespace basicrt
