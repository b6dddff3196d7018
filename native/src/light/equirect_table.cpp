// SPDX-License-Identifier: GPL-3.0-or-later
// Three steps: a row by its share of all, a block of the row, a cell of the block. What is sampled is what the stored
// weights say, however much they were rounded.
#include "light/equirect_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/assert.h"
#include "base/parallel_for.h"
#include "light/environment.h"

namespace basicrt {
namespace {

constexpr float largest_weight = 1e36f;
constexpr int rows_at_once = 32;

// To the nearest float with eight bits of mantissa.
std::uint16_t pack(float weight) {
  BASICRT_ASSERT(weight >= 0);
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(std::min(weight, largest_weight)) + 0x8000u) >> 16);
}
float unpack(std::uint16_t weight) { return std::bit_cast<float>(std::uint32_t{weight} << 16); }

}  // namespace

EquirectTable::EquirectTable(int width, int height, const std::function<void(int, std::span<float>)>& fill_row,
                             int threads)
    : width_(width), height_(height), blocks_((width + block_size - 1) / block_size) {
  weights_.resize(cell_index(0, height));
  block_ends_.resize(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(height));
  for (int row = 0; row <= height; ++row)
    sin_latitudes_.push_back(std::sin((double(row) / height - 0.5) * std::numbers::pi));

  std::vector<double> row_powers(static_cast<std::size_t>(height));
  const auto make_row = [&](int row, std::span<float> weights) {
    fill_row(row, weights);
    Weight* packed = weights_.data() + cell_index(0, row);
    float* ends = block_ends_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks_);
    double sum = 0;
    for (int block = 0; block < blocks_; ++block) {
      const int begin = block * block_size, end = std::min(begin + block_size, width_);
      for (int i = begin; i < end; ++i) {
        packed[i] = pack(weights[i]);
        sum += unpack(packed[i]);
      }
      ends[block] = static_cast<float>(sum);
    }
    const double solid_angle = 2 * std::numbers::pi / width_ * (sin_latitudes_[row + 1] - sin_latitudes_[row]);
    row_powers[row] = sum * solid_angle;
  };
  parallel_for(static_cast<std::size_t>((height + rows_at_once - 1) / rows_at_once), threads, [&](std::size_t chunk) {
    std::vector<float> weights(static_cast<std::size_t>(width));
    const int begin = static_cast<int>(chunk) * rows_at_once, end = std::min(begin + rows_at_once, height);
    for (int row = begin; row < end; ++row) make_row(row, weights);
  });
  rows_ = DiscreteDistribution(std::move(row_powers));
  if (total() > 0) density_scale_ = static_cast<float>(1 / total());
}

EquirectTable::Cell EquirectTable::find_cell(int row, float u) const {
  const float* ends = block_ends_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks_);
  const float target = u * ends[blocks_ - 1];
  // The first block that ends after the target: never one of no weight.
  const auto found = static_cast<int>(std::upper_bound(ends, ends + blocks_, target) - ends);
  const int block = std::min(found, blocks_ - 1);
  float rest = target - (block > 0 ? ends[block - 1] : 0);

  const Weight* weights = weights_.data() + cell_index(0, row);
  const int begin = block * block_size, end = std::min(begin + block_size, width_);
  Cell cell;
  for (int i = begin; i < end; ++i) {
    const float weight = unpack(weights[i]);
    if (weight == 0) continue;
    cell = {i, std::min(rest / weight, one_minus_epsilon)};
    if (rest < weight) break;
    rest -= weight;
  }
  return cell;
}

EquirectTable::Sample EquirectTable::sample(Vec2f u) const {
  const auto [row, probability, inside_row] = rows_.choose(u.y);
  const Cell cell = find_cell(static_cast<int>(row), u.x);

  const double z = lerp(sin_latitudes_[row], sin_latitudes_[row + 1], double(inside_row));
  const auto cos_latitude = static_cast<float>(std::sqrt(std::max((1 - z) * (1 + z), 0.0)));
  const float place = (static_cast<float>(cell.column) + cell.inside) / static_cast<float>(width_);
  const float longitude = (0.5f - place) * 2 * pi;
  return {.direction = {cos_latitude * std::cos(longitude), cos_latitude * std::sin(longitude), static_cast<float>(z)},
          .pdf = unpack(weights_[cell_index(cell.column, static_cast<int>(row))]) * density_scale_};
}

float EquirectTable::pdf(Vec3f direction) const {
  const Vec2f uv = project_direction(EnvironmentProjection::equirectangular, direction);
  const auto index = [](float coordinate, int size) {
    return std::clamp(static_cast<int>(coordinate * static_cast<float>(size)), 0, size - 1);
  };
  return unpack(weights_[cell_index(index(uv.x, width_), index(uv.y, height_))]) * density_scale_;
}

}  // namespace basicrt
