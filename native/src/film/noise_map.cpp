// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of pixels, and the blocks that are open.
#include "film/noise_map.h"

#include <algorithm>
#include <cmath>

namespace basicrt {

NoiseMap::NoiseMap(int width, int height, float threshold)
    : width_(width),
      height_(height),
      blocks_per_row_((width + block_size - 1) / block_size),
      threshold_(threshold),
      moments_(static_cast<std::size_t>(width) * height),
      is_block_open_(static_cast<std::size_t>(blocks_per_row_) * ((height + block_size - 1) / block_size), true) {}

double NoiseMap::error(const Moments& moments, int samples) const {
  constexpr double darkest = 1e-8;  // no division by zero
  const double mean = moments.sum / samples;
  const double variance = std::max(moments.sum_of_squares / samples - mean * mean, 0.0);
  return std::sqrt(variance / (std::max(samples - 1, 1) * std::max(mean, darkest)));
}

int NoiseMap::update(int samples) {
  std::vector<bool> is_noisy(is_block_open_.size());
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      if (is_open(x, y) && error(moments_[static_cast<std::size_t>(y) * width_ + x], samples) > threshold_)
        is_noisy[block_of(x, y)] = true;
  int closed = 0;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) closed += is_open(x, y) && !is_noisy[block_of(x, y)];
  is_block_open_ = std::move(is_noisy);
  return closed;
}

bool NoiseMap::has_open() const { return std::ranges::find(is_block_open_, true) != is_block_open_.end(); }

}  // namespace basicrt
