// SPDX-License-Identifier: GPL-3.0-or-later
// When, while the shutter is open, a camera sample is taken.
#pragma once

#include <vector>

#include "math/distribution.h"

namespace basicrt {

class Shutter {
 public:
  Shutter() = default;  // wide open from time 0 to 1
  // How far it is open at equally spaced times from 0 to 1, linear between them: at least two numbers, none of them
  // negative, not all 0. Without numbers it is wide open.
  explicit Shutter(const std::vector<float>& curve);

  // A time with the curve as density. Neighbouring numbers give neighbouring times.
  [[nodiscard]] float sample(float u) const;

 private:
  std::vector<float> curve_;
  DiscreteDistribution spans_;  // from one number to the next
};

}  // namespace basicrt
