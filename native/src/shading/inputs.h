// SPDX-License-Identifier: GPL-3.0-or-later
// The inputs of shaders and operations: a constant, a texture over uv, or what an operation of the material gives.
#pragma once

#include <concepts>
#include <cstdint>

#include "base/id.h"
#include "math/color.h"
#include "shading/texture.h"

namespace basicrt {

// The index of an operation in Material::operations.
struct OperationIndex {
  static constexpr std::uint32_t none = ~0u;
  std::uint32_t index = none;

  [[nodiscard]] constexpr bool is_valid() const { return index != none; }
  constexpr bool operator==(const OperationIndex&) const = default;
};

// A colour, vector or point. The operation where there is one, else the texture, else the constant.
struct ColorInput {
  Color constant{0.8f};
  Id<Texture> texture{};
  OperationIndex operation{};

  ColorInput() = default;
  ColorInput(Color c) : constant(c) {}                    // NOLINT: a colour is a colour input
  ColorInput(OperationIndex index) : operation(index) {}  // NOLINT: so is what gives one
  bool operator==(const ColorInput&) const = default;

  [[nodiscard]] bool is_varying() const { return texture.is_valid() || operation.is_valid(); }
};

template <class Visitor>
constexpr void for_each_number(const ColorInput& input, Visitor&& visit) {
  for_each_number(input.constant, visit);
}

// A number: the operation's first, or a texture's luminance or alpha, or the constant.
struct NumberInput {
  float constant = 1;
  Id<Texture> texture{};
  bool is_alpha = false;
  OperationIndex operation{};

  NumberInput() = default;
  NumberInput(float number) : constant(number) {}          // NOLINT: a number is an input
  NumberInput(OperationIndex index) : operation(index) {}  // NOLINT: so is what gives one
  // Not for numbers, which are compared as such.
  template <std::same_as<NumberInput> Input>
  friend bool operator==(const Input& a, const Input& b) {
    return a.constant == b.constant && a.texture == b.texture && a.is_alpha == b.is_alpha && a.operation == b.operation;
  }

  [[nodiscard]] bool is_varying() const { return texture.is_valid() || operation.is_valid(); }
  // Only for inputs that don't vary, as none of a resolved node does.
  operator float() const { return constant; }  // NOLINT: lobes are made of plain numbers
};

template <class Visitor>
constexpr void for_each_number(const NumberInput& input, Visitor&& visit) {
  visit(input.constant);
}

template <class Value>
concept IsInput = std::same_as<Value, ColorInput> || std::same_as<Value, NumberInput>;

}  // namespace basicrt
