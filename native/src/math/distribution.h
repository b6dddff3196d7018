// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses one of many by weight.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/assert.h"
#include "math/constants.h"

namespace basicrt {

// A cumulative table, searched in O(log n). Neighbouring numbers choose neighbouring entries, so that a stratified
// number gives stratified choices. In double: a million entries of a sum in float would lose their digits.
class DiscreteDistribution {
 public:
  DiscreteDistribution() = default;
  // Weights are finite and not negative. An entry of weight 0 is never chosen; where all are 0, none can be.
  explicit DiscreteDistribution(std::vector<double> weights) : cumulative_(std::move(weights)) {
    for (double& entry : cumulative_) {
      BASICRT_ASSERT(entry >= 0 && entry < std::numeric_limits<double>::infinity());
      entry = total_ += entry;
    }
    if (total_ > 0)
      for (double& entry : cumulative_) entry /= total_;
  }

  struct Choice {
    std::uint32_t index = 0;
    double probability = 0;
    float remainder = 0;  // what is left of the number, again uniform in [0, 1)
  };
  // `u` in [0, 1). Needs a total over 0.
  [[nodiscard]] Choice choose(float u) const {
    BASICRT_ASSERT(total_ > 0);
    if (cumulative_.size() == 1) return {0, 1, u};
    // The first entry that ends after u: never one without weight, for that ends where it begins.
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), double(u));
    const auto index = static_cast<std::uint32_t>(found - cumulative_.begin());
    BASICRT_ASSERT(index < size());
    const double p = probability(index);
    const auto remainder = static_cast<float>((u - begin_of(index)) / p);
    return {index, p, std::min(remainder, one_minus_epsilon)};
  }
  [[nodiscard]] double probability(std::uint32_t index) const { return cumulative_[index] - begin_of(index); }

  [[nodiscard]] double total() const { return total_; }  // of the weights
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(cumulative_.size()); }

 private:
  [[nodiscard]] double begin_of(std::uint32_t index) const { return index == 0 ? 0 : cumulative_[index - 1]; }

  std::vector<double> cumulative_;  // where each entry ends in [0, 1]
  double total_ = 0;
};

}  // namespace basicrt
