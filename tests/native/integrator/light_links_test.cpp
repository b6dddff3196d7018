// SPDX-License-Identifier: GPL-3.0-or-later
// Lights that only some objects receive, or that only some objects dim.
#include <gtest/gtest.h>

#include "base/error.h"
#include "integrator_scenes.h"
#include "math/constants.h"

namespace basicrt {
namespace {

LinkSets sets(std::initializer_list<int> numbers) {
  LinkSets made = LinkSets::none();
  for (const int number : numbers) made.add(number);
  return made;
}

// A white floor of that material.
Instance& add_floor(Scene& scene, std::vector<Instance>& instances,
                    ShaderNode node = DiffuseShader{.color = Color(1.0f)}) {
  instances.push_back({.name = "floor",
                       .shape = scene.shapes.append(square(20, 0)),
                       .object_to_world = {},
                       .materials = {add_material(scene, std::move(node))}});
  return instances.back();
}

// At z = 0.5: hides the floor from all that lies above, but not from the camera.
Instance& add_blocker(Scene& scene, std::vector<Instance>& instances) {
  instances.push_back({.name = "blocker",
                       .shape = scene.shapes.append(square(8, 0.5f)),
                       .object_to_world = {},
                       .materials = {add_material(scene, DiffuseShader{.color = Color(0.0f)})},
                       .visibility = ray_all & ~ray_camera});
  return instances.back();
}

// At z = 1, of 2 m by 2 m, that shines down.
Instance& add_glow(Scene& scene, std::vector<Instance>& instances) {
  Mesh mesh = square(1, 1);
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  instances.push_back(
      {.name = "glow",
       .shape = scene.shapes.append(mesh),
       .object_to_world = {},
       .materials = {add_material(scene, EmissionShader{.radiance = Color(3.0f), .is_two_sided = false})},
       .visibility = ray_all & ~ray_camera});
  return instances.back();
}

AreaLight ceiling() {
  AreaLight lamp{.to_world = {}, .radiance = Color(3.0f), .is_camera_visible = false};
  lamp.to_world.rows = {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 1}}};
  return lamp;
}

// What a square of 2 m by 2 m and of radiance 1 at a height of 1 m adds to a white diffuse floor beneath its middle.
float diffuse_share() {
  const float a = 1 / std::sqrt(2.0f);
  return 4 / (2 * pi) * 2 * a * std::atan(a);
}

Color mean_of(Scene scene, const std::vector<Instance>& instances) {
  for (const Instance& instance : instances) scene.instances.append(instance);
  return render_mean(scene).radiance;
}

void expect_gray(Color color, float expected, float relative) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected, relative * expected + 1e-7f) << "channel " << i;
}

TEST(LightLinks, lamps_light_what_is_in_their_sets) {
  Scene scene = scene_from_above(400);
  std::vector<Instance> instances;
  Instance& floor = add_floor(scene, instances);
  AreaLight lamp = ceiling();
  lamp.lit_sets = sets({2, 63});
  scene.lights.append(lamp);
  // Another one that lights all else is no reason to choose the first.
  lamp.lit_sets = sets({0, 1});
  lamp.radiance = Color(30.0f);
  scene.lights.append(lamp);
  for (const int set : {2, 63}) {
    floor.receiver_set = set;
    expect_gray(mean_of(scene, instances), 3 * diffuse_share(), 5e-3f);
  }
  floor.receiver_set = 1;
  expect_gray(mean_of(scene, instances), 30 * diffuse_share(), 5e-3f);
  floor.receiver_set = 5;
  EXPECT_EQ(mean_of(scene, instances), Color(0.0f));
}

TEST(LightLinks, emissive_objects_light_what_is_in_their_sets) {
  Scene scene = scene_from_above(400);
  std::vector<Instance> instances;
  add_floor(scene, instances);
  add_glow(scene, instances).lit_sets = sets({3});
  EXPECT_EQ(mean_of(scene, instances), Color(0.0f));
  instances[0].receiver_set = 3;
  expect_gray(mean_of(scene, instances), 3 * diffuse_share(), 5e-3f);
}

