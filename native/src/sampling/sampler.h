// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers as a pure function of (pixel, sample, dimension, seed).
#pragma once

#include <cstdint>

#include "math/hash.h"
#include "math/vec.h"

namespace basicrt {

// The numbers of one path. Copying it repeats them: the same coordinates always give the same numbers, so an image
// does not depend on threads, tiles or order.
class Sampler {
 public:
  Sampler() = default;
  Sampler(std::uint64_t pixel_key, std::uint32_t sample) : key_(hash(pixel_key ^ sample)) {}

  // What the samples of one pixel have in common.
  [[nodiscard]] static std::uint64_t make_pixel_key(Vec2i pixel, std::uint64_t seed) {
    return hash(seed, (std::uint64_t(std::uint32_t(pixel.y)) << 32) | std::uint32_t(pixel.x));
  }

  [[nodiscard]] float next_1d() { return to_unit_float(static_cast<std::uint32_t>(next_bits() >> 32)); }
  [[nodiscard]] Vec2f next_2d() {
    const std::uint64_t bits = next_bits();
    return {to_unit_float(static_cast<std::uint32_t>(bits >> 32)), to_unit_float(static_cast<std::uint32_t>(bits))};
  }

 private:
  [[nodiscard]] std::uint64_t next_bits() { return hash(key_ ^ dimension_++); }

  std::uint64_t key_ = 0;
  std::uint64_t dimension_ = 0;
};

}  // namespace basicrt
