// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures around the scene: where directions find their place in them, and sampling by their brightness.
#include "light/environment_sampler.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "math/constants.h"
#include "support/chi_square.h"

namespace basicrt {
namespace {

using namespace test;

// Dark, with a few bright pixels.
Image random_picture(int width, int height, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<float> pixels;
  for (int i = 0; i < width * height * 3; ++i) {
    const float value = next_unit_float(rng);
    pixels.push_back(i % 37 == 0 ? 50 * value : value);
  }
  return {.width = width, .height = height, .channels = 3, .pixels = std::move(pixels), .path = ""};
}

// The colour of pixel (x, y) is (x, y, 0).
Image numbered_picture(int width, int height) {
  std::vector<float> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) pixels.insert(pixels.end(), {float(x), float(y), 0});
  return {.width = width, .height = height, .channels = 3, .pixels = std::move(pixels), .path = ""};
}

// A turn about z, then one about x.
Transform turned() {
  const float a = 0.7f, b = 1.1f;
  const Transform z({{{std::cos(a), -std::sin(a), 0, 0}, {std::sin(a), std::cos(a), 0, 0}, {0, 0, 1, 0}}});
  const Transform x({{{1, 0, 0, 0}, {0, std::cos(b), -std::sin(b), 0}, {0, std::sin(b), std::cos(b), 0}}});
  return x * z;
}

Environment one_layer(EnvironmentLayer layer) {
  Environment environment;
  environment.layers.push_back(std::move(layer));
  return environment;
}

TEST(Environment, equirectangular_has_x_in_the_middle_and_minus_y_to_the_right) {
  const auto place = [](Vec3f direction) {
    return project_direction(EnvironmentProjection::equirectangular, direction);
  };
  EXPECT_FLOAT_EQ(place({2, 0, 0}).x, 0.5f);
  EXPECT_FLOAT_EQ(place({2, 0, 0}).y, 0.5f);
  EXPECT_FLOAT_EQ(place({0, 1, 0}).x, 0.25f);
  EXPECT_FLOAT_EQ(place({0, -1, 0}).x, 0.75f);
  EXPECT_FLOAT_EQ(place({0, 0, 1}).y, 1);
  EXPECT_FLOAT_EQ(place({0, 0, -1}).y, 0);
  EXPECT_FLOAT_EQ(place({1, 0, 1}).y, 0.75f);
}

TEST(Environment, a_mirror_ball_shows_what_a_camera_along_y_sees_in_it) {
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    // From the place on the ball to the mirrored direction, and back.
    const Vec2f u = next_unit_vec2(rng);
    const float x = 2 * u.x - 1, z = 2 * u.y - 1;
    if (x * x + z * z > 0.98f) continue;
    const Vec3f normal{x, -std::sqrt(1 - x * x - z * z), z}, to_camera{0, -1, 0};
    const Vec3f mirrored = normal * (2 * dot(normal, to_camera)) - to_camera;
    const Vec2f place = project_direction(EnvironmentProjection::mirror_ball, mirrored);
    EXPECT_NEAR(place.x, u.x, 1e-4f);
    EXPECT_NEAR(place.y, u.y, 1e-4f);
  }
}

TEST(Environment, layers_add_up_for_the_rays_that_see_them) {
  Environment environment;
  environment.radiance = Color(1.0f);
  environment.layers = {{.radiance = Color(2.0f)},
                        {.radiance = Color(4.0f), .seen_by = EnvironmentRays::camera},
                        {.radiance = Color(8.0f), .seen_by = EnvironmentRays::scattered}};
  EXPECT_EQ(eval_environment(environment, {0, 0, 1}, true), Color(7.0f));
  EXPECT_EQ(eval_environment(environment, {0, 0, 1}, false), Color(11.0f));
}

TEST(Environment, a_transform_turns_directions_before_the_lookup) {
  EnvironmentLayer layer{.image = numbered_picture(8, 4), .interpolation = ImageInterpolation::closest};
  layer.to_image = turned();
  EnvironmentLayer straight = layer;
  straight.to_image = {};
  Rng rng(5);
  for (int i = 0; i < 100; ++i) {
    const Vec3f direction =
        EquirectTable(1, 1, [](int, std::span<float> w) { w[0] = 1; }, 1).sample(next_unit_vec2(rng)).direction;
    EXPECT_EQ(eval_layer(layer, direction), eval_layer(straight, turned().vector(direction)));
  }
}

void expect_samples_to_follow_the_density(const std::string& name, const Environment& environment) {
  SCOPED_TRACE(name);
  const EnvironmentSampler sampler(environment, 2);
  const auto sample = [&](Rng& rng) -> std::optional<Vec3f> {
    const float choice = next_unit_float(rng);
    const auto light = sampler.sample(choice, next_unit_vec2(rng));
    if (!light) return std::nullopt;
    EXPECT_EQ(light->pdf, sampler.pdf(light->wi));
    return light->wi;
  };
  const ChiSquareResult result =
      chi_square_sphere(sample, [&](Vec3f wi) { return double(sampler.pdf(wi)); }, {.samples = 100000});
  EXPECT_GT(result.p_value, sidak_threshold(8)) << result.describe();
  EXPECT_NEAR(result.mass, 1, 0.01) << result.describe();
}

