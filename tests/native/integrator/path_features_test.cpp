// SPDX-License-Identifier: GPL-3.0-or-later
// What Blender's settings and objects ask of the path tracer beside light: clamping, caustics, holes in the film, the
// shadow terminator.
#include <gtest/gtest.h>

#include <cmath>

#include "integrator_scenes.h"
#include "math/constants.h"

namespace basicrt {
namespace {

Scene floor_under_sky(int samples) {
  Scene scene = scene_from_above(samples);
  scene.environment.radiance = Color(4, 2, 0);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  return scene;
}

TEST(Clamp, scales_what_a_path_adds_to_the_limit_s_mean) {
  Scene scene = floor_under_sky(16);  // every path finds (4, 2, 0), whose mean is 2
  scene.settings.clamp_direct = 0.5f;
  scene.settings.clamp_indirect = 0.1f;
  expect_radiance(scene, Color(1, 0.5f, 0), 1e-5f);
  scene.settings.clamp_direct = 3;
  expect_radiance(scene, Color(4, 2, 0), 1e-5f);
}

TEST(Clamp, takes_light_that_was_scattered_twice_for_indirect) {
  // The camera looks through a pane that bends nothing, so the floor is the second scattering.
  Scene scene = floor_under_sky(16);
  scene.settings.clamp_direct = 0.1f;
  scene.settings.clamp_indirect = 0.5f;
  add_instance(scene, square(0.1f, 3.9f), add_material(scene, RefractionShader{.ior = 1}));
  expect_radiance(scene, Color(1, 0.5f, 0), 1e-3f);
}

TEST(Clamp, holds_light_samples_too) {
  Scene scene = scene_from_above(16);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  scene.lights.append(PointLight{.position = {1, 0, 2}, .intensity = Color(100.0f)});
  scene.settings.clamp_indirect = 0.1f;
  const Color open = render_mean(scene).radiance;
  EXPECT_GT(open.x, 1);
  scene.settings.clamp_direct = 0.25f;
  expect_radiance(scene, Color(0.25f), 1e-5f);
}

TEST(Caustics, without_refractive_ones_no_light_comes_through_glass_to_a_diffuse_surface) {
  Scene scene = scene_from_above(2000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  scene.lights.append(SunLight{.direction = {0, 0, -1}, .irradiance = Color(1.0f), .angle = 1.2f});
  add_instance(scene, square(20, 1), add_material(scene, GlassShader{.ior = 1}));
  EXPECT_GT(render_mean(scene).radiance.x, 0.1f);
  scene.settings.has_reflective_caustics = false;
  EXPECT_GT(render_mean(scene).radiance.x, 0.1f);
  scene.settings.has_refractive_caustics = false;
  EXPECT_EQ(render_mean(scene).radiance, Color(0.0f));
}

TEST(Caustics, without_reflective_ones_mirrors_send_no_light_to_a_diffuse_surface) {
  // All that shines is seen by the floor in a mirror above it, beside which the camera looks.
  Scene scene = scene_from_above(2000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  Mesh mirror = square(2, 1);
  for (Vec3f& p : mirror.positions) p.x += 2.1f;
  add_instance(scene, mirror, add_material(scene, GlossyShader{.color = Color(1.0f), .roughness = 0}));
  Mesh emitter = square(2, 0.5f);
  for (Vec3f& p : emitter.positions) p.x += 2.5f;
  add_instance(scene, emitter, add_material(scene, EmissionShader{.radiance = Color(1.0f), .is_two_sided = false}));
  EXPECT_GT(render_mean(scene).radiance.x, 0.001f);
  scene.settings.has_reflective_caustics = false;
  EXPECT_EQ(render_mean(scene).radiance, Color(0.0f));
}

TEST(BlurGlossy, lets_a_diffuse_surface_find_a_point_light_in_a_mirror) {
  Scene scene = scene_from_above(2000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  Mesh mirror = square(2, 1);
  for (Vec3f& p : mirror.positions) p.x += 2.1f;
  add_instance(scene, mirror, add_material(scene, GlossyShader{.color = Color(1.0f), .roughness = 0}));
  Mesh screen = square(2, 0.4f);  // hides the light from the floor, not from the mirror
  for (Vec3f& p : screen.positions) p.x += 2.5f;
  add_instance(scene, screen, add_material(scene, DiffuseShader{.color = Color(0.0f)}));
  scene.lights.append(PointLight{.position = {2, 0, 0.5f}, .intensity = Color(1.0f)});
  EXPECT_EQ(render_mean(scene).radiance, Color(0.0f));
  scene.settings.blur_glossy = 1;
  EXPECT_GT(render_mean(scene).radiance.x, 1e-4f);
}

TEST(BlurGlossy, leaves_what_the_camera_sees_sharp) {
  Scene scene = scene_from_above(16);
  scene.settings.blur_glossy = 10;
  add_instance(scene, square(20, 0), add_material(scene, GlossyShader{.color = Color(0.5f), .roughness = 0}));
  add_instance(scene, square(0.01f, 5), add_material(scene, EmissionShader{.radiance = Color(1.0f)}));
  expect_radiance(scene, Color(0.5f), 1e-4f);
}

TEST(LightThreshold, does_not_change_the_mean) {
  Scene scene = scene_from_above(4000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  for (int i = 0; i < 8; ++i) scene.lights.append(PointLight{.position = {float(i), 0, 2}, .intensity = Color(0.05f)});
  const Color all = render_mean(scene).radiance;
  scene.settings.light_threshold = 0.05f;  // more than any of them adds
  expect_radiance(scene, all, 0.02f);
}

TEST(Holdout, an_object_is_a_hole_for_the_camera_alone) {
  Scene scene = floor_under_sky(64);
  scene.environment.radiance = Color(1.0f);
  scene.settings.is_film_transparent = true;
  scene.instances.set(Id<Instance>{0}, [&] {
    Instance floor = scene.instances[Id<Instance>{0}];
    floor.is_holdout = true;
    return floor;
  }());
  EXPECT_EQ(render_mean(scene).alpha, 0);
  EXPECT_EQ(render_mean(scene).radiance, Color(0.0f));
  // Seen in a mirror it is what it was: white under a white sky.
  add_instance(scene, square(0.1f, 3.9f), add_material(scene, RefractionShader{.ior = 1}));
  EXPECT_EQ(render_mean(scene).alpha, 1);
  expect_radiance(scene, Color(1.0f), 1e-3f);
}

TEST(Holdout, a_node_s_share_is_a_hole) {
  Scene scene = scene_from_above(64);
  scene.settings.is_film_transparent = true;
  Material material;
  const NodeIndex hole = material.add(HoldoutShader{}), shine = material.add(EmissionShader{.radiance = Color(1.0f)});
  material.surface = material.add(MixShader{.factor = 0.25f, .first = hole, .second = shine});
  add_instance(scene, square(1, 0), scene.materials.append(material));
  EXPECT_NEAR(render_mean(scene).alpha, 0.25f, 1e-5f);
  expect_radiance(scene, Color(0.25f), 1e-5f);
  scene.settings.is_film_transparent = false;  // it is a hole nevertheless
  EXPECT_NEAR(render_mean(scene).alpha, 0.25f, 1e-5f);
}

TEST(TransparentFilm, shows_through_glass_that_is_smooth_enough) {
  Scene scene = scene_from_above(400);
  scene.environment.radiance = Color(1.0f);
  scene.settings.is_film_transparent = true;
  add_instance(scene, square(1, 0),
               add_material(scene, RefractionShader{.color = Color(0.75f), .ior = 1.2f, .roughness = 0.4f}));
  EXPECT_EQ(render_mean(scene).alpha, 1);
  scene.settings.is_glass_transparent = true;
  scene.settings.transparent_glass_roughness = 0.1f;
  EXPECT_EQ(render_mean(scene).alpha, 1) << "alpha of the microfacets is 0.16";
  scene.settings.transparent_glass_roughness = 0.2f;
  EXPECT_NEAR(render_mean(scene).alpha, 0.25f, 0.01f);
  EXPECT_EQ(render_mean(scene).radiance, Color(0.0f));
}

// A floor under a sun, and a square that shades it where the camera looks.
Scene catcher_scene() {
  Scene scene = scene_from_above(64);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  Instance floor = scene.instances[Id<Instance>{0}];
  floor.is_shadow_catcher = true;
  scene.instances.set(Id<Instance>{0}, floor);
  scene.lights.append(SunLight{.direction = {-1, 0, -1}, .irradiance = Color(3.0f)});
  scene.environment.radiance = Color(0.5f, 0.25f, 0);
  scene.settings.max_bounces = 0;
  return scene;
}

void add_shade(Scene& scene) {
  Mesh shade = square(0.5f, 1);
  for (Vec3f& p : shade.positions) p.x += 1;
  add_instance(scene, shade, add_material(scene, DiffuseShader{.color = Color(0.0f)}));
}

TEST(ShadowCatcher, without_a_shadow_only_the_background_is_seen) {
  Scene scene = catcher_scene();
  expect_radiance(scene, scene.environment.radiance, 1e-4f);
  scene.settings.is_film_transparent = true;
  EXPECT_NEAR(render_mean(scene).alpha, 0, 1e-5f);
}

TEST(ShadowCatcher, a_shadow_darkens_by_the_share_of_light_that_it_takes) {
  Scene scene = catcher_scene();
  add_shade(scene);
  scene.environment.radiance = Color(0.0f);
  scene.settings.is_film_transparent = true;
  EXPECT_EQ(render_mean(scene).alpha, 1) << "nothing but the sun";
  // The square takes all of the sun and, by its solid angle weighted with cosines, a known share F of the sky.
  scene.environment.radiance = Color(1.0f);
  double form_factor = 0;
  for (double x = 0.5; x < 1.5; x += 0.01)
    for (double y = -0.5; y < 0.5; y += 0.01) form_factor += 1e-4 / (pi * std::pow(1 + x * x + y * y, 2));
  const double sun = 3 / std::sqrt(2.0) / pi;
  scene.settings.samples = 4000;
  const MeanColor mean = render_mean(scene);
  EXPECT_NEAR(mean.alpha, 1 - (1 - form_factor) / (1 + sun), 0.005);
  EXPECT_EQ(mean.radiance, Color(0.0f));
}

TEST(ShadowCatcher, objects_behind_and_before_it_are_seen) {
  Scene scene = catcher_scene();
  scene.environment.radiance = Color(0.0f);
  add_instance(scene, square(1, -1), add_material(scene, EmissionShader{.radiance = Color(2.0f)}));
  expect_radiance(scene, Color(2.0f), 1e-4f);
  add_instance(scene, square(0.01f, 1), add_material(scene, EmissionShader{.radiance = Color(3.0f)}));
  expect_radiance(scene, Color(3.0f), 1e-4f);
}

// A prism of `sides` facets around the y axis with the normals of a cylinder, looked at where the cylinder's normal is at
// `angle` from the x axis, from which a sun shines.
Scene lit_prism(int sides, float first_corner, float angle, float offset) {
  Scene scene;
  Mesh prism;
  for (int i = 0; i < sides; ++i) {
    const auto corner = [&](int k) {
      const float a = first_corner + 2 * pi * static_cast<float>(k) / static_cast<float>(sides);
      return Vec3f{std::cos(a), 0, std::sin(a)};
    };
    const Vec3f n0 = corner(i), n1 = corner(i + 1);
    const auto base = static_cast<std::uint32_t>(prism.positions.size());
    for (const Vec3f& n : {n0, n1})
      for (const float y : {-1.0f, 1.0f}) prism.positions.push_back({n.x, y, n.z});
    prism.triangles.push_back({base, base + 1, base + 2});
    prism.triangles.push_back({base + 2, base + 1, base + 3});
    for (const Vec3f& n : {n0, n0, n1, n1, n0, n1}) prism.corner_normals.push_back(n);
  }
  OrthographicCamera camera;
  const Vec3f normal{std::cos(angle), 0, std::sin(angle)};
  const PerspectiveCamera look = make_look_at_camera(normal * 3.0f, {0, 0, 0}, {0, 1, 0}, 0.1f, 1);
  camera.to_world = look.to_world;
  camera.window_min = {-1e-4f, -1e-4f};
  camera.window_max = {1e-4f, 1e-4f};
  scene.camera = camera;
  scene.settings.width = scene.settings.height = 4;
  scene.settings.samples = 4;
  scene.settings.max_bounces = 0;
  scene.lights.append(SunLight{.direction = {-1, 0, 0}, .irradiance = Color(1.0f)});
  scene.instances.append({.name = "",
                          .shape = scene.shapes.append(prism),
                          .object_to_world = {},
                          .materials = {add_material(scene, DiffuseShader{.color = Color(1.0f)})},
                          .shadow_terminator_offset = offset});
  return scene;
}

TEST(ShadowTerminator, facets_turned_from_the_light_are_lit_as_the_smooth_surface_is) {
  // Corners at 80 and 102.5 degrees: the facet at 85 degrees looks away from the sun, the cylinder does not.
  const float degree = pi / 180, angle = 85 * degree;
  EXPECT_EQ(render_mean(lit_prism(16, 80 * degree, angle, 0)).radiance, Color(0.0f));
  const Color lit = render_mean(lit_prism(16, 80 * degree, angle, 0.1f)).radiance;
  // Interpolated normals point along the chord at the angle's share of it.
  EXPECT_NEAR(lit.x, std::cos(angle) / pi, 0.02f * std::cos(angle) / pi);
}

TEST(ShadowTerminator, what_looks_away_stays_dark_and_what_looks_there_as_it_was) {
  const float degree = pi / 180;
  EXPECT_EQ(render_mean(lit_prism(16, 80 * degree, 95 * degree, 0.1f)).radiance, Color(0.0f));
  const Scene off = lit_prism(16, 80 * degree, 40 * degree, 0), on = lit_prism(16, 80 * degree, 40 * degree, 0.1f);
  EXPECT_EQ(render_mean(on).radiance, render_mean(off).radiance);
}

TEST(ShadowTerminator, a_shading_offset_widens_the_light_s_angle) {
  const float degree = pi / 180;
  Scene scene = lit_prism(64, 30 * degree, 40 * degree, 0);
  Instance dimmed = scene.instances[0];
  dimmed.shadow_terminator_shading_offset = 0.5f;
  scene.instances.set(Id<Instance>{0}, dimmed);
  const float widened = 40 * degree / 0.75f;
  EXPECT_NEAR(render_mean(scene).radiance.x, std::cos(widened) / pi, 0.02f * std::cos(widened) / pi);
}

}  // namespace
}  // namespace basicrt
