// SPDX-License-Identifier: GPL-3.0-or-later
// The four parts of Chiang's hair, and sampling one of them.
#include "bsdf/chiang_hair.h"

#include <numbers>

#include "bsdf/fresnel.h"

namespace basicrt {
namespace {

constexpr int parts = 4;
constexpr double pi_d = std::numbers::pi;

float square(float x) { return x * x; }
float power(float x, int n) {
  float result = 1;
  for (int i = 0; i < n; ++i) result *= x;
  return result;
}

// From what artists see as even steps to variance along the fibre, and to the width of the logistic around it.
float variance_of_roughness(float roughness) {
  return square(0.726f * roughness + 0.812f * square(roughness) + 3.7f * power(roughness, 20));
}
float scale_of_roughness(float roughness) {
  return (0.265f * roughness + 1.194f * square(roughness) + 5.372f * power(roughness, 22)) * std::sqrt(pi / 8);
}

// The logarithm of the modified Bessel function of the first kind, order 0: its series, or what that tends to (Abramowitz
// and Stegun 1964, 9.7.1).
double log_bessel(double x) {
  if (x > 12) return x - 0.5 * std::log(2 * pi_d * x) + std::log1p((1 + (9.0 / 16 + 75.0 / (128 * x)) / x) / (8 * x));
  double term = 1, sum = 1;
  for (int i = 1; i < 40; ++i) {
    term *= x * x / (4.0 * i * i);
    sum += term;
  }
  return std::log(sum);
}

// d'Eon et al. 2011, "An energy-conserving hair reflectance model": around the cone that smooth fibre scatters into. Over
// solid angle, but for what lies around the fibre.
double longitudinal(float sine_in, float cosine_in, float sine_out, float cosine_out, float variance) {
  const double v = variance, cosines = double{cosine_in} * cosine_out / v, sines = double{sine_in} * sine_out / v;
  // 2 v sinh(1 / v), without what overflows.
  const double log_norm = 1 / v + std::log(v) + std::log1p(-std::exp(-2 / v));
  return std::exp(log_bessel(cosines) - sines - log_norm);
}

double logistic(double x, double s) {
  const double e = std::exp(-std::abs(x) / s);
  return e / (s * (1 + e) * (1 + e));
}
double logistic_cdf(double x, double s) { return 1 / (1 + std::exp(-x / s)); }
// Within half a turn to both sides.
double trimmed_logistic(double x, double s) { return logistic(x, s) / (1 - 2 * logistic_cdf(-pi_d, s)); }
double sample_trimmed_logistic(double u, double s) {
  const double below = logistic_cdf(-pi_d, s);
  return std::clamp(-s * std::log(1 / (u * (1 - 2 * below) + below) - 1), -pi_d, pi_d);
}

double wrap(double angle) { return angle - 2 * pi_d * std::floor((angle + pi_d) / (2 * pi_d)); }

}  // namespace

// All that depends on wo alone.
struct ChiangHair::Scattering {
  FiberFrame frame;
  std::array<Color, parts> attenuation;
  std::array<float, parts> share;         // of the energy: they add up to 1
  std::array<float, parts> variance;      // along the fibre
  std::array<float, parts> sine, cosine;  // of wo, tilted by the scales
  std::array<double, parts> turn;         // around the fibre
};

ChiangHair::ChiangHair(const ChiangHairSettings& settings, Vec3f fiber)
    : absorption_(max(settings.absorption, Color(0.0f))), fiber_(fiber), ior_(std::max(settings.ior, 1.0001f)) {
  const auto usable = [](float roughness) { return std::clamp(roughness, 0.001f, 1.0f); };
  const float roughness = usable(settings.roughness);
  variance_ = variance_of_roughness(roughness);
  scale_ = scale_of_roughness(usable(settings.radial_roughness));
  const float first = variance_of_roughness(usable(roughness * (1 - std::clamp(settings.coat, 0.0f, 1.0f))));
  coat_ = static_cast<std::uint16_t>(std::sqrt(first / variance_) * most_coat + 0.5f) & most_coat;
  tilt_ = static_cast<std::uint16_t>((1 + std::clamp(-settings.offset / pi, -1.0f, 1.0f)) * no_tilt + 0.5f) & 0x7fff;
}

ChiangHair::Scattering ChiangHair::scattering(Vec3f wo) const {
  const Vec3f along = fiber_.vector();
  Scattering s{.frame = FiberFrame(along, wo)};
  const float sine = std::clamp(dot(wo, along), -1.0f, 1.0f), cosine = cos_of_sin(sine);
  // How far off the middle: the normal as the viewer sees it turned.
  const float h = std::clamp(-dot(cross(Vec3f{0, 0, 1}, along), s.frame.towards), -1.0f, 1.0f);
  const float cosine_inside = cos_of_sin(sine / ior_);
  const float sine_gamma = std::clamp(h * cosine / std::sqrt(ior_ * ior_ - sine * sine), -1.0f, 1.0f);
  const double gamma_out = std::asin(double{h}), gamma_inside = std::asin(double{sine_gamma});

  const float fresnel = fresnel_dielectric(cosine * cos_of_sin(h), ior_).reflectance;
  const float path = 2 * cos_of_sin(sine_gamma) / std::max(cosine_inside, 1e-6f);
  const Color through{std::exp(-absorption_.x * path), std::exp(-absorption_.y * path),
                      std::exp(-absorption_.z * path)};
  s.attenuation[0] = Color(fresnel);
  s.attenuation[1] = through * square(1 - fresnel);
  s.attenuation[2] = s.attenuation[1] * through * fresnel;
  const auto rest = [&](float t) { return fresnel < 1 ? t * fresnel / (1 - t * fresnel) : 0; };
  s.attenuation[3] = s.attenuation[2] * Color{rest(through.x), rest(through.y), rest(through.z)};
  float sum = 0;
  for (int p = 0; p < parts; ++p) sum += s.share[p] = luminance(s.attenuation[p]);
  for (float& share : s.share) share /= sum;

  const float coat = std::max(static_cast<float>(coat_), 1.0f) / most_coat;
  s.variance = {variance_ * square(coat), variance_ / 4, 4 * variance_, 4 * variance_};
  const float tilt = (static_cast<float>(tilt_) / no_tilt - 1) * pi;
  const std::array<float, parts> tilts = {-2 * tilt, tilt, 4 * tilt, 0};
  for (int p = 0; p < parts; ++p) {
    s.sine[p] = sine * std::cos(tilts[p]) + cosine * std::sin(tilts[p]);
    s.cosine[p] = std::abs(cosine * std::cos(tilts[p]) - sine * std::sin(tilts[p]));
    s.turn[p] = 2 * p * gamma_inside - 2 * gamma_out + p * pi_d;
  }
  return s;
}

LobeValue ChiangHair::eval(Vec3f wo, Vec3f wi) const {
  const Scattering s = scattering(wo);
  const float sine = std::clamp(dot(wi, s.frame.along), -1.0f, 1.0f), cosine = cos_of_sin(sine);
  const double around = s.frame.angle_around(wi);
  LobeValue sum;
  for (int p = 0; p < parts; ++p) {
    const double azimuthal = p < 3 ? trimmed_logistic(wrap(around - s.turn[p]), scale_) : 1 / (2 * pi_d);
    const auto density =
        static_cast<float>(longitudinal(sine, cosine, s.sine[p], s.cosine[p], s.variance[p]) * azimuthal);
    sum.value += s.attenuation[p] * density;
    sum.pdf += s.share[p] * density;
  }
  if ((wi.z > 0 ? is_reflecting_ : is_transmitting_) == 0) sum.value = Color(0.0f);
  return sum;
}

std::optional<LobeSample> ChiangHair::sample(Vec3f wo, float choice, Vec2f u) const {
  const Scattering s = scattering(wo);
  int p = 0;
  while (p < parts - 1 && choice >= s.share[p]) choice -= s.share[p++];
  const double r = std::clamp(double{choice} / s.share[p], 1e-5, 1.0), v = s.variance[p];
  const double cone = 1 + v * std::log(r + (1 - r) * std::exp(-2 / v));
  const double ring = std::sqrt(std::max(0.0, 1 - cone * cone)) * std::cos(2 * pi_d * u.y);
  const auto sine = static_cast<float>(std::clamp(-cone * s.sine[p] + ring * s.cosine[p], -1.0, 1.0));
  const double around = p < 3 ? s.turn[p] + sample_trimmed_logistic(u.x, scale_) : 2 * pi_d * u.x;
  const Vec3f wi = normalize(s.frame.direction(sine, cos_of_sin(sine), static_cast<float>(wrap(around))));
  const LobeValue value = eval(wo, wi);
  if (!(value.pdf > 0 && std::isfinite(value.pdf))) return std::nullopt;
  return LobeSample{wi, value.value / value.pdf, value.pdf, false,
                    wi.z > 0 ? ScatterKind::glossy : ScatterKind::transmission};
}

void ChiangHair::roughen(float least_alpha) {
  variance_ = std::max(variance_, least_alpha);
  scale_ = std::max(scale_, least_alpha);
}

void ChiangHair::keep_sides(bool is_reflecting, bool is_transmitting) {
  if (!is_reflecting) is_reflecting_ = 0;
  if (!is_transmitting) is_transmitting_ = 0;
}

Color ChiangHair::albedo() const {
  const auto of_channel = [](float absorption) { return std::exp(-std::sqrt(absorption) * 5.6f); };
  return {of_channel(absorption_.x), of_channel(absorption_.y), of_channel(absorption_.z)};
}

Color hair_absorption_of_color(Color color, float radial_roughness) {
  const float x = radial_roughness;
  const float strength = ((((0.245f * x + 5.574f) * x - 10.73f) * x + 2.532f) * x - 0.215f) * x + 5.969f;
  const auto of_channel = [&](float reflectance) {
    return square(std::log(std::clamp(reflectance, 1e-5f, 1.0f)) / strength);
  };
  return {of_channel(color.x), of_channel(color.y), of_channel(color.z)};
}

Color hair_absorption_of_melanin(float eumelanin, float pheomelanin) {
  return Color{0.506f, 0.841f, 1.653f} * eumelanin + Color{0.343f, 0.733f, 1.924f} * pheomelanin;
}

}  // namespace basicrt