TEST(EnvironmentSampler, samples_follow_the_density) {
  const Image picture = random_picture(16, 8, 1);
  expect_samples_to_follow_the_density("plain", one_layer({.image = picture}));
  expect_samples_to_follow_the_density("closest",
                                       one_layer({.image = picture, .interpolation = ImageInterpolation::closest}));
  expect_samples_to_follow_the_density(
      "cubic", one_layer({.image = picture, .interpolation = ImageInterpolation::cubic, .to_image = turned()}));
  expect_samples_to_follow_the_density("turned", one_layer({.image = picture, .to_image = turned()}));
  const Transform stretched = turned() * Transform({{{2, 0, 0, 0}, {0, 1, 0, 0}, {0, 0.5f, -0.5f, 0}}});
  expect_samples_to_follow_the_density("stretched", one_layer({.image = picture, .to_image = stretched}));
  Environment two = one_layer({.radiance = {1, 0, 2}, .image = picture, .to_image = turned()});
  two.layers.push_back({.image = random_picture(3, 5, 2)});
  expect_samples_to_follow_the_density("two", two);
}

TEST(EnvironmentSampler, any_other_lookup_is_sampled_too) {
  Transform shifted = turned();
  shifted.rows[2][3] = 0.4f;
  const std::pair<const char*, EnvironmentLayer> layers[] = {
      {"mirror ball",
       {.image = random_picture(16, 16, 3), .projection = EnvironmentProjection::mirror_ball, .to_image = turned()}},
      {"shifted", {.image = random_picture(16, 8, 4), .to_image = shifted}}};
  Rng rng(6);
  for (const auto& [name, layer] : layers) {
    SCOPED_TRACE(name);
    const EnvironmentSampler sampler(one_layer(layer), 2);
    // The same integral by the sampler as by uniform directions.
    double sampled = 0, uniform = 0;
    const EquirectTable sphere(1, 1, [](int, std::span<float> w) { w[0] = 1; }, 1);
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
      if (const auto light = sampler.sample(next_unit_float(rng), next_unit_vec2(rng)))
        sampled += luminance(light->radiance) / light->pdf / n;
      uniform += luminance(eval_layer(layer, sphere.sample(next_unit_vec2(rng)).direction)) * 4 * pi / n;
    }
    EXPECT_NEAR(sampled / uniform, 1, 0.02);
  }
}

TEST(EnvironmentSampler, the_closest_pixel_s_picture_is_sampled_without_noise) {
  // Radiance over density is the same for every sample, but for the rounding of stored weights.
  std::vector<float> greys;
  Rng rng(7);
  for (int i = 0; i < 64 * 32; ++i) greys.push_back(next_unit_float(rng));
  const Image picture{.width = 64, .height = 32, .channels = 1, .pixels = greys, .path = ""};
  double integral = 0;
  const auto edge = [](int row) { return std::sin((row - 16) * std::numbers::pi / 32); };
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      integral += greys[std::size_t(y * 64 + x)] * (2 * std::numbers::pi / 64) * (edge(y + 1) - edge(y));
  const EnvironmentSampler sampler(one_layer({.image = picture, .interpolation = ImageInterpolation::closest}));
  for (int i = 0; i < 10000; ++i) {
    const auto sample = sampler.sample(next_unit_float(rng), next_unit_vec2(rng));
    if (!sample) continue;
    EXPECT_NEAR(sample->radiance.x / sample->pdf / integral, 1, 0.006);
  }
}

TEST(EnvironmentSampler, large_rows_are_sampled_block_by_block) {
  // One bright pixel in each of a few rows of many pixels.
  std::vector<float> greys(5000 * 6, 0.001f);
  greys[5000 * 1 + 4999] = greys[5000 * 3 + 31] = greys[5000 * 3 + 32] = greys[5000 * 4] = 1000;
  const Image picture{.width = 5000, .height = 6, .channels = 1, .pixels = std::move(greys), .path = ""};
  const EnvironmentSampler sampler(one_layer({.image = picture, .interpolation = ImageInterpolation::closest}));
  Rng rng(8);
  int bright = 0;
  for (int i = 0; i < 1000; ++i)
    if (const auto sample = sampler.sample(next_unit_float(rng), next_unit_vec2(rng))) bright += sample->radiance.x > 1;
  EXPECT_GT(bright, 950);
}

TEST(EnvironmentSampler, what_scattered_rays_do_not_see_and_plain_colours_are_not_sampled) {
  const Image picture = random_picture(4, 2, 9),
              black{.width = 2, .height = 1, .channels = 1, .pixels = {0, 0}, .path = ""};
  Environment environment;
  environment.radiance = Color(1.0f);
  environment.layers = {{.radiance = Color(1.0f)},
                        {.image = picture, .seen_by = EnvironmentRays::camera},
                        {.radiance = Color(0.0f), .image = picture},
                        {.image = black}};
  const EnvironmentSampler sampler(environment);
  EXPECT_TRUE(sampler.is_empty());
  EXPECT_EQ(sampler.pdf({0, 0, 1}), 0);
}

TEST(EnvironmentSampler, is_the_same_for_any_number_of_threads) {
  const Environment environment = one_layer({.image = random_picture(100, 77, 10)});
  const EnvironmentSampler one(environment, 1), three(environment, 3);
  Rng rng(11);
  for (int i = 0; i < 1000; ++i) {
    const float choice = next_unit_float(rng);
    const Vec2f u = next_unit_vec2(rng);
    const auto a = one.sample(choice, u), b = three.sample(choice, u);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (a) {
      EXPECT_EQ(a->wi, b->wi);
      EXPECT_EQ(a->pdf, b->pdf);
    }
  }
}

}  // namespace
}  // namespace basicrt
