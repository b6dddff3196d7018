// SPDX-License-Identifier: GPL-3.0-or-later
// How often random tests try.
#pragma once

namespace basicrt::test {

// Sanitizers look at what is executed, which a tenth of the tries executes too, and take ten times as long over each.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif
constexpr int tries(int count) { return is_sanitized ? (count + 9) / 10 : count; }

}  // namespace basicrt::test
