// SPDX-License-Identifier: GPL-3.0-or-later
// Rounds: short ones where the clock may end them, longer ones where only the noise can.
#include "render/sample_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace basicrt {
namespace {

// The lower the noise that is asked for, the more samples it takes to know it: 64 at 0.01, 256 at 0.001.
int choose_min_samples(const RenderSettings& settings) {
  if (settings.adaptive_min_samples > 0) return settings.adaptive_min_samples;
  const float samples = 6.4f / std::sqrt(std::max(settings.adaptive_threshold, 1e-6f));
  return static_cast<int>(std::bit_ceil(static_cast<std::uint32_t>(std::max(samples, 16.0f))));
}

}  // namespace

SamplePlan plan_samples(const RenderSettings& settings) {
  const bool is_limited = settings.time_limit > 0, is_adaptive = settings.adaptive_threshold > 0;
  SamplePlan plan{
      .begin = settings.samples_from, .round_ends = {}, .adaptive_min_samples = choose_min_samples(settings)};
  int end = plan.begin;
  while (end < settings.samples_end()) {
    int step = settings.samples_end();
    if (is_limited)
      step = std::clamp(end, 1, 16);  // doubles, so that the first picture is soon there; then even steps
    else if (is_adaptive)
      step = end == 0 ? plan.adaptive_min_samples : std::max(16, end / 4);
    end += std::min(step, settings.samples_end() - end);
    plan.round_ends.push_back(end);
  }
  return plan;
}

}  // namespace basicrt
