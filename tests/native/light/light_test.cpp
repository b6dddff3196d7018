// SPDX-License-Identifier: GPL-3.0-or-later
// What every lamp must keep: densities that samples follow, and one radiance whichever way it is found.
#include "light/lamp.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "light/lamp_checks.h"

namespace basicrt {
namespace {

using namespace test;

struct NamedLamp {
  std::string name;
  Light light;
};

Transform tilted(Vec3f scale, Vec3f position, std::uint64_t seed) {
  Rng rng(seed);
  return translation(position) * random_rotation(rng) * scaling(scale);
}

// Shines along -z from 2 metres over the origin.
Transform above(Vec3f scale = Vec3f(1)) { return translation({0, 0, 2}) * scaling(scale); }

// Sheared: the edges are not perpendicular.
Transform sheared() {
  return translation({0.3f, 0.2f, 1.5f}) * Transform({{{1, 0.6f, 0.2f, 0}, {0, 0.8f, 0.1f, 0}, {0.1f, 0.2f, 1, 0}}});
}

std::vector<NamedLamp> lamps_with_size() {
  return {
      {"sphere", PointLight{.position = {0, 0, 2}, .radius = 0.5f}},
      {"small sphere", PointLight{.position = {0, 0, 2}, .radius = 5e-3f}},
      {"soft point", PointLight{.position = {0, 0, 2}, .radius = 0.5f, .is_soft = true}},
      {"huge soft point", PointLight{.position = {0, 0, 2}, .radius = 50, .is_soft = true}},
      {"sphere around everything", PointLight{.position = {0, 0, 2}, .radius = 5}},
      {"spot", SpotLight{.to_world = above(), .radius = 0.4f}},
      {"soft spot", SpotLight{.to_world = above(), .radius = 0.4f, .is_soft = true, .blend = 1}},
      {"stretched spot",
       SpotLight{.to_world = tilted({1, 0.5f, 2}, {0, 0, 1}, 3), .radius = 0.3f, .angle = 2.5f, .blend = 0.5f}},
      {"sun", SunLight{.direction = {0.2f, 0, -2}, .angle = 0.3f}},
      {"sky-wide sun", SunLight{.direction = {0, 0, -1}, .angle = 3.141593f}},
      {"Blender's sun", SunLight{.direction = {0.5f, 0.5f, -1}, .angle = 0.00918f}},
      {"square", AreaLight{.to_world = above()}},
      {"near square", AreaLight{.to_world = translation({0.1f, -0.2f, 0.05f})}},
      {"strip", AreaLight{.to_world = above({5, 0.02f, 1})}},
      {"small square", AreaLight{.to_world = above(Vec3f(1.5e-3f))}},
      {"sheared", AreaLight{.to_world = sheared()}},
      {"ellipse", AreaLight{.to_world = above({2, 0.7f, 1}), .is_ellipse = true}},
      {"sheared ellipse", AreaLight{.to_world = sheared(), .is_ellipse = true}},
      {"square with spread", AreaLight{.to_world = above(), .spread = 0.6f}},
      {"ellipse with spread", AreaLight{.to_world = above(), .is_ellipse = true, .spread = 1.5f}},
      {"mirrored square", AreaLight{.to_world = above({-1, 1, 1})}},
  };
}

std::vector<NamedLamp> deltas() {
  return {{"point", PointLight{.position = {0, 0, 2}}},
          {"spot", SpotLight{.to_world = above(), .angle = 1.5f}},
          {"sun", SunLight{}}};
}

constexpr std::array positions = {Vec3f{0, 0, 0}, Vec3f{0.7f, -0.4f, 0.1f}, Vec3f{-1, 2, 1.2f}};

TEST(Lights, samples_follow_their_density) {
  const double threshold = sidak_threshold(int(lamps_with_size().size() * positions.size()));
  for (const NamedLamp& lamp : lamps_with_size())
    for (const Vec3f position : positions) {
      const auto sample = [&](Rng& rng) -> std::optional<Vec3f> {
        const auto s = sample_light(lamp.light, position, next_unit_vec2(rng));
        if (!s) return std::nullopt;
        return s->wi;
      };
      const auto pdf = [&](Vec3f wi) { return double(light_pdf(lamp.light, position, wi)); };
      const ChiSquareResult result = chi_square_sphere(sample, pdf, {.samples = 50000, .pilot_samples = 20000});
      EXPECT_GT(result.p_value, threshold) << lamp.name << ": " << result.describe();
    }
}

TEST(Lights, a_ray_sees_what_a_sample_promised) {
  Rng rng(5);
  for (const NamedLamp& lamp : lamps_with_size())
    for (const Vec3f position : positions) {
      int samples = 0, hits = 0;
      for (int i = 0; i < 1000; ++i) {
        const auto sample = sample_light(lamp.light, position, next_unit_vec2(rng));
        if (!sample) continue;
        ++samples;
        EXPECT_NEAR(length(sample->wi), 1, 1e-6);
        // A direction of another length: t counts in its units.
        const auto hit = intersect_light(lamp.light, {.origin = position, .direction = sample->wi * 0.25f});
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->pdf / sample->pdf, 1, 1e-3) << lamp.name;
        // Where a lamp fades to nothing, the direction's rounding shows in what is left of its radiance.
        EXPECT_NEAR(hit->radiance.x / sample->radiance.x, 1, 1e-3 + 1e-5 / sample->radiance.x) << lamp.name;
        if (sample->distance < infinity) {
          // Towards the rim of a ball, distance changes without bound with the direction.
          EXPECT_NEAR(hit->t / 4 / sample->distance, 1, 2e-3) << lamp.name;
        } else {
          EXPECT_EQ(hit->t, infinity);
        }
      }
      // Rounding may push a sample over the edge, which is a share of the smallest lamps.
      EXPECT_GE(hits, samples * 0.99) << lamp.name << ", seed 5";
    }
}

TEST(Lights, rays_see_lamps_only_within_their_interval) {
  for (const NamedLamp& lamp : lamps_with_size()) {
    const auto sample = sample_light(lamp.light, {0, 0, 0}, {0.4f, 0.45f});
    if (!sample) continue;
    Ray ray{.origin = {0, 0, 0}, .direction = sample->wi};
    if (!intersect_light(lamp.light, ray)) continue;
    ray.t_max = sample->distance == infinity ? 1e30f : sample->distance * 0.99f;
    EXPECT_FALSE(intersect_light(lamp.light, ray)) << lamp.name;
    ray.t_max = infinity;
    ray.t_min = sample->distance * 1.01f;
    if (sample->distance < infinity) {
      EXPECT_FALSE(intersect_light(lamp.light, ray)) << lamp.name;
    }
  }
}

TEST(Lights, hidden_from_the_camera_are_met_by_other_rays_and_light_alike) {
  Rng rng(13);
  for (const NamedLamp& lamp : lamps_with_size()) {
    Light hidden = lamp.light;
    std::visit([](auto& light) { light.is_camera_visible = false; }, hidden);
    int samples = 0, hits = 0;
    for (int i = 0; i < 300; ++i) {
      const Vec3f position = positions[i % positions.size()];
      const auto sample = sample_light(lamp.light, position, next_unit_vec2(rng));
      if (!sample) continue;
      ++samples;
      Ray ray{.origin = position, .direction = sample->wi, .kinds = ray_camera};
      const bool was_met = intersect_light(lamp.light, ray).has_value();
      hits += was_met;
      EXPECT_FALSE(intersect_light(hidden, ray)) << lamp.name;
      EXPECT_EQ(light_pdf(hidden, ray.origin, ray.direction), light_pdf(lamp.light, ray.origin, ray.direction));
      ray.kinds = ray_glossy;
      EXPECT_EQ(intersect_light(hidden, ray).has_value(), was_met) << lamp.name;
    }
    // One of them shines past all three positions.
    EXPECT_EQ(hits > 0, samples > 0) << lamp.name << ", seed 13";
  }
}

TEST(Lights, deltas_have_a_density_of_one_and_are_never_hit) {
  for (const NamedLamp& lamp : deltas()) {
    EXPECT_TRUE(is_delta(lamp.light));
    const auto sample = sample_light(lamp.light, {0.1f, 0.2f, 0}, {0.5f, 0.5f});
    ASSERT_TRUE(sample) << lamp.name;
    EXPECT_TRUE(sample->is_delta);
    EXPECT_EQ(sample->pdf, 1);
    EXPECT_FALSE(intersect_light(lamp.light, {.origin = {0.1f, 0.2f, 0}, .direction = sample->wi})) << lamp.name;
    EXPECT_EQ(light_pdf(lamp.light, {0.1f, 0.2f, 0}, sample->wi), 0);
  }
}

TEST(Lights, are_finite_and_not_negative_from_anywhere) {
  Rng rng(9);
  std::vector<NamedLamp> lamps = lamps_with_size();
  for (const NamedLamp& lamp : deltas()) lamps.push_back(lamp);
  lamps.push_back({"nanometre sphere", PointLight{.position = {0, 0, 2}, .radius = 2e-9f}});
  lamps.push_back({"nanometre square", AreaLight{.to_world = above(Vec3f(1e-9f))}});
  lamps.push_back({"square to the horizon", AreaLight{.to_world = above(Vec3f(1e9f))}});
  lamps.push_back({"black", PointLight{.position = {0, 0, 2}, .intensity = Color(0.0f)}});
  // Far, near, grazing, inside, and exactly on or in the lamps' planes, centres and surfaces.
  std::vector<Vec3f> places = {{0, 0, 2},       {0, 0, 1.5f},   {0, 0, 2.5f},         {0.5f, 0.5f, 2},    {3, 0, 2},
                               {0, 0, 1e18f},   {0, 0, -1e18f}, {1e6f, 0, 1.99999f},  {0, 0, 1.9999999f}, {0.5f, 0, 2},
                               {0, 0, 2.0001f}, {1e-20f, 0, 2}, {0.1f, -0.2f, 0.05f}, {0, 0, -3}};
  for (int i = 0; i < 50; ++i)
    places.push_back(random_direction(rng) * std::pow(10.0f, next_unit_float(rng) * 16 - 8) + Vec3f{0, 0, 2});
  const std::vector<Vec2f> corners = {
      {0, 0}, {0, one_minus_epsilon}, {one_minus_epsilon, 0}, {one_minus_epsilon, one_minus_epsilon}, {0.5f, 0.5f}};
  for (const NamedLamp& lamp : lamps)
    for (const Vec3f place : places)
      for (int i = 0; i < 40; ++i) {
        const Vec2f u = i < 5 ? corners[i] : next_unit_vec2(rng);
        if (const auto sample = sample_light(lamp.light, place, u)) {
          EXPECT_TRUE(sample->pdf > 0 && sample->pdf < infinity) << lamp.name;
          EXPECT_TRUE(is_finite(sample->radiance) && min_component(sample->radiance) >= 0) << lamp.name;
          EXPECT_NEAR(length(sample->wi), 1, 1e-5) << lamp.name;
          EXPECT_GE(sample->distance, 0) << lamp.name;
          EXPECT_GE(light_pdf(lamp.light, place, sample->wi), 0) << lamp.name;
        }
        const Vec3f direction = i < 5 ? Vec3f{0, 0, i % 2 ? 1.0f : -1.0f} : random_direction(rng);
        if (const auto hit = intersect_light(lamp.light, {.origin = place, .direction = direction})) {
          EXPECT_TRUE(hit->pdf > 0 && hit->pdf < infinity) << lamp.name;
          EXPECT_TRUE(is_finite(hit->radiance) && min_component(hit->radiance) >= 0) << lamp.name;
          EXPECT_GE(hit->t, 0) << lamp.name;
        }
      }
}

TEST(Lights, emission_samples_carry_their_densities) {
  Rng rng(13);
  std::vector<NamedLamp> lamps = lamps_with_size();
  for (const NamedLamp& lamp : deltas()) lamps.push_back(lamp);
  for (const NamedLamp& lamp : lamps) {
    int misses = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u_position = next_unit_vec2(rng), u_direction = next_unit_vec2(rng);
      const auto sample = sample_emission(lamp.light, u_position, u_direction, {0, 0, 0}, 3);
      if (!sample) continue;
      EXPECT_NEAR(length(sample->ray.direction), 1, 1e-6) << lamp.name;
      const EmissionPdf pdf = emission_pdf(lamp.light, sample->ray.origin, sample->ray.direction, 3);
      if (pdf.direction == 0) {
        ++misses;  // a direction at the very edge of its cone
      } else {
        EXPECT_NEAR(pdf.direction / sample->pdf_direction, 1, 1e-3 + 1e-5 / sample->pdf_direction) << lamp.name;
      }
      // A place on a small sphere far from the origin is rounded to a few steps of its radius.
      if (lamp.name == "small sphere") continue;
      EXPECT_NEAR(pdf.position, sample->pdf_position, 1e-3 * sample->pdf_position + 1e-4) << lamp.name;
    }
    EXPECT_LT(misses, 10) << lamp.name << ", seed 13";
  }
}

TEST(Lights, emission_directions_follow_their_density) {
  const double threshold = sidak_threshold(int(lamps_with_size().size()));
  for (const NamedLamp& lamp : lamps_with_size()) {
    const auto* point = std::get_if<PointLight>(&lamp.light);
    const auto sample = [&](Rng& rng) -> std::optional<Vec3f> {
      const Vec2f u_position = next_unit_vec2(rng), u_direction = next_unit_vec2(rng);
      const auto s = sample_emission(lamp.light, u_position, u_direction, {0, 0, 0}, 3);
      if (!s) return std::nullopt;
      return s->ray.direction;
    };
    const auto pdf = [&](Vec3f direction) {
      const Vec3f place = point ? point->position + direction * point->radius : Vec3f{0, 0, 0};
      return double(emission_pdf(lamp.light, place, direction, 3).direction);
    };
    const ChiSquareResult result = chi_square_sphere(sample, pdf, {.samples = 50000, .pilot_samples = 20000});
    EXPECT_GT(result.p_value, threshold) << lamp.name << ": " << result.describe();
  }
}

}  // namespace
}  // namespace basicrt
