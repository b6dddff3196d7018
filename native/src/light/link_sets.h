// SPDX-License-Identifier: GPL-3.0-or-later
// Light linking and shadow linking, as Blender has them: objects are in one set of receivers and one of blockers each, and
// every light says which sets it lights and which dim it.
#pragma once

#include <cstdint>

namespace basicrt {

// Some of the sets, by their numbers; as made: all.
struct LinkSets {
  static constexpr int count = 64;
  // Stands for a set: of what no link concerns, such as the camera. Every LinkSets has it.
  static constexpr int unlinked = count;

  std::uint64_t bits = ~std::uint64_t{0};

  [[nodiscard]] constexpr bool is_all() const { return bits == ~std::uint64_t{0}; }
  [[nodiscard]] constexpr bool has(int set) const { return set == unlinked || (bits >> set & 1) != 0; }
  // Of no numbers, to add some.
  [[nodiscard]] static constexpr LinkSets none() { return {0}; }
  constexpr void add(int set) { bits |= std::uint64_t{1} << set; }
  constexpr bool operator==(const LinkSets&) const = default;
};

// They are no numbers that have a range.
template <class Visitor>
constexpr void for_each_number(const LinkSets& /*sets*/, Visitor&& /*visit*/) {}

}  // namespace basicrt
