// SPDX-License-Identifier: GPL-3.0-or-later
// Phase functions: sampling against density, and what each promises of its light.
#include "bsdf/phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bsdf/medium.h"
#include "math/constants.h"
#include "support/chi_square.h"

namespace basicrt {
namespace {

struct NamedPhase {
  std::string name;
  Phase phase;
};

std::vector<NamedPhase> all_phases() {
  const auto g = [](float value) { return HenyeyGreenstein(value); };
  return {{"isotropic", g(0)},
          {"forward", g(0.7f)},
          {"very forward", g(0.99f)},
          {"backward", g(-0.4f)},
          {"rayleigh", Draine(0, 1)},
          {"draine", Draine(0.6f, 4)},
          {"draine backward", Draine(-0.3f, 0.5f)},
          {"mie's draine", make_mie(8).draine},
          {"ocean", FournierForand(1.1f, 0.02f)},
          {"ocean, dense", FournierForand(1.33f, 0.3f)},
          {"ocean, denser than the formulas bear", FournierForand(1.8165f, 0.1f)}};
}

// The integral over the sphere of f(cos theta) times the phase function, by steps even in the cube root of 1 - cos.
template <class Function>
double integrate_phase(const Phase& phase, double least_cos, Function&& f) {
  constexpr int steps = 20000;
  const double end = std::cbrt(1 - least_cos);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double root = (i + 0.5) / steps * end, cos_theta = 1 - root * root * root;
    sum += 2 * std::numbers::pi * eval_phase(phase, static_cast<float>(cos_theta)) * f(cos_theta) * 3 * root * root *
           end / steps;
  }
  return sum;
}

TEST(Phase, integrates_to_one) {
  for (const auto& [name, phase] : all_phases())
    EXPECT_NEAR(integrate_phase(phase, -1, [](double) { return 1.0; }), 1, 2e-3) << name;
}

TEST(Phase, samples_have_the_density_that_eval_gives) {
  const auto phases = all_phases();
  const double threshold = test::sidak_threshold(static_cast<int>(phases.size()));
  for (const auto& [name, phase] : phases) {
    // The cube root again, so that steep peaks are no edge.
    const auto result = test::chi_square_square(
        [&phase = phase](test::Rng& rng) -> std::optional<Vec2d> {
          const double cos_theta = sample_phase(phase, test::next_unit_float(rng));
          return Vec2d(std::cbrt(std::max(1 - cos_theta, 0.0) / 2), test::next_unit_float(rng));
        },
        [&phase = phase](Vec2d p) {
          const double cos_theta = 1 - 2 * p.x * p.x * p.x;
          return 2 * std::numbers::pi * eval_phase(phase, static_cast<float>(cos_theta)) * 6 * p.x * p.x;
        },
        {.samples = 20000, .pilot_samples = 2000});
    EXPECT_GT(result.p_value, threshold) << name << ": " << result.describe();
  }
}

TEST(Phase, henyey_greenstein_turns_light_by_its_mean_cosine) {
  for (const float g : {-0.5f, 0.0f, 0.3f, 0.9f})
    EXPECT_NEAR(integrate_phase(HenyeyGreenstein(g), -1, [](double cos_theta) { return cos_theta; }), g, 1e-3);
}

TEST(Phase, draine_contains_henyey_greenstein_and_rayleigh) {
  for (const float cos_theta : {-1.0f, -0.3f, 0.2f, 1.0f}) {
    EXPECT_NEAR(Draine(0.4f, 0).eval(cos_theta), HenyeyGreenstein(0.4f).eval(cos_theta), 1e-6);
    EXPECT_NEAR(Draine(0, 1).eval(cos_theta), 3 / (16 * pi) * (1 + cos_theta * cos_theta), 1e-6);
  }
}

TEST(Phase, fournier_forand_turns_its_share_of_light_back) {
  for (const float share : {0.01f, 0.1f, 0.4f}) {
    const FournierForand phase(1.33f, share);
    const double forward = integrate_phase(phase, 0, [](double) { return 1.0; });
    EXPECT_NEAR(1 - forward, share, 2e-3);
  }
}

// The four ranges of diameters meet, nearly.
TEST(Phase, mie_changes_little_from_one_diameter_to_the_next) {
  for (const float diameter : {0.1f, 1.5f, 5.0f}) {
    const auto at = [&](float d, float cos_theta) {
      const MieMixture mie = make_mie(d);
      return mie.draine.eval(cos_theta) * mie.draine_share +
             mie.henyey_greenstein.eval(cos_theta) * (1 - mie.draine_share);
    };
    for (const float cos_theta : {-0.5f, 0.0f, 0.5f}) {
      const float before = at(diameter * 0.999f, cos_theta), behind = at(diameter * 1.001f, cos_theta);
      EXPECT_NEAR(before, behind, 0.2f * before) << "diameter " << diameter << ", cosine " << cos_theta;
    }
  }
}

TEST(Medium, adds_and_mixes_what_its_nodes_are) {
  Material material;
  const NodeIndex fog = material.add(VolumeShader{.absorption = Color(1.0f), .scattering = Color(2, 0, 0)});
  const NodeIndex glow = material.add(EmissionShader{.radiance = Color(3.0f), .strength = 2});
  const NodeIndex both = material.add(AddShader{.first = fog, .second = fog});
  const NodeIndex surface = material.add(DiffuseShader{});
  const NodeIndex last = material.add(AddShader{.first = glow, .second = surface});
  material.volume = material.add(MixShader{.factor = 0.25f, .first = both, .second = last});
  const Medium medium = make_medium(material);
  EXPECT_EQ(medium.extinction, Color(4.5f, 1.5f, 1.5f));
  EXPECT_EQ(medium.scattering, Color(3, 0, 0));
  EXPECT_EQ(medium.emission, Color(1.5f));
  ASSERT_EQ(medium.scatterers.size(), 1u);
  EXPECT_EQ(medium.scatterers[0].scattering, Color(3, 0, 0));
}

}  // namespace
}  // namespace basicrt
