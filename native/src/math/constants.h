// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that formulas need.
#pragma once

#include <limits>
#include <numbers>

namespace basicrt {

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
// The largest float below one: what a sample in [0, 1) is clamped to.
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

}  // namespace basicrt
