// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a chain of roundings in double precision.
#pragma once

namespace basicrt {

// Bounds the relative error of n roundings in a row (Higham 2002, "Accuracy and Stability of Numerical Algorithms").
consteval double gamma(int n) {
  constexpr double unit_roundoff = 0x1p-53;
  return n * unit_roundoff / (1 - n * unit_roundoff);
}

}  // namespace basicrt
