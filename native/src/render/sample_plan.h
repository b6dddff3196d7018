// SPDX-License-Identifier: GPL-3.0-or-later
// In which rounds a pixel's samples are taken: between them the noise is looked at, and the clock.
#pragma once

#include <vector>

#include "scene/settings.h"

namespace basicrt {

struct SamplePlan {
  int begin = 0;                // the first sample
  std::vector<int> round_ends;  // the samples that a pixel has after each round; rising
  int adaptive_min_samples;     // with fewer of them no pixel has enough
};

[[nodiscard]] SamplePlan plan_samples(const RenderSettings& settings);

}  // namespace basicrt
