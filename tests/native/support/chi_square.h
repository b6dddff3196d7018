// SPDX-License-Identifier: GPL-3.0-or-later
// Pearson's chi-square test that a sampling routine draws from the density it claims.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "math/vec.h"

namespace basicrt::test {

using Rng = std::mt19937_64;

inline float next_unit_float(Rng& rng) { return static_cast<float>(rng() >> 40) * 0x1p-24f; }
inline Vec2f next_unit_vec2(Rng& rng) {
  const float x = next_unit_float(rng);
  return {x, next_unit_float(rng)};
}

struct ChiSquareOptions {
  int samples = 200000;
  int pilot_samples = 20000;  // shape the cells, and are not counted
  std::uint64_t seed = 1;
};

struct ChiSquareResult {
  double p_value = 0;
  double statistic = 0;
  int degrees_of_freedom = 0;
  double mass = 0;  // the integral of the density: 1 less the probability that there is no sample
  std::uint64_t seed = 0;

  [[nodiscard]] std::string describe() const {
    return "chi^2 = " + std::to_string(statistic) + " with " + std::to_string(degrees_of_freedom) +
           " degrees of freedom, p = " + std::to_string(p_value) + ", density integrates to " + std::to_string(mass) +
           ", seed " + std::to_string(seed);
  }
};

// The p-value under which one of `tests` independent tests is a failure, so that all of them together fail by chance
// with probability `significance` (Sidak's correction).
inline double sidak_threshold(int tests, double significance = 1e-3) {
  return 1 - std::pow(1 - significance, 1.0 / tests);
}

// The regularised upper incomplete gamma function: by its series left of a + 1, by Lentz's continued fraction right
// of it (Abramowitz and Stegun 6.5.29 and 6.5.31).
inline double upper_gamma_q(double a, double x) {
  if (x <= 0) return 1;
  const double prefix = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * 1e-15; ++n) sum += term *= x / n;
    return 1 - prefix * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
  for (int i = 1; i < 100000; ++i) {
    const double coefficient = -i * (i - a);
    b += 2;
    d = 1 / (coefficient * d + b);
    c = b + coefficient / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return prefix * fraction;
}

// A partition of the unit square into rectangles that each hold a like number of pilot samples.
class AdaptiveCells {
 public:
  struct Cell {
    Vec2d lower, upper;
    int split_axis = -1;  // -1: a leaf
    int first_child = -1;
  };

  explicit AdaptiveCells(std::vector<Vec2d> pilot) { split(make_cell({0, 0}, {1, 1}), std::move(pilot), 0); }

  [[nodiscard]] int find(Vec2d p) const {
    int index = 0;
    while (cells_[index].split_axis >= 0) {
      const Cell& cell = cells_[index];
      const bool is_x = cell.split_axis == 0;
      const double middle = is_x ? (cell.lower.x + cell.upper.x) / 2 : (cell.lower.y + cell.upper.y) / 2;
      index = cell.first_child + ((is_x ? p.x : p.y) >= middle ? 1 : 0);
    }
    return index;
  }
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

 private:
  int make_cell(Vec2d lower, Vec2d upper) {
    cells_.push_back({lower, upper});
    return static_cast<int>(cells_.size()) - 1;
  }

  // The axis along which the samples leave most of the cell empty, or -1.
  static int empty_axis(const Cell& cell, const std::vector<Vec2d>& pilot) {
    if (pilot.size() < 4) return -1;
    Vec2d lower = cell.upper, upper = cell.lower;
    for (const Vec2d p : pilot) {
      lower = {std::min(lower.x, p.x), std::min(lower.y, p.y)};
      upper = {std::max(upper.x, p.x), std::max(upper.y, p.y)};
    }
    const double filled_x = (upper.x - lower.x) / (cell.upper.x - cell.lower.x);
    const double filled_y = (upper.y - lower.y) / (cell.upper.y - cell.lower.y);
    if (std::min(filled_x, filled_y) > 0.3) return -1;
    return filled_x < filled_y ? 0 : 1;
  }

  // Halves cells in turn along x and y: everywhere down to 1/8 of the square, further where samples crowd. An edge of
  // the density, which the integration must not step over, shows as a cell that is mostly empty: it is halved, too.
  void split(int index, std::vector<Vec2d> pilot, int depth) {
    constexpr int least_depth = 6, greatest_depth = 34;
    constexpr std::size_t crowd = 80;
    const Cell cell = cells_[index];
    const int empty = empty_axis(cell, pilot);
    const bool is_divided = depth < least_depth || pilot.size() >= crowd || empty >= 0;
    if (depth >= greatest_depth || !is_divided) return;
    const int axis = empty >= 0 && depth >= least_depth ? empty : depth & 1;
    Vec2d left_upper = cell.upper, right_lower = cell.lower;
    (axis == 0 ? left_upper.x : left_upper.y) =
        axis == 0 ? (cell.lower.x + cell.upper.x) / 2 : (cell.lower.y + cell.upper.y) / 2;
    (axis == 0 ? right_lower.x : right_lower.y) = axis == 0 ? left_upper.x : left_upper.y;
    const int left = make_cell(cell.lower, left_upper);
    const int right = make_cell(right_lower, cell.upper);
    cells_[index].split_axis = axis;
    cells_[index].first_child = left;
    std::array<std::vector<Vec2d>, 2> parts;
    for (const Vec2d p : pilot) parts[(axis == 0 ? p.x >= right_lower.x : p.y >= right_lower.y) ? 1 : 0].push_back(p);
    split(left, std::move(parts[0]), depth + 1);
    split(right, std::move(parts[1]), depth + 1);
  }

