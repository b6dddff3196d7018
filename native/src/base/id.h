// SPDX-License-Identifier: GPL-3.0-or-later
// A typed index into a table: an Id<Material> can't be used where an Id<Shape> is wanted.
#pragma once

#include <cstdint>
#include <limits>

namespace basicrt {

template <class T>
struct Id {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t index = none;

  [[nodiscard]] constexpr bool is_valid() const { return index != none; }
  constexpr bool operator==(const Id&) const = default;
};

// An index is no number that has a range.
template <class T, class Visitor>
constexpr void for_each_number(const Id<T>& /*id*/, Visitor&& /*visit*/) {}

}  // namespace basicrt
