// SPDX-License-Identifier: GPL-3.0-or-later
// Skies against closed forms of the air's scattering, and the sun's disc in them.
#include "light/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "light/environment_sampler.h"
#include "light/solid_angle.h"
#include "math/constants.h"
#include "math/frame.h"
#include "math/warp.h"
#include "support/chi_square.h"

namespace basicrt {
namespace {

using namespace test;

// The mean of the row that is highest.
Color zenith(const Image& image) {
  Color sum(0.0f);
  for (int x = 0; x < image.width; ++x) sum += pixel_color(image, x, image.height - 1);
  return sum / static_cast<float>(image.width);
}

Color irradiance_of(const SunDisc& disc) {
  return disc.high * static_cast<float>(2 * std::numbers::pi * one_minus_cos(disc.radius));
}

template <class SkyKind>
SkyKind without_air() {
  return {.air_density = 0, .aerosol_density = 0, .ozone_density = 0};
}

TEST(Sky, preetham_s_zenith_has_the_paper_s_luminance) {
  const float turbidity = 3, sun_zenith = 0.6f;
  const PreethamSky sky{.sun_elevation = pi / 2 - sun_zenith, .turbidity = turbidity};
  const float chi = (4.0f / 9 - turbidity / 120) * (pi - 2 * sun_zenith);
  const float expected = (4.0453f * turbidity - 4.9710f) * std::tan(chi) - 0.2155f * turbidity + 2.4192f;
  EXPECT_NEAR(luminance(zenith(draw_sky(sky, 2))) / (0.06f * expected), 1, 2e-3f);
}

template <class SkyKind>
class ScatteringSky : public testing::Test {};
using ScatteringSkies = testing::Types<SingleScatteringSky, MultipleScatteringSky>;
TYPED_TEST_SUITE(ScatteringSky, ScatteringSkies);

TYPED_TEST(ScatteringSky, is_black_without_air_and_its_sun_as_bright_at_any_height) {
  TypeParam sky = without_air<TypeParam>();
  for (const float value : draw_sky(sky, 2).pixels) ASSERT_EQ(value, 0);
  const SunDisc low = find_sun(sky).value();
  sky.sun_elevation = 1.2f;
  EXPECT_NEAR(luminance(low.low) / luminance(find_sun(sky).value().high), 1, 1e-4f);
}

TYPED_TEST(ScatteringSky, has_the_same_sun_whatever_its_size) {
  TypeParam sky{.sun_elevation = 1};
  sky.sun_size = 0.001f;
  const Color small = irradiance_of(find_sun(sky).value());
  sky.sun_size = 0.01f;
  EXPECT_NEAR(luminance(irradiance_of(find_sun(sky).value())) / luminance(small), 1, 0.01f);
}

TEST(SingleScatteringSky, thin_dust_scatters_by_its_column_and_its_phase_function) {
  SingleScatteringSky sky = without_air<SingleScatteringSky>();
  sky.sun_elevation = 0.7f;
  const Color sun = irradiance_of(find_sun(sky).value());
  sky.aerosol_density = 1e-3f;
  const Color up = zenith(draw_sky(sky, 2));
  // Cornette and Shanks' phase function, towards the zenith.
  const double g = 0.76, cosine = std::sin(0.7);
  const double phase = 3 / (8 * std::numbers::pi) * (1 - g * g) * (1 + cosine * cosine) /
                       ((2 + g * g) * std::pow(1 + g * g - 2 * g * cosine, 1.5));
  // The column is summed in 32 pieces of 1875 metres, by their middles: x / sinh(x) of the integral, from 100 m up.
  const double height = 1200, x = (60000 - 100) / 32.0 / (2 * height);
  const double column = 1e-3 * 2e-5 * height * std::exp(-100 / height) * x / std::sinh(x);
  EXPECT_NEAR(luminance(up) / (luminance(sun) * phase * column), 1, 5e-3);
}

TEST(MultipleScatteringSky, sends_the_ground_no_more_light_than_the_sun_and_its_reflections) {
  MultipleScatteringSky sky = without_air<MultipleScatteringSky>();
  sky.sun_elevation = 1;
  const float above = luminance(irradiance_of(find_sun(sky).value())) * std::sin(sky.sun_elevation);
  sky.air_density = sky.aerosol_density = sky.ozone_density = 1;
  const float direct = luminance(irradiance_of(find_sun(sky).value())) * std::sin(sky.sun_elevation);
  double diffuse = 0;
  const Image image = draw_sky(sky, 2);
  for (int y = image.height / 2; y < image.height; ++y) {
    const auto latitude = [&](int edge) {
      const double share = 2.0 * edge / image.height - 1;
      return share * share * std::numbers::pi / 2;
    };
    const double below = std::sin(latitude(y)), top = std::sin(latitude(y + 1));
    for (int x = 0; x < image.width; ++x) {
      diffuse +=
          double(luminance(pixel_color(image, x, y))) * std::numbers::pi / image.width * (top * top - below * below);
    }
  }
  EXPECT_GT(direct, 0.5 * above);
  EXPECT_GT(diffuse, 0.03 * above);
  EXPECT_LT(direct + diffuse, above);
}

TEST(SunDisc, its_irradiance_is_the_integral_of_what_it_shows) {
  const SunDisc disc{.elevation = 0.4, .radius = 0.1, .low = {1, 2, 3}, .high = {3, 2, 5}, .horizon = 0};
  Rng rng(1);
  Color sum(0.0f);
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Vec3d direction = sample_sun_disc(disc, next_unit_vec2(rng));
    ASSERT_GT(pdf_sun_disc(disc, direction), 0);
    sum += eval_sun_disc(disc, direction) / static_cast<float>(count * pdf_sun_disc(disc, direction));
  }
  const Color expected = sun_disc_irradiance(disc);
  for (const std::size_t channel : {0, 1, 2}) EXPECT_NEAR(sum[channel] / expected[channel], 1, 0.01f);
}

TEST(SunDisc, is_darker_at_its_limb_and_cut_by_the_horizon) {
  const SunDisc disc{.elevation = 0.05, .radius = 0.1, .low = Color(1.0f), .high = Color(1.0f), .horizon = 0};
  const auto at = [&](double elevation) {
    return eval_sun_disc(disc, {std::cos(elevation), 0, std::sin(elevation)}).x;
  };
  EXPECT_NEAR(at(0.05), 1, 1e-4f);
  EXPECT_NEAR(at(0.05 + 0.06), 1 - 0.6f * (1 - 0.8f), 1e-4f);
  EXPECT_EQ(at(0.151), 0);
  EXPECT_GT(at(0.001), 0);
  EXPECT_EQ(at(-0.001), 0);
}

TEST(SkySampling, every_direction_that_sees_the_sun_has_its_density) {
  Environment environment;
  const MultipleScatteringSky sky{.sun_elevation = 0.35f, .sun_rotation = 2.6f};
  environment.layers = {{.sky = sky}};
  const EnvironmentSampler sampler(environment, 2);
  const double radius = double(sky.sun_size) / 2, elevation = double(sky.sun_elevation);
  const double azimuth = std::numbers::pi / 2 - double(sky.sun_rotation);
  const Vec3d sun{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                  std::sin(elevation)};
  const Vec3d right = normalize(Vec3d{-sun.y, sun.x, 0}), up = cross(sun, right);
  Rng rng(3);
  int seen = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {  // around the limb, as near as single precision tells
    const double turn = 2 * std::numbers::pi * double(next_unit_vec2(rng).x);
    const double angle = radius * (1 + 1e-3 * (double(next_unit_vec2(rng).x) - 0.5));
    const Vec3d offset = right * std::cos(turn) + up * std::sin(turn);
    const Vec3f direction(normalize(sun * std::cos(angle) + offset * std::sin(angle)));
    const bool is_bright = luminance(sampler.eval(direction, false)) > 1e3f;
    seen += is_bright;
    ASSERT_EQ(is_bright, sampler.pdf(direction) > 1e3f) << i;
  }
  EXPECT_NEAR(seen, count / 2, count / 10);
}

TEST(SkySampling, as_many_samples_are_near_the_sun_as_the_density_says) {
  Environment environment;
  const Transform turned({{{1, 0, 0, 0}, {0, 0.8f, -0.6f, 0}, {0, 0.6f, 0.8f, 0}}});
  environment.layers = {{.sky = SingleScatteringSky{.sun_size = 0.3f, .sun_intensity = 0.2f}, .to_image = turned}};
  const EnvironmentSampler sampler(environment, 2);
  // The transform takes this to the sun's place over the y axis.
  const Vec3f sun = inverse(turned).vector(Vec3f{0, std::cos(0.261799f), std::sin(0.261799f)});
  const double cone = one_minus_cos(0.25);
  Rng rng(3);
  int near = 0;
  double mass = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const float choice = next_unit_float(rng);
    const auto light = sampler.sample(choice, next_unit_vec2(rng));
    ASSERT_TRUE(light);
    EXPECT_EQ(light->pdf, sampler.pdf(light->wi));
    near += length_squared(light->wi - sun) / 2 < float(cone);
    const Vec3f within = make_frame(sun).to_world(sample_cone(next_unit_vec2(rng), float(cone)));
    mass += double(sampler.pdf(within)) * 2 * std::numbers::pi * cone / count;
  }
  EXPECT_GT(mass, 0.1);
  EXPECT_LT(mass, 0.9);
  EXPECT_NEAR(double(near) / count, mass, 0.02);
}

