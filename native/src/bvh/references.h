// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes in registers, and the primitives that builders move about: their boxes go with them, so that memory is read in
// order.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "math/bounds.h"
#include "math/simd.h"

namespace basicrt {

// An axis in each of three lanes. The lower corner is negated, so that a union takes nothing but maxima.
struct Box {
  Float4 negated_lower = Float4::all(-std::numeric_limits<float>::infinity());
  Float4 upper = Float4::all(-std::numeric_limits<float>::infinity());

  Box() = default;
  explicit Box(const Bounds3f& box)
      : negated_lower(Float4::of(-box.lower.x, -box.lower.y, -box.lower.z, 0)),
        upper(Float4::of(box.upper.x, box.upper.y, box.upper.z, 0)) {}

  void extend(const Box& box) {
    negated_lower = max(negated_lower, box.negated_lower);
    upper = max(upper, box.upper);
  }
  [[nodiscard]] Float4 extent() const { return upper + negated_lower; }
  [[nodiscard]] Float4 doubled_center() const { return upper - negated_lower; }
  [[nodiscard]] Bounds3f bounds() const {
    alignas(16) float l[4], u[4];
    negated_lower.store(l);
    upper.store(u);
    return {{-l[0], -l[1], -l[2]}, {u[0], u[1], u[2]}};
  }
};

// A primitive's box, with the primitive's number in a lane that boxes don't use. The number has a bit set that makes
// it the bits of an ordinary float: arithmetic on denormal ones can be slow.
struct alignas(32) Reference {
  static constexpr std::uint32_t most_primitives = 0x3F80'0000u;

  Box box;

  Reference() = default;
  Reference(const Bounds3f& bounds, std::uint32_t primitive) : box(bounds) {
    box.negated_lower =
        Float4::of(-bounds.lower.x, -bounds.lower.y, -bounds.lower.z, std::bit_cast<float>(primitive | ordinary_bit));
  }
  [[nodiscard]] std::uint32_t primitive() const {
    alignas(16) float lanes[4];
    box.negated_lower.store(lanes);
    return std::bit_cast<std::uint32_t>(lanes[3]) & ~ordinary_bit;
  }

 private:
  static constexpr std::uint32_t ordinary_bit = 0x4000'0000u;
};

}  // namespace basicrt
