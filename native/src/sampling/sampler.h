// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers as a pure function of (pixel, sample, dimension, seed).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/describe.h"
#include "math/hash.h"
#include "math/vec.h"
#include "sampling/sobol.h"

namespace basicrt {

// How a pixel's samples are spread over what they integrate. sobol: each number or pair that is drawn is a scrambled
// Sobol sequence over the pixel's samples, so that any first 2^n of them (and, nearly, any number) are spread evenly;
// which goes with which is random from one draw to the next and from pixel to pixel. independent: plain random numbers.
enum class SamplerKind : std::uint8_t { sobol, independent };
template <>
inline constexpr std::array enum_names<SamplerKind> = std::to_array<std::string_view>({"sobol", "independent"});

// The numbers of one path. Copying it repeats them: the same coordinates always give the same numbers, so an image
// does not depend on threads, tiles or order.
class Sampler {
 public:
  Sampler() = default;
  // Of the pixel's first sample.
  Sampler(SamplerKind kind, Vec2i pixel, std::uint64_t seed)
      : key_(hash(seed, (std::uint64_t(std::uint32_t(pixel.y)) << 32) | std::uint32_t(pixel.x))), kind_(kind) {}
  // Of another sample of the same pixel, from its first number on.
  [[nodiscard]] Sampler at_sample(std::uint32_t sample) const {
    Sampler other;
    other.key_ = key_;
    other.kind_ = kind_;
    other.sample_ = sample;
    return other;
  }

  [[nodiscard]] float next_1d() {
    const bool is_random = draws_random();
    const std::uint64_t bits = next_bits(is_random);
    return is_random ? to_unit_float(high(bits)) : sobol_1d(shuffled_sample(bits), high(bits));
  }
  [[nodiscard]] Vec2f next_2d() {
    const bool is_random = draws_random();
    const std::uint64_t bits = next_bits(is_random);
    if (is_random) return {to_unit_float(high(bits)), to_unit_float(low(bits))};
    return sobol_2d(shuffled_sample(bits), high(bits), low(bits));
  }
  // A pair and a number to choose by: the pairs that come with the same choice are spread evenly too, which those of
  // two draws are not.
  struct ChoiceAndPair {
    float choice;
    Vec2f u;
  };
  [[nodiscard]] ChoiceAndPair next_choice() {
    const bool is_random = draws_random();
    const std::uint64_t bits = next_bits(is_random);
    const std::uint32_t more = high(hash(bits));
    if (is_random) return {to_unit_float(more), {to_unit_float(high(bits)), to_unit_float(low(bits))}};
    const std::uint32_t index = shuffled_sample(bits);
    return {sobol_third(index, more), sobol_2d(index, high(bits), low(bits))};
  }

  // Bits that no number drawn shows, others for each path and after each number.
  [[nodiscard]] std::uint64_t fingerprint() const {
    return hash(key_ ^ 0x5851f42d4c957f2du, hash(sample_) + dimension_);
  }

 private:
  static std::uint32_t high(std::uint64_t bits) { return static_cast<std::uint32_t>(bits >> 32); }
  static std::uint32_t low(std::uint64_t bits) { return static_cast<std::uint32_t>(bits); }

  // Spreading the pixel, the lens and the first bounces is what pays; behind that it costs more than it saves.
  static constexpr std::uint16_t most_spread_draws = 16;

  [[nodiscard]] bool draws_random() const {
    return kind_ == SamplerKind::independent || dimension_ >= most_spread_draws;
  }
  // For a Sobol sequence the same for all samples of the pixel: what scrambles it.
  std::uint64_t next_bits(bool is_random) {
    const std::uint64_t key = is_random ? hash(key_ + sample_) : key_;
    return hash(key + dimension_++ * 0x9e3779b97f4a7c15u);
  }
  // Each draw goes through its sequence in another order, so that two of them together are as good as random (Kollig
  // and Keller 2002, "Efficient multidimensional sampling"). The first has none to differ from.
  [[nodiscard]] std::uint32_t shuffled_sample(std::uint64_t bits) const {
    return dimension_ == 1 ? sample_ : owen_scramble(sample_, high(bits * 0xd1342543de82ef95u));
  }

  std::uint64_t key_ = 0;
  std::uint32_t sample_ = 0;
  std::uint16_t dimension_ = 0;
  SamplerKind kind_ = SamplerKind::sobol;
};

}  // namespace basicrt
