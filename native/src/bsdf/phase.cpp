// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms, and sampling by inverted cumulative distributions.
#include "bsdf/phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/constants.h"

namespace basicrt {
namespace {

constexpr double inv_4_pi = std::numbers::inv_pi / 4;
// sin^2(theta / 2) within which Fournier and Forand's function is replaced by its mean: a float's cosine knows hardly more.
constexpr double peak = 1e-5;
constexpr float largest_g = 0.999f, smallest_g = 1e-3f;

// Next to 0 formulas that divide by it lose their digits, and next to 1 all light goes one way.
float usable_g(float g) { return std::abs(g) < smallest_g ? 0 : std::clamp(g, -largest_g, largest_g); }

// Where an increasing function reaches `value` in [low, high].
template <class Function>
double find_value(Function&& function, double value, double low, double high) {
  constexpr int halvings = 40;
  for (int i = 0; i < halvings; ++i) {
    const double middle = (low + high) / 2;
    (function(middle) < value ? low : high) = middle;
  }
  return (low + high) / 2;
}

double henyey_greenstein(double g, double cos_theta) {
  const double s = 1 + g * g - 2 * g * cos_theta;
  return inv_4_pi * (1 - g * g) / (s * std::sqrt(s));
}

}  // namespace

HenyeyGreenstein::HenyeyGreenstein(float g) : g_(usable_g(g)) {}

float HenyeyGreenstein::eval(float cos_theta) const { return static_cast<float>(henyey_greenstein(g_, cos_theta)); }

float HenyeyGreenstein::sample(float u) const {
  if (g_ == 0) return 2 * u - 1;
  const float part = (1 - g_ * g_) / (1 - g_ + 2 * g_ * u);
  return std::clamp((1 + g_ * g_ - part * part) / (2 * g_), -1.0f, 1.0f);
}

Draine::Draine(float g, float alpha)
    : g_(usable_g(g)), alpha_(alpha), norm_(1 / (1 + double{alpha} * (1 + 2 * g_ * g_) / 3)) {}

float Draine::eval(float cos_theta) const {
  return static_cast<float>(henyey_greenstein(g_, cos_theta) * (1 + alpha_ * cos_theta * cos_theta) * norm_);
}

// Of (1 + alpha cos^2 theta) s^(-3/2) over s = 1 + g^2 - 2 g cos theta.
double Draine::antiderivative(double s) const {
  const double a = 1 + g_ * g_, root = std::sqrt(s);
  return -2 / root + alpha_ / (4 * g_ * g_) * (-2 * a * a / root - 4 * a * root + 2.0 / 3 * s * root);
}

double Draine::cdf(double cos_theta) const {
  if (g_ == 0) return norm_ / 2 * (cos_theta + 1 + alpha_ / 3 * (cos_theta * cos_theta * cos_theta + 1));
  const double s = 1 + g_ * g_ - 2 * g_ * cos_theta, first = (1 + g_) * (1 + g_);
  return norm_ * (1 - g_ * g_) / (4 * g_) * (antiderivative(first) - antiderivative(s));
}

float Draine::sample(float u) const {
  return static_cast<float>(find_value([&](double cos_theta) { return cdf(cos_theta); }, u, -1, 1));
}

FournierForand::FournierForand(float ior, float backscatter) {
  const double index = std::max(ior, 1.001f), back_share = std::clamp(backscatter, 1e-3f, 0.499f);
  delta_scale_ = 4 / (3 * (index - 1) * (index - 1));
  double delta_90 = delta_scale_ / 2;
  if (std::abs(delta_90 - 1) < 1e-3) {  // where the formulas divide by 0
    delta_90 = 1.001;
    delta_scale_ = 2 * delta_90;
  }
  nu_ = std::log(0.5 / (0.5 + back_share * (delta_90 - 1))) / std::log(delta_90);
  const double power = std::pow(delta_scale_, nu_);
  back_ = std::abs(delta_scale_ - 1) < 1e-6 ? -nu_ : (1 - power) / ((delta_scale_ - 1) * power);
  in_peak_ = cdf(peak);
}

float FournierForand::eval(float cos_theta) const {
  const double x = (1 - double{cos_theta}) / 2;
  if (x < peak) return static_cast<float>(inv_4_pi * in_peak_ / peak);
  double delta = delta_scale_ * x;
  if (std::abs(delta - 1) < 1e-4) delta = 1 + 1e-4;  // there the quotient is smooth, but 0 / 0
  const double power = std::pow(delta, nu_);
  const double forward = (nu_ * (1 - delta) - (1 - power) + (delta * (1 - power) - nu_ * (1 - delta)) / x) /
                         ((1 - delta) * (1 - delta) * power);
  return static_cast<float>(std::max(inv_4_pi * (forward + back_ / 4 * (3 * double{cos_theta} * cos_theta - 1)), 0.0));
}

double FournierForand::cdf(double x) const {
  double delta = delta_scale_ * x;
  if (std::abs(delta - 1) < 1e-6) delta = 1 + 1e-6;
  const double power = std::pow(delta, nu_), cos_theta = 1 - 2 * x, sin_squared = 4 * x * (1 - x);
  return (1 - delta * power - (1 - power) * x) / ((1 - delta) * power) + back_ / 8 * cos_theta * sin_squared;
}

// By the cube root of x, for most of the light hardly turns.
float FournierForand::sample(float u) const {
  if (u < in_peak_) return static_cast<float>(1 - 2 * peak * u / in_peak_);
  const double root = find_value([&](double r) { return cdf(r * r * r); }, u, std::cbrt(peak), 1);
  return static_cast<float>(1 - 2 * root * root * root);
}

// Equations 4 to 15 of the paper, each for its range of diameters.
MieMixture make_mie(float diameter) {
  const double d = std::clamp(double{diameter}, 0.0, 50.0), l = std::log(d);
  double g, g_draine, alpha, share;
  if (d <= 0.1) {
    g = 13.8 * d * d;
    g_draine = 1.1456 * d * std::sin(9.29044 * d);
    alpha = 250;
    share = 0.252977 - 312.983 * std::pow(d, 4.3);
  } else if (d < 1.5) {
    g = 0.862 - 0.143 * l * l;
    g_draine = 0.379685 * std::cos(1.19692 * std::cos((l - 0.238604) * (l + 1.00667) / (0.507522 - 0.15677 * l)) +
                                   1.37932 * l + 0.0625835) +
               0.344213;
    alpha = 250;
    share = 0.146209 * std::cos(3.38707 * l + 2.11193) + 0.316072 + 0.0778917 * l;
  } else if (d < 5) {
    const double ll = std::log(l);
    g = 0.0604931 * ll + 0.940256;
    g_draine = 0.500411 - 0.081287 / (-2 * l + std::tan(l) + 1.27551);
    alpha = 7.30354 * l + 6.31675;
    share = 0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.376475;
  } else {
    g = std::exp(-0.0990567 / (d - 1.67154));
    g_draine = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
    alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825));
    share = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
  }
  return {HenyeyGreenstein(static_cast<float>(g)), Draine(static_cast<float>(g_draine), static_cast<float>(alpha)),
          static_cast<float>(std::clamp(share, 0.0, 1.0))};
}

}  // namespace basicrt
