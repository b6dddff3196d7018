// SPDX-License-Identifier: GPL-3.0-or-later
// The filters' formulas, and the inversion of their cumulative distributions by table.
#include "sampling/filter.h"

#include <algorithm>
#include <cmath>

#include "math/constants.h"

namespace basicrt {
namespace {

// Enough that the table differs from the filter by less than 1e-5 of its peak.
constexpr int cell_count = 512;

// Less its value at the radius: no step there.
double gaussian(double x, double radius, double falloff) {
  return std::exp(-falloff * x * x) - std::exp(-falloff * radius * radius);
}

// Harris 1978, "On the use of windows for harmonic analysis", the four-term window; Blender's default filter.
double blackman_harris(double x, double radius) {
  const double v = std::numbers::pi * (x / radius + 1);
  return 0.35875 - 0.48829 * std::cos(v) + 0.14128 * std::cos(2 * v) - 0.01168 * std::cos(3 * v);
}

// Mitchell and Netravali 1988, B = C = 1/3; its own support is two on each side.
double mitchell(double x, double radius) {
  constexpr double b = 1.0 / 3, c = 1.0 / 3;
  const double t = std::abs(2 * x / radius);
  if (t < 1) return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + (6 - 2 * b)) / 6;
  return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + (8 * b + 24 * c)) / 6;
}

double eval_filter(const FilterSettings& settings, double x) {
  const double radius = settings.radius;
  if (std::abs(x) > radius) return 0;
  switch (settings.kind) {
    case FilterKind::box:
      return 1;
    case FilterKind::tent:
      return 1 - std::abs(x) / radius;
    case FilterKind::gaussian:
      return gaussian(x, radius, settings.falloff);
    case FilterKind::blackman_harris:
      return blackman_harris(x, radius);
    case FilterKind::mitchell:
      return mitchell(x, radius);
  }
  return 0;
}

// Of the filter over one cell, by Simpson's rule.
double integrate_cell(const FilterSettings& settings, int cell) {
  const double width = 2.0 * settings.radius / cell_count, begin = -double(settings.radius) + cell * width;
  return width / 6 *
         (eval_filter(settings, begin) + 4 * eval_filter(settings, begin + width / 2) +
          eval_filter(settings, std::min(begin + width, double(settings.radius))));
}

}  // namespace

PixelFilter::PixelFilter(const FilterSettings& settings) : settings_(settings) {
  if (settings.kind == FilterKind::box) return;

  double integral = 0, absolute_integral = 0;
  std::vector<double> running{0};
  for (int cell = 0; cell < cell_count; ++cell) {
    const double mass = integrate_cell(settings, cell);
    integral += mass;
    absolute_integral += std::abs(mass);
    running.push_back(absolute_integral);
    is_negative_.push_back(mass < 0);
  }
  for (const double mass : running) cdf_.push_back(static_cast<float>(mass / absolute_integral));
  cdf_.back() = 1;
  // The integral of |filter| in both directions is 1 + 2 negative_mass.
  const double ratio = absolute_integral / integral;
  negative_mass_ = static_cast<float>((ratio * ratio - 1) / 2);

  std::uint16_t cell = 0;
  for (int i = 0; i < cell_count; ++i) {
    while (cdf_[cell + 1] <= static_cast<float>(i) / cell_count) ++cell;
    guide_.push_back(cell);
  }
}

PixelFilter::AxisSample PixelFilter::sample_axis(float u) const {
  std::size_t cell = guide_[static_cast<std::size_t>(u * cell_count)];
  while (cdf_[cell + 1] <= u) ++cell;
  const float within_cell = (u - cdf_[cell]) / (cdf_[cell + 1] - cdf_[cell]);
  const float position = (static_cast<float>(cell) + within_cell) * (2.0f / cell_count) - 1;
  return {position * settings_.radius, is_negative_[cell]};
}

FilterSample PixelFilter::sample(Vec2f u) const {
  if (settings_.kind == FilterKind::box) return {{(2 * u.x - 1) * settings_.radius, (2 * u.y - 1) * settings_.radius}};
  const AxisSample x = sample_axis(u.x), y = sample_axis(u.y);
  return {{x.offset, y.offset}, x.is_negative != y.is_negative};
}

float PixelFilter::eval(float distance) const { return static_cast<float>(eval_filter(settings_, distance)); }

}  // namespace basicrt
