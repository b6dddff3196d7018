// SPDX-License-Identifier: GPL-3.0-or-later
// A span of the curve by its area, then a place in it.
#include "sampling/shutter.h"

#include <algorithm>
#include <cmath>

namespace basicrt {

Shutter::Shutter(const std::vector<float>& curve) : curve_(curve) {
  std::vector<double> areas;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i) areas.push_back((double{curve[i]} + double{curve[i + 1]}) / 2);
  spans_ = DiscreteDistribution(std::move(areas));
}

float Shutter::sample(float u) const {
  if (curve_.empty()) return u;
  const auto [span, probability, remainder] = spans_.choose(u);
  // The inverse of the integral of a + (b - a) x, without its difference of nearly equal numbers.
  const float a = curve_[span], b = curve_[span + 1];
  const float root = std::sqrt(a * a + remainder * (b * b - a * a));
  const float place = a + root > 0 ? remainder * (a + b) / (a + root) : remainder;
  return std::min((static_cast<float>(span) + place) / static_cast<float>(spans_.size()), 1.0f);
}

}  // namespace basicrt
