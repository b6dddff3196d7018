// SPDX-License-Identifier: GPL-3.0-or-later
// The test of tests: the chi-square helper accepts what is right and rejects what is a little wrong.
#include "support/chi_square.h"

#include <gtest/gtest.h>

#include "math/warp.h"

namespace basicrt::test {
namespace {

std::optional<Vec3f> sample_cosine(Rng& rng) { return sample_cosine_hemisphere(next_unit_vec2(rng)); }

TEST(ChiSquare, tail_probability_matches_closed_forms) {
  // Two degrees of freedom: exp(-x/2); one: erfc(sqrt(x/2)).
  for (const double x : {0.1, 1.0, 5.0, 30.0}) {
    EXPECT_NEAR(upper_gamma_q(1, x / 2), std::exp(-x / 2), 1e-12);
    EXPECT_NEAR(upper_gamma_q(0.5, x / 2), std::erfc(std::sqrt(x / 2)), 1e-12);
  }
}

TEST(ChiSquare, rejects_a_density_that_is_a_few_percent_off) {
  const auto wrong = [](Vec3f d) { return d.z > 0 ? pdf_cosine_hemisphere(d.z) * (1 + 0.06 * d.x) : 0; };
  EXPECT_LT(chi_square_sphere(sample_cosine, wrong).p_value, 1e-6);
}

TEST(ChiSquare, rejects_a_density_that_lacks_mass) {
  const auto half = [](Vec3f d) { return pdf_cosine_hemisphere(d.z) / 2; };
  EXPECT_LT(chi_square_sphere(sample_cosine, half).p_value, 1e-6);
}

TEST(ChiSquare, rejects_samples_where_the_density_is_zero) {
  const auto sample = [](Rng& rng) -> std::optional<Vec3f> {
    return next_unit_float(rng) < 0.001f ? Vec3f{0, 0, -1} : *sample_cosine(rng);
  };
  EXPECT_LT(chi_square_sphere(sample, [](Vec3f d) { return pdf_cosine_hemisphere(d.z); }).p_value, 1e-6);
}

TEST(ChiSquare, counts_lost_samples_against_missing_mass) {
  const auto sample = [](Rng& rng) -> std::optional<Vec3f> {
    return next_unit_float(rng) < 0.25f ? std::nullopt : sample_cosine(rng);
  };
  EXPECT_GT(chi_square_sphere(sample, [](Vec3f d) { return 0.75 * pdf_cosine_hemisphere(d.z); }).p_value, 1e-3);
}

TEST(ChiSquare, p_values_are_uniform_when_the_density_is_right) {
  int below_half = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    below_half += chi_square_sphere(sample_cosine, [](Vec3f d) { return pdf_cosine_hemisphere(d.z); },
                                    {.samples = 20000, .pilot_samples = 5000, .seed = seed})
                      .p_value < 0.5;
  EXPECT_GT(below_half, 7);  // 20 +- 4 standard deviations
  EXPECT_LT(below_half, 33);
}

}  // namespace
}  // namespace basicrt::test
