// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel's equations at the places where they are known.
#include "bsdf/fresnel.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

namespace basicrt {
namespace {

TEST(Fresnel, dielectric_at_normal_incidence) {
  for (const float eta : {1.2f, 1.5f, 2.0f, 1 / 1.5f}) {
    EXPECT_NEAR(fresnel_dielectric(1, eta).reflectance, std::pow((eta - 1) / (eta + 1), 2), 1e-6);
    EXPECT_NEAR(reflectance_from_ior(eta), std::pow((eta - 1) / (eta + 1), 2), 1e-6);
  }
}

TEST(Fresnel, reflects_only_perpendicular_light_at_brewsters_angle) {
  for (const float eta : {1.5f, 2.4f, 0.7f}) {
    const float cosine = 1 / std::sqrt(1 + eta * eta);  // tan(theta) = eta
    const double perpendicular = (1.0 - eta * eta) / (1.0 + eta * eta);
    EXPECT_NEAR(fresnel_dielectric(cosine, eta).reflectance, perpendicular * perpendicular / 2, 1e-6);
  }
}

TEST(Fresnel, is_one_at_grazing_incidence_and_past_the_critical_angle) {
  EXPECT_NEAR(fresnel_dielectric(0, 1.5f).reflectance, 1, 1e-6);
  const float critical = std::sqrt(1 - 1 / (1.5f * 1.5f));
  EXPECT_EQ(fresnel_dielectric(critical - 1e-3f, 1 / 1.5f).reflectance, 1);
  EXPECT_LT(fresnel_dielectric(critical + 1e-3f, 1 / 1.5f).reflectance, 0.9f);
}

TEST(Fresnel, is_the_same_from_both_sides) {
  for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f}) {
    const DielectricFresnel outside = fresnel_dielectric(cosine, 1.5f);
    EXPECT_NEAR(outside.reflectance, fresnel_dielectric(outside.cos_transmitted, 1 / 1.5f).reflectance, 1e-5);
  }
}

TEST(Fresnel, conductor_agrees_with_complex_arithmetic) {
  for (const double eta : {0.2, 0.92, 1.5, 3.0})
    for (const double k : {0.0, 0.5, 3.9})
      for (const double cosine : {1.0, 0.8, 0.3, 0.01}) {
        const std::complex<double> index(eta, k);
        const std::complex<double> transmitted = std::sqrt(1.0 - (1 - cosine * cosine) / (index * index));
        const double parallel = std::norm((index * cosine - transmitted) / (index * cosine + transmitted));
        const double perpendicular = std::norm((cosine - index * transmitted) / (cosine + index * transmitted));
        EXPECT_NEAR(fresnel_conductor(float(cosine), float(eta), float(k)), (parallel + perpendicular) / 2, 2e-5)
            << "eta " << eta << " k " << k << " cosine " << cosine;
      }
}

TEST(Fresnel, mean_reflectances_agree_with_quadrature) {
  for (const float eta : {1.01f, 1.1f, 1.33f, 1.5f, 2.0f, 3.5f, 5.0f}) {
    double dielectric = 0, schlick = 0;
    const int steps = 10000;
    for (int i = 0; i < steps; ++i) {
      const float mu = (static_cast<float>(i) + 0.5f) / steps;
      dielectric += 2.0 * mu * fresnel_dielectric(mu, eta).reflectance / steps;
      schlick += 2.0 * mu * fresnel_schlick(mu, Color(0.3f)).x / steps;
    }
    EXPECT_NEAR(mean_fresnel_dielectric(eta), dielectric, 0.02 * dielectric);
    EXPECT_NEAR(SchlickFresnel{Color(0.3f)}.mean().x, schlick, 1e-5);
  }
}

TEST(Fresnel, ior_and_reflectance_are_inverses) {
  for (const float ior : {1.0f, 1.33f, 1.5f, 3.0f})
    EXPECT_NEAR(ior_from_reflectance(reflectance_from_ior(ior)), ior, 1e-5);
}

}  // namespace
}  // namespace basicrt
