// SPDX-License-Identifier: GPL-3.0-or-later
// Changes bytes at random, as fuzzers do, for a short run without one.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace basicrt::fuzz {

using Bytes = std::vector<std::uint8_t>;

// `bytes` after a few random changes, some of which take a piece of `other`.
inline Bytes mutated(Bytes bytes, const Bytes& other, std::mt19937& rng) {
  constexpr std::array<std::uint8_t, 8> interesting{0, 1, 2, 64, 127, 128, 192, 255};
  const auto below = [&](std::size_t count) { return static_cast<std::ptrdiff_t>(rng() % count); };
  const int changes = 1 + static_cast<int>(rng() % 4);
  for (int i = 0; i < changes; ++i) {
    if (bytes.empty()) bytes.push_back(0);
    const std::ptrdiff_t at = below(bytes.size());
    switch (rng() % 5) {
      case 0:
        bytes[at] = static_cast<std::uint8_t>(rng());
        break;
      case 1:
        bytes[at] = interesting[below(interesting.size())];
        break;
      case 2:
        bytes[at] ^= static_cast<std::uint8_t>(1u << below(8));
        break;
      case 3:
        bytes.erase(bytes.begin() + at, bytes.begin() + std::min<std::ptrdiff_t>(std::ssize(bytes), at + 1 + below(4)));
        break;
      default:
        if (other.empty()) break;
        const std::ptrdiff_t from = below(other.size()), size = 1 + below(other.size() - from);
        bytes.insert(bytes.begin() + at, other.begin() + from, other.begin() + from + size);
    }
  }
  return bytes;
}

}  // namespace basicrt::fuzz
