// SPDX-License-Identifier: GPL-3.0-or-later
// A sum of floats that does not depend on their order: pictures of some of the samples add up to that of all of them.
// docs/decisions/0009-sums-of-blocks-are-exact.md says why.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace basicrt {

// Fixed point of 64 bits before and 64 behind the point, in two's complement. What is added is rounded to that first, and
// cut at +-2^42: 2^20 of them can't overflow. What is no number counts as the most.
class ExactSum {
 public:
  static constexpr std::size_t word_count = 4;
  using Words = std::array<std::uint32_t, word_count>;  // the lowest first

  void add(float value) {
    const double magnitude = std::fmin(std::fabs(double{value}), 0x1p42);
    if (!(magnitude > 0)) return;
    const double whole = std::floor(magnitude);
    ExactSum term;
    term.high_ = static_cast<std::uint64_t>(whole);
    term.low_ = static_cast<std::uint64_t>((magnitude - whole) * 0x1p64);  // below 2^64: a float has 24 bits
    add(value < 0 ? -term : term);
  }
  void add(const ExactSum& other) {
    low_ += other.low_;
    high_ += other.high_ + (low_ < other.low_ ? 1 : 0);
  }

  [[nodiscard]] float to_float() const {
    const bool is_negative = (high_ >> 63) != 0;
    const ExactSum magnitude = is_negative ? -*this : *this;
    const double value = static_cast<double>(magnitude.high_) + static_cast<double>(magnitude.low_) * 0x1p-64;
    return static_cast<float>(is_negative ? -value : value);
  }

  [[nodiscard]] Words words() const {
    return {static_cast<std::uint32_t>(low_), static_cast<std::uint32_t>(low_ >> 32), static_cast<std::uint32_t>(high_),
            static_cast<std::uint32_t>(high_ >> 32)};
  }
  [[nodiscard]] static ExactSum from_words(const std::uint32_t* words) {
    ExactSum sum;
    sum.low_ = words[0] | std::uint64_t{words[1]} << 32;
    sum.high_ = words[2] | std::uint64_t{words[3]} << 32;
    return sum;
  }

 private:
  [[nodiscard]] ExactSum operator-() const {
    ExactSum result;
    result.low_ = ~low_ + 1;
    result.high_ = ~high_ + (result.low_ == 0 ? 1 : 0);
    return result;
  }

  std::uint64_t low_ = 0, high_ = 0;
};

}  // namespace basicrt
