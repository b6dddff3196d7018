// SPDX-License-Identifier: GPL-3.0-or-later
// The choice among many lights: what it must never do, and what it is for.
#include "light/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "light/lamp_checks.h"
#include "light/light_picker.h"

namespace basicrt {
namespace {

using namespace test;

// Triangles and balls of all sizes, turned every way; some shine within a narrow cone.
std::vector<LightBounds> random_lights(int count, Rng& rng) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < count; ++i) {
    const Vec3f place = random_direction(rng) * (10 * next_unit_float(rng));
    const float size = std::pow(10.0f, 3 * next_unit_float(rng) - 3);
    LightBounds light;
    for (int corner = 0; corner < 3; ++corner) light.box.extend(place + random_direction(rng) * size);
    light.axis = random_direction(rng);
    light.cos_normals = i % 3 == 0 ? -1.0f : i % 3 == 1 ? 1.0f : 0.7f;
    light.cos_emission = i % 4 == 0 ? 0.9f : 0;
    light.is_two_sided = i % 3 == 1 && i % 2 == 0;
    if (i % 6 == 1) {  // flat
      light.axis = {0, 0, i % 12 == 1 ? 1.0f : -1.0f};
      light.box = {place, place + Vec3f(size, 3 * size, 0)};
      light.lowest = height_along(light.axis, Vec3d(place));
    }
    light.is_solid = i % 5 == 0;
    light.intensity = std::pow(10.0f, 4 * next_unit_float(rng) - 2);
    lights.push_back(light);
  }
  return lights;
}

LitPoint random_point(int i, Rng& rng) {
  const Vec3f position = random_direction(rng) * (15 * next_unit_float(rng));
  return i % 3 == 0 ? LitPoint(position) : LitPoint(position, random_direction(rng));
}

TEST(LightTree, probabilities_of_all_lights_sum_to_one_at_every_point) {
  Rng rng(31);
  for (const int count : {1, 2, 7, 8, 9, 100, 3000}) {
    const LightTree tree(random_lights(count, rng));
    for (int i = 0; i < 100; ++i) {
      const LitPoint point = random_point(i, rng);
      double sum = 0;
      for (int light = 0; light < count; ++light) sum += tree.probability(light, point);
      EXPECT_NEAR(sum, 1, 1e-4) << count << " lights, seed 31";
    }
  }
}

TEST(LightTree, says_the_probability_with_which_it_chooses) {
  Rng rng(32);
  for (const int count : {2, 9, 100, 3000}) {
    const LightTree tree(random_lights(count, rng));
    for (int i = 0; i < 2000; ++i) {
      const LitPoint point = random_point(i, rng);
      const LightTree::Choice choice = tree.choose(point, next_unit_float(rng));
      EXPECT_NEAR(choice.probability / tree.probability(choice.light, point), 1, 1e-5) << "seed 32";
    }
  }
}

TEST(LightTree, chooses_by_its_probabilities) {
  Rng rng(33);
  constexpr int count = 50, n = 200000;
  const LightTree tree(random_lights(count, rng));
  for (int i = 0; i < 6; ++i) {
    const LitPoint point = random_point(i, rng);
    std::vector<int> chosen(count);
    for (int k = 0; k < n; ++k) ++chosen[tree.choose(point, (float(k) + next_unit_float(rng)) / n).light];
    // Stratified numbers: each light's range of them is cut off at two ends for each level.
    for (int light = 0; light < count; ++light)
      EXPECT_NEAR(chosen[light], double(n) * tree.probability(light, point), 20 + 1e-3 * chosen[light]) << "seed 33";
  }
}

// By definition of LightBounds: does some place of the light shine on the point from the side of its normal?
bool reaches(const LightBounds& light, const LitPoint& point, Rng& rng) {
  for (int i = 0; i < 20; ++i) {
    Vec3f place = light.box.lower;
    const Vec3f extent = light.box.extent();
    for (int axis = 0; axis < 3; ++axis) place[axis] += extent[axis] * next_unit_float(rng);
    const Vec3f towards = normalize(point.position - place);
    if (point.has_normal() && dot(towards, point.normal) > -1e-6f) continue;
    const float cosine = dot(towards, light.axis), seen = light.is_two_sided ? std::abs(cosine) : cosine;
    const float widest = std::acos(light.cos_normals) + std::acos(light.cos_emission);
    if (std::acos(std::clamp(seen, -1.0f, 1.0f)) < widest - 1e-3f) return true;
  }
  return false;
}

