// SPDX-License-Identifier: GPL-3.0-or-later
// Turns a fuzzer's bytes into numbers. Behind the last byte come zeros without end.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>

namespace basicrt::fuzz {

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t result = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return result;
  }
  // In [0, count).
  std::uint32_t below(std::uint32_t count) { return byte() % count; }
  int signed_byte() { return static_cast<std::int8_t>(byte()); }
  // In [-2, 2) in steps of 1/64, so that numbers often coincide.
  float small_number() { return static_cast<float>(signed_byte()) / 64; }
  // A small number times a power of two: denormal ones and such as squares overflow too.
  float number_of_any_size(int exponent) { return std::ldexp(static_cast<float>(signed_byte()), exponent); }
  // Any four bytes: infinities and NaNs too.
  float any_float() {
    std::uint8_t bytes[4];
    for (std::uint8_t& byte_of_float : bytes) byte_of_float = byte();
    float result;
    std::memcpy(&result, bytes, sizeof result);
    return result;
  }
  float any_finite_float() {
    const float result = any_float();
    return std::isfinite(result) ? result : 0;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace basicrt::fuzz