TEST(SkySampling, sun_and_sky_are_sampled_with_little_noise) {
  Environment environment;
  environment.layers = {{.sky = SingleScatteringSky{.sun_elevation = 0.6f}}};
  const EnvironmentSampler sampler(environment, 2);
  Rng rng(2);
  double sum = 0, squares = 0;
  constexpr int count = 4000;
  for (int i = 0; i < count; ++i) {
    const float choice = next_unit_float(rng);
    const auto light = sampler.sample(choice, next_unit_vec2(rng));
    const double value = light ? double(luminance(light->radiance) / light->pdf) : 0;
    sum += value, squares += value * value;
  }
  const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
  EXPECT_LT(deviation, 0.3 * mean);
}

TEST(SkySampling, a_sun_that_only_the_camera_sees_is_not_sampled) {
  Environment environment;
  environment.layers = {{.sky = SingleScatteringSky{}, .seen_by = EnvironmentRays::camera}};
  const EnvironmentSampler sampler(environment, 2);
  EXPECT_TRUE(sampler.is_empty());
  // From y towards x, as Blender's rotation goes.
  const Vec3f sun{0, std::cos(0.261799f), std::sin(0.261799f)};
  EXPECT_GT(luminance(sampler.eval(sun, true)), 1000);
  EXPECT_EQ(luminance(sampler.eval(sun, false)), 0);
}

}  // namespace
}  // namespace basicrt
