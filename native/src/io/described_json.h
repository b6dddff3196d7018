// SPDX-License-Identifier: GPL-3.0-or-later
// Described structs and variants of them from and to JSON: the one reader and the one writer of all their kinds.
#pragma once

#include <array>
#include <concepts>
#include <initializer_list>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "io/json_value.h"
#include "io/json_write.h"

namespace basicrt {

// One kind among others, told apart by "type".
template <class Struct>
concept IsKind = requires {
  { Struct::kind } -> std::convertible_to<std::string_view>;
};

// The keys of a described struct, "type" first where it is a kind among others, then `extra`.
template <Described Struct>
[[nodiscard]] std::vector<std::string_view> known_keys(std::initializer_list<std::string_view> extra = {}) {
  std::vector<std::string_view> keys;
  if constexpr (IsKind<Struct>) keys.push_back("type");
  for_each_field<Struct>([&](const auto& field) { keys.push_back(field.name); });
  keys.insert(keys.end(), extra);
  return keys;
}

struct ReadValue {
  template <class T>
  void operator()(const JsonValue& value, T& out) const {
    read(value, out);
  }
};

// Sets the fields that are there, with read_value(JsonValue, field&), and checks their ranges.
template <Described Struct, class Reader = ReadValue>
void read_fields(const JsonValue& object, Struct& out, Reader&& read_value = {}) {
  for_each_field<Struct>([&](const auto& field) {
    if (const auto value = object.find(field.name)) read_value(*value, out.*field.member);
  });
  validate_fields(out, object.path());
}

// Sets the one field that is that member from a value that has another name in the file.
template <Described Struct, class Value>
void read_field(const JsonValue& value, Struct& out, Value Struct::* member) {
  read(value, out.*member);
  for_each_field<Struct>([&]<class Other>(const Field<Struct, Other>& field) {
    if constexpr (std::same_as<Other, Value>)
      if (field.member == member) validate_field(out.*member, field.range, value.path(), "");
  });
}
template <Described Struct, class Value>
void read_optional_field(const JsonValue& object, std::string_view key, Struct& out, Value Struct::* member) {
  if (const auto value = object.find(key)) read_field(*value, out, member);
}

template <class Variant>
struct VariantKinds;
template <class... Kinds>
struct VariantKinds<std::variant<Kinds...>> {
  static constexpr std::array names = {Kinds::kind...};

  // visit(Kind{}) with the alternative of that index.
  template <class Visitor>
  static void visit_index(std::size_t index, Visitor&& visit) {
    std::size_t i = 0;
    ((i++ == index ? visit(Kinds{}) : void()), ...);
  }
};

// The alternative whose kind is the object's "type", read by read_kind(JsonValue, Kind&).
template <class Variant, class ReadKind>
[[nodiscard]] Variant read_variant(const JsonValue& object, ReadKind&& read_kind) {
  using Kinds = VariantKinds<Variant>;
  const std::size_t index = read_choice(object.require("type"), Kinds::names, "type");
  Variant variant;
  Kinds::visit_index(index, [&](auto value) {
    read_kind(object, value);
    variant = std::move(value);
  });
  return variant;
}

// Of kinds that have nothing but their fields.
template <class Variant>
[[nodiscard]] Variant read_plain_variant(const JsonValue& object) {
  return read_variant<Variant>(object, []<class Kind>(const JsonValue& kind_object, Kind& value) {
    kind_object.check_keys(known_keys<Kind>());
    read_fields(kind_object, value);
  });
}

struct WriteValue {
  template <class T>
  Json operator()(const T& value) const {
    return write(value);
  }
};

// "type", then every field but those that are infinite or empty, as their defaults are.
template <Described Struct, class Writer = WriteValue>
[[nodiscard]] Json write_fields(const Struct& object, Writer&& write_value = {}) {
  Json json = Json::object();
  if constexpr (IsKind<Struct>) json["type"] = Struct::kind;
  for_each_field<Struct>([&](const auto& field) {
    const Json value = write_value(object.*field.member);
    if (!value.is_null()) json[std::string(field.name)] = value;
  });
  return json;
}

}  // namespace basicrt