  std::vector<Cell> cells_;
};

// Gauss-Legendre with 4 x 4 points, halved in both directions until the halves agree with the whole.
inline double integrate(const std::function<double(Vec2d)>& f, Vec2d lower, Vec2d upper, double tolerance,
                        int depth_left = 7) {
  const auto gauss = [&](Vec2d a, Vec2d b) {
    constexpr std::array nodes{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
    constexpr std::array weights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
    const Vec2d center = (a + b) * 0.5, half = (b - a) * 0.5;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j)
        sum += weights[i] * weights[j] * f({center.x + nodes[i] * half.x, center.y + nodes[j] * half.y});
    return sum * half.x * half.y;
  };
  const std::function<double(Vec2d, Vec2d, double, double, int)> refine = [&](Vec2d a, Vec2d b, double whole,
                                                                              double error, int depth) {
    const Vec2d m = (a + b) * 0.5;
    const std::array corners{std::pair{a, m}, std::pair{Vec2d{m.x, a.y}, Vec2d{b.x, m.y}},
                             std::pair{Vec2d{a.x, m.y}, Vec2d{m.x, b.y}}, std::pair{m, b}};
    std::array<double, 4> parts;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) sum += parts[i] = gauss(corners[i].first, corners[i].second);
    if (depth == 0 || std::abs(sum - whole) < error) return sum;
    sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      sum += refine(corners[i].first, corners[i].second, parts[i], error / 2, depth - 1);
    return sum;
  };
  return refine(lower, upper, gauss(lower, upper), tolerance, depth_left);
}

// `sample` gives a point of the unit square, or nothing; `density` is per area of the square. Samples that are
// nothing are compared with the mass that the density lacks.
inline ChiSquareResult chi_square_square(const std::function<std::optional<Vec2d>(Rng&)>& sample,
                                         const std::function<double(Vec2d)>& density,
                                         const ChiSquareOptions& options = {}) {
  Rng rng(options.seed);
  std::vector<Vec2d> pilot;
  for (int i = 0; i < options.pilot_samples; ++i)
    if (const auto p = sample(rng)) pilot.push_back(*p);
  const AdaptiveCells cells(std::move(pilot));

  std::vector<double> observed(cells.cells().size());
  double observed_nothing = 0;
  for (int i = 0; i < options.samples; ++i) {
    const auto p = sample(rng);
    ++(p ? observed[cells.find(*p)] : observed_nothing);
  }

  ChiSquareResult result;
  result.seed = options.seed;
  const double count = options.samples;
  double pooled_observed = 0, pooled_expected = 0;
  int bins = 0;
  const auto add_bin = [&](double seen, double expected) {
    result.statistic += (seen - expected) * (seen - expected) / expected;
    ++bins;
  };
  for (std::size_t i = 0; i < cells.cells().size(); ++i) {
    const auto& cell = cells.cells()[i];
    if (cell.split_axis >= 0) continue;
    const double mass = integrate(density, cell.lower, cell.upper, 1e-7);
    result.mass += mass;
    if (mass * count >= 5) {
      add_bin(observed[i], mass * count);
    } else {
      pooled_observed += observed[i];
      pooled_expected += mass * count;
    }
  }
  // The remainders have one bin together. Half a sample of slack: a mass of 1 - 1e-6 is rounding, not a hole.
  pooled_observed += observed_nothing;
  pooled_expected += std::max(0.0, 1 - result.mass) * count;
  if (pooled_expected >= 5) {
    add_bin(pooled_observed, pooled_expected);
  } else if (pooled_observed > pooled_expected + 8 * std::sqrt(pooled_expected + 1)) {
    result.statistic = std::numeric_limits<double>::infinity();  // samples where there should be none
  }
  result.degrees_of_freedom = std::max(1, bins - 1);
  result.p_value =
      std::isfinite(result.statistic) ? upper_gamma_q(result.degrees_of_freedom / 2.0, result.statistic / 2) : 0;
  // A density with more mass than one is wrong however the samples fall.
  if (result.mass > 1.002) result.p_value = 0;
  return result;
}

// The sphere's equal-area map to the unit square, and back: x is the height, y the longitude.
inline Vec2d to_square(Vec3f direction) {
  const Vec3d d(direction);
  const double turn = std::atan2(d.y, d.x) * (std::numbers::inv_pi / 2);
  return {std::clamp((1 - d.z / length(d)) / 2, 0.0, 1.0), turn < 0 ? turn + 1 : turn};
}
inline Vec3f to_direction(Vec2d p) {
  const double z = 1 - 2 * p.x, r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * std::numbers::pi * p.y;
  return Vec3f(Vec3d{r * std::cos(phi), r * std::sin(phi), z});
}

// Directions: `pdf` is over solid angle and holds for directions of unit length.
inline ChiSquareResult chi_square_sphere(const std::function<std::optional<Vec3f>(Rng&)>& sample,
                                         const std::function<double(Vec3f)>& pdf,
                                         const ChiSquareOptions& options = {}) {
  return chi_square_square(
      [&](Rng& rng) -> std::optional<Vec2d> {
        const auto direction = sample(rng);
        if (!direction) return std::nullopt;
        return to_square(*direction);
      },
      [&](Vec2d p) { return 4 * std::numbers::pi * pdf(to_direction(p)); }, options);
}

}  // namespace basicrt::test