TEST(LightTree, no_light_that_reaches_the_point_is_never_chosen) {
  Rng rng(34);
  int reached = 0;
  for (const int count : {2, 30, 500}) {
    const std::vector<LightBounds> lights = random_lights(count, rng);
    const LightTree tree(lights);
    for (int i = 0; i < 60; ++i) {
      const LitPoint point = random_point(i, rng);
      for (int light = 0; light < count; ++light) {
        if (!reaches(lights[light], point, rng)) continue;
        ++reached;
        ASSERT_GT(tree.probability(light, point), 0) << "light " << light << " of " << count << ", seed 34";
      }
    }
  }
  EXPECT_GT(reached, 5000);
}

TEST(LightTree, lights_behind_the_surface_or_turned_away_are_not_chosen) {
  const auto lamp = [](Vec3f place, Vec3f axis) {
    return LightBounds{.box = {place, place}, .axis = axis, .cos_normals = 1, .intensity = 1};
  };
  const LightTree tree({lamp({0, 0, 1}, {0, 0, -1}), lamp({0, 0, -1}, {0, 0, 1}), lamp({1, 0, 1}, {0, 0, 1})});
  const LitPoint point({0, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(tree.probability(0, point), 1, 1e-6);
  EXPECT_EQ(tree.probability(1, point), 0);
  EXPECT_EQ(tree.probability(2, point), 0);
}

// Where the ball around a large light says nothing any more.
TEST(LightTree, close_behind_a_large_flat_light_only_others_are_chosen) {
  LightBounds large{.box = {{-2, -2, 1}, {2, 2, 1}}, .axis = {0, 0, 1}, .cos_normals = 1, .intensity = 1};
  large.lowest = height_along(large.axis, {2, 2, 1});
  const LightBounds bulb{.box = {{0, 0, 2}, {0, 0, 2}}, .intensity = 1};
  const LightTree tree({large, bulb});
  EXPECT_EQ(tree.probability(0, {{0, 0, 0.9f}, {0, 0, 1}}), 0);
  EXPECT_EQ(tree.probability(0, {{5, 1, 0.9f}, {0, 0, 1}}), 0);
  EXPECT_GT(tree.probability(0, {{0, 0, 1.1f}, {0, 0, -1}}), 0.1);
  // Above it, but facing away.
  EXPECT_EQ(tree.probability(0, {{0, 0, 1.1f}, {0, 0, 1}}), 0);
  large.is_two_sided = true;
  EXPECT_GT(LightTree({large, bulb}).probability(0, {{0, 0, 0.9f}, {0, 0, 1}}), 0.1);
}

TEST(LightTree, the_one_light_that_matters_is_chosen_often) {
  // Bulbs in a row, so far apart that each lights its own place: 99.8 % of the light is from the nearest.
  std::vector<LightBounds> lights;
  for (int i = 0; i < 1000; ++i) {
    const Vec3f place{10 * float(i), 0, 1};
    lights.push_back({.box = {place, place}, .intensity = 1});
  }
  const LightTree tree(lights);
  for (const int i : {0, 1, 333, 500, 750, 999})
    EXPECT_GT(tree.probability(i, {{10 * float(i), 0, 0}, {0, 0, 1}}), 0.3) << i;
}

TEST(LightTree, same_lights_make_the_same_choices) {
  Rng rng(35);
  const std::vector<LightBounds> lights = random_lights(300, rng);
  const LightTree first(lights), second(lights);
  for (int i = 0; i < 300; ++i) {
    const LitPoint point = random_point(i, rng);
    const float u = next_unit_float(rng);
    const LightTree::Choice a = first.choose(point, u), b = second.choose(point, u);
    EXPECT_EQ(a.light, b.light);
    EXPECT_EQ(a.probability, b.probability);
  }
}

TEST(LightTree, lights_at_one_place_are_chosen_by_intensity) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < 5000; ++i)
    lights.push_back({.box = {Vec3f(1), Vec3f(1)}, .intensity = i == 4321 ? 5001.0f : 1.0f});
  const LightTree tree(lights);
  EXPECT_NEAR(tree.probability(4321, LitPoint({0, 0, 0})), 0.5, 1e-3);
}

