// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive sampling: which pixels of a tile are still noisy, from the second moments of their samples.
#pragma once

#include <cstdint>
#include <vector>

#include "film/film.h"

namespace basicrt {

// Pixels have enough samples a block at a time: a block of few samples that all happen to agree is less likely than a
// pixel of them. A block is open until all of its pixels' errors are below the threshold. An error is the standard error
// of r + g + b over the square root of its mean: as in Blender, what is dark may be a little noisier.
class NoiseMap {
 public:
  static constexpr int block_size = 4;  // pixels; tiles begin where blocks do

  NoiseMap(int width, int height, float threshold);

  // Within the tile. Each pixel's samples must come in order.
  void add(int x, int y, Color radiance) {
    Moments& moments = moments_[static_cast<std::size_t>(y) * width_ + x];
    const double sum = double(radiance.x) + radiance.y + radiance.z;
    moments.sum += sum;
    moments.sum_of_squares += sum * sum;
  }
  // Closes blocks, after every open pixel was given `samples` of them. Returns how many pixels are in those it closed.
  int update(int samples);
  [[nodiscard]] bool is_open(int x, int y) const { return is_block_open_[block_of(x, y)]; }
  [[nodiscard]] bool has_open() const;

 private:
  struct Moments {
    double sum = 0, sum_of_squares = 0;
  };
  [[nodiscard]] std::size_t block_of(int x, int y) const {
    return static_cast<std::size_t>(y / block_size) * blocks_per_row_ + x / block_size;
  }
  [[nodiscard]] double error(const Moments& moments, int samples) const;

  int width_, height_, blocks_per_row_;
  float threshold_;
  std::vector<Moments> moments_;
  std::vector<bool> is_block_open_;
};

}  // namespace basicrt
