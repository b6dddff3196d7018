// SPDX-License-Identifier: GPL-3.0-or-later
// Every lobe: sampling against density and value, reciprocity, energy, and the ends of every range.
#include "bsdf/lobes.h"

#include <gtest/gtest.h>

#include <string>

#include "bsdf/fixtures.h"

namespace basicrt {
namespace {

using test::direction_at;
using test::NamedMaterial;
using test::Rng;

// Front and back, steep and grazing.
const std::vector<float> angles = {0, 30, 75, 110, 160};

std::string at(const NamedMaterial& named, float degrees) { return named.name + " from " + std::to_string(degrees); }

// One test for each angle, which can run side by side.
class LobeDensity : public testing::TestWithParam<float> {};

TEST_P(LobeDensity, samples_have_the_density_that_eval_gives) {
  const auto materials = test::all_materials();
  const double threshold = test::sidak_threshold(static_cast<int>(materials.size() * angles.size()));
  const Frame frame = make_frame(normalize(Vec3f{0.3f, -0.5f, 0.4f}));
  const float degrees = GetParam();
  const Vec3f wo = frame.to_world(direction_at(degrees));
  for (const NamedMaterial& named : materials) {
    const Bsdf bsdf = test::make_bsdf(named.material, test::make_point(frame.normal), wo);
    if (bsdf.has_only_deltas()) continue;
    const auto result = test::chi_square_sphere(
        [&](Rng& rng) -> std::optional<Vec3f> {
          const float choice = test::next_unit_float(rng);
          const auto sample = bsdf.sample(wo, choice, test::next_unit_vec2(rng));
          return sample && !sample->is_delta ? std::optional(sample->wi) : std::nullopt;
        },
        [&](Vec3f wi) { return bsdf.eval(wo, wi).pdf; }, {.samples = 100000, .pilot_samples = 20000});
    EXPECT_GT(result.p_value, threshold) << at(named, degrees) << ": " << result.describe();
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, LobeDensity, testing::ValuesIn(angles));

TEST(Lobes, sample_weights_are_value_over_density) {
  Rng rng(2);
  for (const NamedMaterial& named : test::all_materials())
    for (const float degrees : angles) {
      const Vec3f wo = direction_at(degrees);
      const Bsdf bsdf = test::make_bsdf(named.material, test::make_point(), wo);
      for (int i = 0; i < 2000; ++i) {
        const float choice = test::next_unit_float(rng);
        const auto sample = bsdf.sample(wo, choice, test::next_unit_vec2(rng));
        if (!sample || sample->is_delta) continue;
        EXPECT_NEAR(length(sample->wi), 1, 1e-5);
        if (std::abs(sample->wi.z) < 1e-3f) continue;  // the half vector has lost its digits
        const BsdfValue value = bsdf.eval(wo, sample->wi);
        // The normal was known to sample() and is found again by eval(), with rounding that narrow lobes magnify.
        EXPECT_NEAR(value.pdf, sample->pdf, 4e-3f * sample->pdf) << at(named, degrees) << ", seed 2";
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_NEAR(value.value[c], sample->weight[c] * sample->pdf, 4e-3f * sample->weight[c] * sample->pdf + 1e-6f)
              << at(named, degrees) << ", seed 2";
      }
    }
}

// Without the compensation of multiple scattering, which is made for one direction.
template <class MakeLobe>
void expect_reciprocity(MakeLobe make_lobe, const std::string& name) {
  Rng rng(3);
  for (int i = 0; i < 500; ++i) {
    Vec3f a = sample_hemisphere(test::next_unit_vec2(rng)), b = sample_hemisphere(test::next_unit_vec2(rng));
    a.z = std::max(a.z, 0.02f);
    b.z = std::max(b.z, 0.02f);
    a = normalize(a);
    b = normalize(b);
    const Color there = make_lobe().eval(a, b).value * (1 / b.z), back = make_lobe().eval(b, a).value * (1 / a.z);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 2e-4f * there[c] + 1e-20f) << name << ", seed 3";
  }
}

TEST(Lobes, reflection_is_reciprocal) {
  expect_reciprocity([] { return Lambert{}; }, "Lambert");
  for (const MicrofacetModel model : {MicrofacetModel::ggx, MicrofacetModel::beckmann}) {
    const Microfacets microfacets{0.2f, 0.5f, model};
    expect_reciprocity([&] { return MicrofacetReflection<NoFresnel>{microfacets, {}}; }, "microfacets");
    expect_reciprocity([&] { return MicrofacetReflection<SchlickFresnel>{microfacets, {Color(0.3f)}}; }, "Schlick");
    expect_reciprocity([&] { return MicrofacetReflection<InterfaceFresnel>{microfacets, {1.5f}}; }, "interface");
    expect_reciprocity([&] { return MicrofacetReflection<ConductorFresnel>{microfacets, {Color(0.2f), Color(3.9f)}}; },
                       "conductor");
  }
  expect_reciprocity([] { return Dielectric{.eta = 1.5f, .alpha = 0.3f}; }, "dielectric");
}

TEST(Lobes, stretched_tinted_and_wide_reflection_is_reciprocal) {
  const Microfacets turned{0.2f, 0.5f, MicrofacetModel::ggx, Turn({0.3f, 0.8f, 0}, 1)};
  expect_reciprocity([&] { return MicrofacetReflection<NoFresnel>{turned, {}}; }, "turned microfacets");
  expect_reciprocity([&] { return MicrofacetReflection<F82Fresnel>{turned, make_f82(Color(0.6f), Color(0.3f))}; },
                     "F82");
  expect_reciprocity([&] { return MicrofacetReflection<TintedInterfaceFresnel>{turned, {1.5f, Color(0.1f)}}; },
                     "tinted interface");
  expect_reciprocity([] { return AshikhminShirley{0.3f, 0.6f, Turn({1, 2, 0}, 0)}; }, "Ashikhmin and Shirley");
  expect_reciprocity([] { return make_velvet(0.4f); }, "Ashikhmin's sheen");
  // Oren and Nayar's is made for one viewer, and so are both ways here.
  Rng rng(7);
  for (int i = 0; i < 200; ++i) {
    const Vec3f a = sample_cosine_hemisphere(test::next_unit_vec2(rng)),
                b = sample_cosine_hemisphere(test::next_unit_vec2(rng));
    const Color there = OrenNayar(Color(0.7f), 0.8f, a.z).eval(a, b).value / b.z,
                back = OrenNayar(Color(0.7f), 0.8f, b.z).eval(b, a).value / a.z;
    EXPECT_NEAR(there.x, back.x, 1e-4f) << "seed 7";
  }
}

// f(a, b) eta_b^2 = f(b, a) eta_a^2 of radiance scaled by eta^2; ours leaves that factor out on both ways.
TEST(Lobes, refraction_is_reciprocal_but_for_the_square_of_the_index) {
  Rng rng(4);
  const float eta = 1.5f;
  const Dielectric from_a{.eta = eta, .alpha = 0.5f}, from_b{.eta = 1 / eta, .alpha = 0.5f};
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f a = sample_cosine_hemisphere(test::next_unit_vec2(rng)),
                b = -sample_cosine_hemisphere(test::next_unit_vec2(rng));
    if (a.z < 0.05f || b.z > -0.05f) continue;
    const float there = from_a.eval(a, b).value.x / -b.z;
    const float back = from_b.eval(-b, -a).value.x / a.z;
    EXPECT_NEAR(there, back * eta * eta, 1e-3f * there + 1e-6f) << "seed 4";
    compared += there > 0;
  }
  EXPECT_GT(compared, 500);
}

TEST(Lobes, lambert_reflects_exactly_its_albedo) {
  const Color albedo{0.7f, 0.5f, 0.1f};
  const Vec3f wo = direction_at(50);
  const Bsdf bsdf = test::make_bsdf(test::make_material(DiffuseShader{albedo}), test::make_point(), wo);
  Rng rng(5);
  for (int i = 0; i < 100; ++i) {
    const auto sample = bsdf.sample(wo, 0.5f, test::next_unit_vec2(rng));
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->weight, albedo);
    EXPECT_NEAR(bsdf.eval(wo, sample->wi).value.x, albedo.x * inv_pi * sample->wi.z, 1e-7);
  }
}

