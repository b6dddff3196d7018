// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps whose light varies by a material: light samples and rays that run into them agree.
#include <gtest/gtest.h>

#include "integrator_scenes.h"
#include "math/constants.h"

namespace basicrt {
namespace {

// Emits a value of the point, as a number or as a colour.
Id<Material> add_emission_of(Scene& scene, SurfaceValue value) {
  Material material;
  const OperationIndex operation = material.add(SurfaceOperation{.value = value});
  material.surface = material.add(EmissionShader{.radiance = operation});
  return scene.materials.append(std::move(material));
}

// A square of 2 m by 2 m at z = 1 that shines down, unseen by the camera.
AreaLight ceiling(Id<Material> material) {
  AreaLight lamp{.to_world = {}, .radiance = Color(3.0f), .is_camera_visible = false, .material = material};
  lamp.to_world.rows = {{{2, 0, 0, 0.5f}, {0, 2, 0, 0}, {0, 0, 1, 1}}};
  return lamp;
}

// What a white diffuse floor reflects at the origin, in red and green, which are u and v.
Color expected_floor() {
  constexpr int n = 400;
  double red = 0, green = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (i + 0.5) / n, v = (j + 0.5) / n, x = 2 * u - 0.5, y = 2 * v - 1;
      const double squared = x * x + y * y + 1, form = 1 / (squared * squared) * 4 / (n * n);
      red += form * u;
      green += form * v;
    }
  return Color(3 * float(red), 3 * float(green), 0) / pi;
}

TEST(LampMaterials, light_a_floor_by_the_picture_on_an_area_lamp) {
  Scene scene = scene_from_above(1000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  scene.lights.append(ceiling(add_emission_of(scene, SurfaceValue::uv)));
  expect_radiance(scene, expected_floor(), 5e-3f);
  // Where bounces end at once only light samples are left; they alone have not the weight of both.
  scene.settings.max_bounces = 0;
  expect_radiance(scene, expected_floor(), 5e-3f);
}

TEST(LampMaterials, are_the_same_to_rays_of_either_kind) {
  // Of a rough gloss both light samples and scattered rays count, of a nearly smooth one only the latter.
  for (const float roughness : {0.02f, 0.35f}) {
    Scene scene = scene_from_above(3000);
    add_instance(scene, square(20, 0), add_material(scene, GlossyShader{.color = Color(1.0f), .roughness = roughness}));
    // Nothing but the lamp's own place turns u into v: by symmetry both are one half above the origin.
    AreaLight lamp = ceiling(add_emission_of(scene, SurfaceValue::uv));
    lamp.to_world.rows[0][3] = 0;
    scene.lights.append(lamp);
    const Color mean = render_mean(scene).radiance;
    lamp.material = {};
    lamp.radiance = Color(1.5f, 1.5f, 0.0f);
    scene.lights.set(Id<Light>{0}, lamp);
    expect_radiance(scene, mean, 0.01f);
  }
}

TEST(LampMaterials, are_seen_in_a_mirror) {
  Scene scene = scene_from_above(16);
  add_instance(scene, square(20, 0), add_material(scene, GlossyShader{.color = Color(1.0f), .roughness = 0}));
  scene.lights.append(ceiling(add_emission_of(scene, SurfaceValue::uv)));
  expect_radiance(scene, Color(3 * 0.25f, 3 * 0.5f, 0), 1e-2f);
}

TEST(LampMaterials, that_are_the_same_everywhere_are_factors) {
  Scene scene = scene_from_above(64);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  const Id<Material> half = add_material(scene, EmissionShader{.radiance = Color(0.5f, 1, 0)});
  scene.lights.append(PointLight{.position = {0, 0, 2}, .intensity = Color(4 * pi), .material = half});
  expect_radiance(scene, Color(0.5f, 1, 0), 1e-4f);
  Report report;
  EXPECT_FALSE(prepare(scene, report).lights.lamp(0).is_varying);
}

TEST(LampMaterials, know_how_far_their_light_has_come) {
  Scene scene = scene_from_above(64);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  const Id<Material> distance = add_emission_of(scene, SurfaceValue::ray_length);
  scene.lights.append(PointLight{.position = {0, 0, 2}, .intensity = Color(4 * pi), .material = distance});
  expect_radiance(scene, Color(2.0f), 1e-4f);
}

TEST(LampMaterials, are_chosen_by_about_what_they_shine) {
  Scene scene = scene_from_above(16);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  scene.lights.append(ceiling(add_emission_of(scene, SurfaceValue::uv)));
  Report report;
  // The mean of (u, v, 0)'s luminance, each being one half.
  const float expected = luminance(Color(0.5f, 0.5f, 0));
  EXPECT_NEAR(prepare(scene, report).lights.lamp(0).estimate, expected, 0.02f * expected);
}

TEST(LampMaterials, light_volumes_too) {
  Scene scene = scene_from_above(4000);
  const Id<Material> fog =
      scene.materials.append({.name = "fog", .nodes = {VolumeShader{.scattering = Color(0.1f)}}, .volume = 0});
  scene.world_volume = fog;
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.0f)}));
  // Through a point lamp's colour that is constant, and one that is the same but has to be asked for.
  const auto picture = [&](Id<Material> material, Color color) {
    scene.lights.clear();
    scene.lights.append(PointLight{.position = {1, 0, 2}, .intensity = color, .material = material});
    return render_mean(scene).radiance;
  };
  Material asked;
  const OperationIndex normal = asked.add(SurfaceOperation{.value = SurfaceValue::normal});
  const OperationIndex squared =
      asked.add(VectorMathOperation{.operation = VectorMathKind::dot_product, .a = normal, .b = normal});
  asked.surface = asked.add(EmissionShader{.radiance = squared});
  const Color expected = picture({}, Color(5.0f));
  EXPECT_GT(expected.x, 0.01f);
  const Color found = picture(scene.materials.append(asked), Color(5.0f));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], 1e-3f * expected[i]);
}

}  // namespace
}  // namespace basicrt