TEST(LightLinks, mirrors_show_what_lights_them_and_the_camera_sees_all) {
  for (const bool is_linked : {false, true}) {
    Scene scene = scene_from_above(16);
    std::vector<Instance> instances;
    add_floor(scene, instances, GlossyShader{.color = Color(1.0f), .roughness = 0}).receiver_set = is_linked ? 4 : 1;
    AreaLight lamp = ceiling();
    lamp.lit_sets = sets({4});
    scene.lights.append(lamp);
    expect_gray(mean_of(scene, instances), is_linked ? 3 : 0, 1e-5f);
    Scene seen = scene;
    lamp.is_camera_visible = true;
    lamp.to_world.rows[2][2] = -1;  // shines up
    seen.lights.append(lamp);
    expect_gray(mean_of(seen, instances), is_linked ? 6 : 3, 1e-5f);
  }
}

TEST(LightLinks, blockers_dim_the_lights_that_name_their_set) {
  for (const bool is_lamp : {true, false})
    for (const float roughness : {1.0f, 0.3f, 0.05f, 0.0f}) {
      SCOPED_TRACE(testing::Message() << (is_lamp ? "lamp" : "emitter") << ", roughness " << roughness);
      Scene scene = scene_from_above(roughness > 0 && roughness < 1 ? 600 : 400);
      std::vector<Instance> instances;
      if (roughness == 1)
        add_floor(scene, instances);
      else
        add_floor(scene, instances, GlossyShader{.color = Color(1.0f), .roughness = roughness});
      AreaLight lamp = ceiling();
      if (!is_lamp) add_glow(scene, instances);
      const auto lit_by = [&](LinkSets blockers) {
        lamp.blocker_sets = blockers;
        Scene lit = scene;
        if (is_lamp)
          lit.lights.append(lamp);
        else
          instances[1].blocker_sets = blockers;
        return mean_of(lit, instances);
      };
      const float clear = lit_by({}).x;
      EXPECT_GT(clear, 0.1f);
      add_blocker(scene, instances).blocker_set = 7;
      expect_gray(lit_by({}), 0, 0);
      expect_gray(lit_by(sets({0, 7})), 0, 0);
      expect_gray(lit_by(sets({0, 6})), clear, roughness == 0 ? 1e-5f : 0.02f);
    }
}

TEST(LightLinks, suns_have_blockers_too) {
  Scene scene = scene_from_above(400);
  std::vector<Instance> instances;
  add_floor(scene, instances);
  add_blocker(scene, instances).blocker_set = 1;
  for (const float angle : {0.0f, 0.6f}) {
    Scene lit = scene;
    lit.lights.append(SunLight{.irradiance = Color(2.0f), .angle = angle, .blocker_sets = sets({0})});
    expect_gray(mean_of(lit, instances), 2 / pi, 5e-3f);
    Scene dim = scene;
    dim.lights.append(SunLight{.irradiance = Color(2.0f), .angle = angle, .blocker_sets = sets({1})});
    EXPECT_EQ(mean_of(dim, instances), Color(0.0f));
  }
}

TEST(LightLinks, of_too_many_choices_are_refused) {
  Scene scene = scene_from_above(1);
  std::vector<Instance> instances;
  add_floor(scene, instances);
  scene.instances.append(instances.front());
  for (int i = 0; i < 2; ++i)
    for (int set = 0; set < most_shadow_links; ++set)
      scene.lights.append(PointLight{.position = {0, 0, 1}, .blocker_sets = sets({set})});
  validate(scene);
  scene.lights.append(PointLight{.position = {0, 0, 1}, .blocker_sets = sets({50})});
  EXPECT_THROW(validate(scene), SceneError);
}

}  // namespace
}  // namespace basicrt
