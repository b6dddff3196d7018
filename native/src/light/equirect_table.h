// SPDX-License-Identifier: GPL-3.0-or-later
// A density over directions that is constant in each cell of a grid of longitudes and latitudes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "math/distribution.h"
#include "math/vec.h"

namespace basicrt {

// The grid lies as pictures of the environment do: EnvironmentProjection::equirectangular. Two bytes for each cell, so
// that the cells of a large picture stay small beside it.
class EquirectTable {
 public:
  EquirectTable() = default;
  // fill_row(row, weights) sets the weight of each cell of a row, finite and at least 0; it is called from several
  // threads (0: one per processor).
  EquirectTable(int width, int height, const std::function<void(int, std::span<float>)>& fill_row, int threads);

  // The weights' integral over the sphere. Where it is 0 there is nothing to sample.
  [[nodiscard]] double total() const { return rows_.total(); }

  struct Sample {
    Vec3f direction;
    float pdf;  // over solid angle
  };
  [[nodiscard]] Sample sample(Vec2f u) const;
  [[nodiscard]] float pdf(Vec3f direction) const;  // of any length

 private:
  // The upper half of a float.
  using Weight = std::uint16_t;
  // Cells whose sum is kept: their weights lie in one cache line.
  static constexpr int block_size = 32;

  [[nodiscard]] std::size_t cell_index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column);
  }
  struct Cell {
    int column = 0;
    float inside = 0;  // how far from its left edge to its right one
  };
  [[nodiscard]] Cell find_cell(int row, float u) const;

  int width_ = 0, height_ = 0, blocks_ = 0;  // blocks of a row
  std::vector<Weight> weights_;
  std::vector<float> block_ends_;      // sums of weights from the row's start
  std::vector<double> sin_latitudes_;  // of the rows' edges
  DiscreteDistribution rows_;
  float density_scale_ = 0;  // from weights to densities
};

}  // namespace basicrt