TEST(LightTree, rays_are_told_of_every_solid_light_that_they_meet) {
  Rng rng(36);
  const std::vector<LightBounds> lights = random_lights(500, rng);
  const LightTree tree(lights);
  int met = 0, visited = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto& target = lights[5 * (i % 100)].box;  // a solid one
    Vec3f place = target.lower;
    for (int axis = 0; axis < 3; ++axis) place[axis] += target.extent()[axis] * next_unit_float(rng);
    const Vec3f origin = random_direction(rng) * 20;
    Ray ray{.origin = origin, .direction = (place - origin) * (0.1f + next_unit_float(rng))};
    if (i % 2 == 0) ray.t_max = 0.5f;
    std::vector<int> found(lights.size());
    tree.visit_solid(ray, [&](std::uint32_t light) { ++found[light]; });
    for (std::uint32_t light = 0; light < lights.size(); ++light) {
      EXPECT_LE(found[light], lights[light].is_solid ? 1 : 0);
      visited += found[light];
      // The middle of a box that the segment passes through.
      const Vec3f center = lights[light].box.center();
      const float t = dot(center - origin, ray.direction) / length_squared(ray.direction);
      const Vec3f off = abs(ray.at(t) - center), half = lights[light].box.extent() * 0.5f;
      if (!lights[light].is_solid || !(t > 0 && t < ray.t_max)) continue;
      if (off.x > half.x || off.y > half.y || off.z > half.z) continue;
      ++met;
      EXPECT_EQ(found[light], 1) << "seed 36";
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_LT(visited, 20 * met);  // of 100 solid ones
}

TEST(LightPicker, distant_and_near_lights_together_sum_to_one) {
  Rng rng(37);
  LightPicker picker;
  const std::vector<LightBounds> lights = random_lights(40, rng);
  for (int i = 0; i < 3; ++i) picker.add_source(1);
  picker.add_source(40);
  picker.add_distant({0, 0}, {.towards = {0, 0, 1}, .irradiance = 3});
  picker.add_distant({2, 0},
                     {.towards = random_direction(rng), .cos_radius = 0.8f, .sin_radius = 0.6f, .irradiance = 0.1f});
  for (std::uint32_t i = 0; i < 40; ++i) picker.add({3, i}, lights[i]);
  picker.build();
  EXPECT_EQ(picker.size(), 42u);
  for (int i = 0; i < 300; ++i) {
    const LitPoint point = random_point(i, rng);
    double sum = 0;
    for (std::uint32_t source = 0; source < 4; ++source)
      for (std::uint32_t primitive = 0; primitive < (source == 3 ? 40u : 1u); ++primitive)
        sum += picker.probability({source, primitive}, point);
    EXPECT_NEAR(sum, 1, 1e-5) << "seed 37";
    EXPECT_EQ(picker.probability({1, 0}, point), 0);  // a source without light
    const LightPicker::Pick pick = picker.pick(point, next_unit_float(rng));
    EXPECT_NEAR(picker.probability(pick.light, point) / pick.probability, 1, 1e-5) << "seed 37";
  }
}

TEST(LightPicker, a_sun_below_the_horizon_is_left_alone_but_not_one_that_shows_its_rim) {
  LightPicker picker;
  for (int i = 0; i < 2; ++i) picker.add_source(1);
  picker.add_distant({0, 0}, {.towards = {0, 0, 1}, .irradiance = 1});
  const float s = std::sin(0.1f), c = std::cos(0.1f);
  picker.add_distant(
      {1, 0}, {.towards = {c, 0, -s}, .cos_radius = std::cos(0.11f), .sin_radius = std::sin(0.11f), .irradiance = 1});
  picker.build();
  EXPECT_GT(picker.probability({1, 0}, LitPoint({0, 0, 0}, {0, 0, 1})), 0);
  EXPECT_EQ(picker.probability({1, 0}, LitPoint({0, 0, 0}, normalize(Vec3f{-0.2f, 0, 1}))), 0);
}

}  // namespace
}  // namespace basicrt
