// SPDX-License-Identifier: GPL-3.0-or-later
// Microfacet distributions against the identities that define them.
#include "bsdf/microfacets.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bsdf/fixtures.h"

namespace basicrt {
namespace {

using test::Rng;

const std::vector<Microfacets> all_microfacets = {
    {0.02f, 0.02f, MicrofacetModel::ggx},      {0.3f, 0.3f, MicrofacetModel::ggx},
    {0.1f, 0.6f, MicrofacetModel::ggx},        {1, 1, MicrofacetModel::ggx},
    {0.02f, 0.02f, MicrofacetModel::beckmann}, {0.3f, 0.3f, MicrofacetModel::beckmann},
    {0.1f, 0.6f, MicrofacetModel::beckmann},   {1, 1, MicrofacetModel::beckmann}};

std::string describe(const Microfacets& m, float degrees) {
  return std::string(m.model == MicrofacetModel::ggx ? "GGX " : "Beckmann ") + std::to_string(m.alpha_x) + " " +
         std::to_string(m.alpha_y) + " from " + std::to_string(degrees) + " degrees";
}

// The integral of f over directions, each weighted by the density of normals: substituting the slope's polar radius
// spreads the peak out.
template <class F>
double integrate_normals(const Microfacets& m, F f) {
  const int radii = 2000, azimuths = 200;
  double sum = 0;
  for (int i = 0; i < radii; ++i)
    for (int j = 0; j < azimuths; ++j) {
      const double r = (i + 0.5) / radii, phi = 2 * std::numbers::pi * (j + 0.5) / azimuths;
      const double tangent = r / (1 - r);  // of the stretched slope
      const double sx = m.alpha_x * tangent * std::cos(phi), sy = m.alpha_y * tangent * std::sin(phi);
      const double z = 1 / std::sqrt(1 + sx * sx + sy * sy);
      const Vec3f normal(Vec3d{sx * z, sy * z, z});
      // d omega = z^3 d slope, d slope = alpha_x alpha_y tangent d tangent d phi.
      const double measure = z * z * z * m.alpha_x * m.alpha_y * tangent / ((1 - r) * (1 - r));
      sum += f(normal) * m.density(normal) * measure * 2 * std::numbers::pi / (radii * azimuths);
    }
  return sum;
}

TEST(Microfacets, cover_the_macroscopic_surface_exactly_once) {
  for (const Microfacets& m : all_microfacets)
    EXPECT_NEAR(integrate_normals(m, [](Vec3f n) { return n.z; }), 1, 1e-3) << describe(m, 0);
}

// Smith's masking is what makes the visible facets fill the macroscopic projected area.
TEST(Microfacets, projected_area_is_that_of_the_facets_turned_to_the_viewer) {
  for (const Microfacets& m : all_microfacets)
    for (const float degrees : {0.0f, 40.0f, 75.0f, 89.0f}) {
      const Vec3f w = test::direction_at(degrees);
      const double area = integrate_normals(m, [&](Vec3f n) { return std::max(dot(w, n), 0.0f); });
      EXPECT_NEAR(m.projected_area(w), area, 2e-3 * area) << describe(m, degrees);
    }
}

TEST(Microfacets, visible_normals_have_their_density) {
  const double threshold = test::sidak_threshold(static_cast<int>(all_microfacets.size()) * 4);
  for (const Microfacets& m : all_microfacets)
    for (const float degrees : {0.0f, 40.0f, 75.0f, 89.0f}) {
      const Vec3f wo = test::direction_at(degrees);
      const auto result = test::chi_square_sphere(
          [&](Rng& rng) -> std::optional<Vec3f> { return m.sample_visible_normal(wo, test::next_unit_vec2(rng)); },
          [&](Vec3f normal) { return m.pdf_visible_normal(wo, normal); });
      EXPECT_NEAR(result.mass, 1, 2e-3) << describe(m, degrees) << ": " << result.describe();
      EXPECT_GT(result.p_value, threshold) << describe(m, degrees) << ": " << result.describe();
    }
}

TEST(Microfacets, sampled_normals_are_always_up_and_of_unit_length) {
  for (const Microfacets& m : all_microfacets)
    for (const float height : {1.0f, 1e-3f, 1e-8f})
      for (const float x : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon})
        for (const float y : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) {
          const Vec3f normal = m.sample_visible_normal(normalize(Vec3f{0.6f, -0.8f, height}), {x, y});
          EXPECT_GT(normal.z, 0);
          EXPECT_NEAR(length(normal), 1, 1e-5);
        }
}

}  // namespace
}  // namespace basicrt