TEST(Lobes, never_return_more_light_than_they_get) {
  for (const NamedMaterial& named : test::all_materials())
    for (const float degrees : {0.0f, 45.0f, 80.0f, 120.0f}) {
      const Vec3f wo = direction_at(degrees);
      const Vec3d albedo = test::directional_albedo(test::make_bsdf(named.material, test::make_point(), wo), wo, 50000);
      EXPECT_LT(max_component(albedo), 1.006) << at(named, degrees);
    }
}

TEST(Lobes, smooth_glass_and_mirrors_lose_nothing) {
  for (const ShaderNode& node :
       {ShaderNode(GlossyShader{Color(1.0f), 0}), ShaderNode(RefractionShader{Color(1.0f), 1.5f, 0}),
        ShaderNode(GlassShader{Color(1.0f), Color(1.0f), 1.5f, 0}), ShaderNode(TransparentShader{})})
    for (const float degrees : angles) {
      const Vec3f wo = direction_at(degrees);
      const Bsdf bsdf = test::make_bsdf(test::make_material(node), test::make_point(), wo);
      EXPECT_TRUE(bsdf.has_only_deltas());
      for (const float choice : {0.0f, 0.03f, 0.5f, one_minus_epsilon}) {
        const auto sample = bsdf.sample(wo, choice, {0.3f, 0.6f});
        ASSERT_TRUE(sample);
        EXPECT_TRUE(sample->is_delta);
        EXPECT_NEAR(sample->weight.x, 1, 1e-6);
      }
    }
}

TEST(Lobes, survive_grazing_directions) {
  Rng rng(6);
  for (const NamedMaterial& named : test::all_materials())
    for (const float height : {1e-2f, 1e-5f, 1e-10f, 1e-20f, 0.0f})
      for (const float sign : {1.0f, -1.0f}) {
        const Vec3f wo = normalize(Vec3f{0.8f, -0.6f, sign * height});
        const Bsdf bsdf = test::make_bsdf(named.material, test::make_point(), wo);
        EXPECT_TRUE(is_finite(bsdf.albedo_estimate())) << named.name << ", height " << height;
        for (int i = 0; i < 100; ++i) {
          const float choice = test::next_unit_float(rng);
          const auto sample = bsdf.sample(wo, choice, test::next_unit_vec2(rng));
          if (sample) {
            EXPECT_TRUE(is_finite(sample->wi) && is_finite(sample->weight) && std::isfinite(sample->pdf))
                << named.name << ", height " << height << ", seed 6";
            EXPECT_GE(min_component(sample->weight), 0);
          }
          Vec3f wi = sample_sphere(test::next_unit_vec2(rng));
          if (i % 2) wi = normalize(Vec3f{wi.x, wi.y, wi.z * height});
          const BsdfValue value = bsdf.eval(wo, wi);
          EXPECT_TRUE(is_finite(value.value) && std::isfinite(value.pdf)) << named.name << ", height " << height;
          EXPECT_GE(min_component(value.value), 0);
        }
      }
}

}  // namespace
}  // namespace basicrt
