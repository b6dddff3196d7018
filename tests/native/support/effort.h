// SPDX-License-Identifier: GPL-3.0-or-later
// How hard statistical tests try: less under a sanitizer, which slows them down tenfold and looks for other faults.
#pragma once

namespace basicrt::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr int effort_divisor = 10;
#else
inline constexpr int effort_divisor = 1;
#endif

// How often to repeat what is repeated `count` times in an ordinary build.
constexpr int repetitions(int count) { return count / effort_divisor; }

}  // namespace basicrt::test
