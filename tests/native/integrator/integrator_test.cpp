// SPDX-License-Identifier: GPL-3.0-or-later
// Integrators against closed forms.
#include "integrator/integrator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "integrator_scenes.h"
#include "math/constants.h"

namespace basicrt {
namespace {

TEST(IntersectionTest, a_lit_floor_has_the_closed_form_s_radiance) {
  Scene scene = scene_from_above(4);
  scene.settings.integrator = IntegratorKind::intersection_test;
  scene.settings.point_light_position = {3, 0, 2};
  scene.settings.point_light_flux = {17, 12, 5};
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{.color = Color(0.5f, 0.25f, 1)}));
  const float r = std::sqrt(13.0f), cosine = 2 / r;
  expect_radiance(scene, Color(0.5f, 0.25f, 1) * Color(17, 12, 5) * (cosine / (pi * 4 * pi * r * r)), 1e-3f);
}

TEST(IntersectionTest, anything_before_the_light_is_shadow) {
  Scene scene = scene_from_above(4);
  scene.settings.integrator = IntegratorKind::intersection_test;
  scene.settings.point_light_position = {3, 0, 2};
  const Id<Material> grey = add_material(scene, DiffuseShader{});
  add_instance(scene, square(5, 0), grey);
  add_instance(scene, Sphere{{1.5f, 0, 1}, 0.2f}, grey);
  expect_radiance(scene, Color(0.0f), 0);
}

TEST(IntersectionTest, refraction_shifts_what_is_seen_through_a_sheet) {
  // A sheet with index 2 is entered once and never left, as the assignment has it: at 45 degrees the ray goes on with
  // sin t = sin 45 / 2, so that it meets the floor not at x = 0 but at x = -1 + tan t.
  Scene scene = scene_from_above(1);
  PerspectiveCamera camera = make_look_at_camera({-2, 0, 2}, {-1, 0, 1}, {0, 1, 0}, 1e-4f, 1);
  scene.camera = camera;
  scene.settings.integrator = IntegratorKind::intersection_test;
  scene.settings.point_light_position = {0.5f, 0, 0.5f};
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{.color = Color(1.0f)}));
  Mesh sheet = square(0.2f, 1);
  for (Vec3f& p : sheet.positions) p.x -= 1;
  add_instance(scene, sheet, add_material(scene, RefractionShader{.ior = 2}));
  const float sine = std::sqrt(0.5f) / 2, x = -1 + sine / std::sqrt(1 - sine * sine);
  const float r2 = (0.5f - x) * (0.5f - x) + 0.25f;
  expect_radiance(scene, Color(0.5f / std::sqrt(r2) / (pi * 4 * pi * r2)), 2e-3f);
}

TEST(IntersectionTest, an_empty_scene_is_black) {
  Scene scene = scene_from_above(1);
  scene.settings.integrator = IntegratorKind::intersection_test;
  expect_radiance(scene, Color(0.0f), 0);
}

TEST(Path, a_white_furnace_is_white) {
  for (const ShaderNode& node :
       {ShaderNode(DiffuseShader{.color = Color(1.0f), .is_two_sided = true}), ShaderNode(GlassShader{}),
        ShaderNode(GlossyShader{.color = Color(1.0f), .roughness = 0}), ShaderNode(RefractionShader{})}) {
    Scene scene = scene_from_above(64);
    scene.environment.radiance = Color(0.5f, 1, 2);
    scene.settings.max_bounces = scene.settings.transmission_bounces = scene.settings.diffuse_bounces = 1000;
    add_instance(scene, Sphere{{0, 0, 0}, 1}, add_material(scene, node));
    expect_radiance(scene, Color(0.5f, 1, 2), 1e-3f);
  }
}

Image plain_picture(Color color) {
  return {.width = 2,
          .height = 1,
          .channels = 3,
          .pixels = {color.x, color.y, color.z, color.x, color.y, color.z},
          .path = ""};
}

TEST(Path, a_picture_of_one_colour_lights_as_that_colour_does) {
  Scene scene = scene_from_above(256);
  const Color color{0.5f, 1, 2};
  scene.environment.layers = {{.radiance = Color(2.0f), .image = plain_picture(color)}};
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  expect_radiance(scene, color, 0.01f);
}

TEST(Path, what_the_camera_sees_of_the_environment_may_differ_from_what_lights) {
  Scene scene = scene_from_above(64);
  scene.environment.layers = {{.radiance = {1, 0, 0}, .seen_by = EnvironmentRays::camera},
                              {.radiance = {0, 1, 0}, .seen_by = EnvironmentRays::scattered}};
  expect_radiance(scene, {1, 0, 0}, 1e-5f);
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  expect_radiance(scene, {0, 0.5f, 0}, 1e-3f);
}

// The half of [0, 1] where u is below a half is 0, the other 1.
Id<Texture> add_step(Scene& scene) {
  return scene.textures.append(
      ImageTexture{.image = {.width = 2, .height = 1, .channels = 1, .pixels = {0, 1}, .path = ""},
                   .interpolation = ImageInterpolation::closest});
}

Mesh square_with_uvs(float half_size, float z) {
  Mesh mesh = square(half_size, z);
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  return mesh;
}

TEST(Path, a_textured_emitter_sheds_the_light_of_its_bright_half) {
  // Half of a large square just above the floor shines: half of what is seen from below, for the black half is as wide.
  Scene scene = scene_from_above(1024);
  ColorInput step;
  step.texture = add_step(scene);
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  add_instance(scene, square_with_uvs(200, 6), add_material(scene, EmissionShader{.radiance = step, .strength = 3}));
  expect_radiance(scene, Color(0.5f * 3 / 2), 0.02f);
}

// A small lit square over a floor, of which rays that leave the floor anywhere find next to nothing.
TEST(Path, a_textured_emitter_is_sampled_as_a_light) {
  Scene textured = scene_from_above(4);
  Scene even = textured;
  ColorInput step;
  step.texture = add_step(textured);
  for (Scene* scene : {&textured, &even}) {
    add_instance(*scene, square(5, 0), add_material(*scene, DiffuseShader{.color = Color(0.5f)}));
    Mesh emitter = square_with_uvs(0.05f, 1);
    for (Vec3f& p : emitter.positions) p.x += 1;
    const bool is_even = scene == &even;
    if (is_even)
      for (Vec3f& p : emitter.positions) p.x = std::max(p.x, 1.0f);  // its bright half
    add_instance(
        *scene, emitter,
        add_material(*scene, EmissionShader{.radiance = is_even ? ColorInput(Color(1.0f)) : step, .strength = 3}));
  }
  const auto deviation = [](const Scene& scene, float mean) {
    Report report;
    const Film film = render(prepare(scene, report));
    const std::vector<float>& combined = film.values(Pass::combined);
    double sum = 0;
    for (std::size_t i = 0; i < combined.size(); i += 4) sum += (combined[i] - mean) * (combined[i] - mean);
    return std::sqrt(sum / double(combined.size() / 4)) / mean;
  };
  Scene many = even;
  many.settings.samples = 256;
  const float mean = render_mean(many).radiance.x;
  EXPECT_LT(deviation(even, mean), 0.02);
  EXPECT_LT(deviation(textured, mean), 0.6);  // half of the samples go to its dark half
  textured.settings.samples = 1024;
  expect_radiance(textured, Color(mean), 0.01f);
}

TEST(Path, a_share_that_varies_cuts_a_hole) {
  // A sheet between floor and camera that is opaque and black where u is above a half.
  for (const float x : {-0.1f, 0.1f}) {
    Scene scene = scene_from_above(16);
    scene.environment.radiance = Color(1.0f);
    NumberInput step;
    step.texture = add_step(scene);
    Material sheet;
    const NodeIndex clear = sheet.add(TransparentShader{});
    sheet.surface = sheet.add(MixShader{.factor = step, .first = clear, .second = no_node});
    Mesh mesh = square_with_uvs(1, 0);
    for (Vec3f& p : mesh.positions) p.x -= x;
    add_instance(scene, mesh, scene.materials.append(sheet));
    expect_radiance(scene, Color(x < 0 ? 1.0f : 0.0f), 1e-5f);
  }
}

TEST(Path, point_light_agrees_with_the_intersection_test) {
  Scene scene = scene_from_above(4);
  scene.settings.point_light_position = {3, 0, 2};
  scene.settings.point_light_flux = {17, 12, 5};
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{}));
  scene.lights.append(PointLight{.position = {3, 0, 2}, .intensity = Color(17, 12, 5) / (4 * pi)});
  const Color path = render_mean(scene).radiance;
  scene.settings.integrator = IntegratorKind::intersection_test;
  expect_radiance(scene, path, 1e-5f);
}

// A disc lamp of radius R at height h over a diffuse floor, straight above: E = pi L R^2 / (R^2 + h^2).
TEST(Path, an_area_lamp_lights_a_floor_by_the_closed_form) {
  Scene scene = scene_from_above(2000);
  const Color albedo(0.5f);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = albedo}));
  AreaLight lamp{.to_world = {}, .radiance = Color(3.0f), .is_ellipse = true};
  lamp.to_world.rows[0][0] = lamp.to_world.rows[1][1] = 2;
  lamp.to_world.rows[2][3] = 1.5f;
  scene.lights.append(lamp);
  // Its back is invisible, so the camera above it looks through.
  expect_radiance(scene, albedo * 3.0f * (1 / (1 + 1.5f * 1.5f)), 0.01f);
}

TEST(Path, an_emissive_mesh_and_a_lamp_of_its_shape_light_alike) {
  Scene scene = scene_from_above(2000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  Scene with_mesh = scene;
  AreaLight lamp{.to_world = {}, .radiance = Color(2.0f)};
  lamp.to_world.rows = {{{1, 0, 0, 2}, {0, 1, 0, 0}, {0, 0, 1, 1}}};
  scene.lights.append(lamp);
  Mesh emitter = square(0.5f, 1);
  for (Vec3f& p : emitter.positions) p.x += 2;
  for (auto& triangle : emitter.triangles) std::swap(triangle[1], triangle[2]);  // faces down
  add_instance(with_mesh, emitter,
               add_material(with_mesh, EmissionShader{.radiance = Color(2.0f), .is_two_sided = false}));
  expect_radiance(with_mesh, render_mean(scene).radiance, 0.01f);
}

// Light that only BSDF samples can find behind glass, and the same light with the glass away.
TEST(Path, a_lamp_seen_through_a_clear_pane_is_found_by_scattered_rays) {
  Scene scene = scene_from_above(20000);
  add_instance(scene, square(20, 0), add_material(scene, DiffuseShader{.color = Color(0.5f)}));
  scene.lights.append(SunLight{.direction = {0, 0, -1}, .irradiance = Color(1.0f), .angle = 1.2f});
  const Color open = render_mean(scene).radiance;
  add_instance(scene, square(20, 1), add_material(scene, RefractionShader{.ior = 1}));
  expect_radiance(scene, open, 0.02f);
}

TEST(Path, bounce_limits_count_as_in_blender) {
  // Inside a white sphere that emits L, each further bounce adds albedo^n L.
  Scene scene = scene_from_above(256);
  PerspectiveCamera camera = std::get<PerspectiveCamera>(*scene.camera);
  camera.to_world.rows[2][3] = 0;
  scene.camera = camera;
  Material material;
  const NodeIndex diffuse = material.add(DiffuseShader{.color = Color(0.5f), .is_two_sided = true});
  const NodeIndex emission = material.add(EmissionShader{.radiance = Color(1.0f)});
  material.surface = material.add(AddShader{diffuse, emission});
  add_instance(scene, Sphere{{0, 0, 0}, 2}, scene.materials.append(material));
  for (const auto& [limit, expected] : {std::pair(0, 1.5f), std::pair(1, 1.75f), std::pair(3, 1.9375f)}) {
    scene.settings.max_bounces = limit;
    expect_radiance(scene, Color(expected), 0.01f);
  }
}

TEST(Path, eight_transparent_sheets_pass_and_nine_are_black) {
  for (const int sheets : {1, 8, 9}) {
    Scene scene = scene_from_above(1);
    scene.environment.radiance = Color(1.0f);
    const Id<Material> material = add_material(scene, TransparentShader{.color = Color(0.9f, 1, 0.5f)});
    for (int i = 0; i < sheets; ++i) add_instance(scene, square(1, 0.1f * static_cast<float>(i)), material);
    const float n = static_cast<float>(sheets);
    expect_radiance(scene, sheets > 8 ? Color(0.0f) : Color(std::pow(0.9f, n), 1, std::pow(0.5f, n)), 1e-4f);
  }
}

TEST(Path, behind_the_last_sheet_only_emission_is_seen) {
  Scene scene = scene_from_above(16);
  Material lit;
  const NodeIndex grey = lit.add(DiffuseShader{}), glow = lit.add(EmissionShader{.radiance = Color(2.0f)});
  lit.surface = lit.add(AddShader{grey, glow});
  add_instance(scene, square(5, 0), scene.materials.append(lit));
  scene.lights.append(SunLight{.direction = normalize(Vec3f{1, 0, -1}), .irradiance = Color(1.0f)});
  scene.settings.max_bounces = 0;
  const Color open = render_mean(scene).radiance;
  EXPECT_GT(open.x, 2.05f);
  // The sheet is before the camera, but not before the sun.
  add_instance(scene, square(0.5f, 1), add_material(scene, TransparentShader{.color = Color(0.5f)}));
  scene.settings.transparent_bounces = 2;
  expect_radiance(scene, open * Color(0.5f), 0.01f);
  scene.settings.transparent_bounces = 1;
  expect_radiance(scene, Color(1.0f), 1e-4f);
  scene.settings.transparent_bounces = 0;
  expect_radiance(scene, Color(1.0f), 1e-4f);
}

TEST(Path, shadows_of_transparent_sheets_are_tinted) {
  Scene scene = scene_from_above(16);
  add_instance(scene, square(5, 0), add_material(scene, DiffuseShader{}));
  scene.lights.append(PointLight{.position = {3, 0, 2}, .intensity = Color(10.0f)});
  const Color open = render_mean(scene).radiance;
  Mesh sheet = square(0.5f, 1);
  for (Vec3f& p : sheet.positions) p.x += 1.5f;
  add_instance(scene, sheet, add_material(scene, TransparentShader{.color = Color(0.5f, 0.25f, 1)}));
  // (the sheet is beside the camera's view)
  expect_radiance(scene, open * Color(0.5f, 0.25f, 1), 1e-4f);
}

TEST(Path, a_transparent_film_has_alpha_where_surfaces_are) {
  Scene scene = scene_from_above(400);
  scene.environment.radiance = Color(1.0f);
  scene.settings.is_film_transparent = true;
  EXPECT_EQ(render_mean(scene).alpha, 0);
  EXPECT_EQ(render_mean(scene).radiance, Color(0.0f));
  Material half;
  const NodeIndex clear = half.add(TransparentShader{}),
                  grey = half.add(DiffuseShader{.color = Color(1.0f), .is_two_sided = true});
  half.surface = half.add(MixShader{.factor = 0.25f, .first = clear, .second = grey});
  add_instance(scene, square(1, 0), scene.materials.append(half));
  const MeanColor mean = render_mean(scene);
  EXPECT_NEAR(mean.alpha, 0.25f, 0.01f);
  EXPECT_NEAR(mean.radiance.x, 0.25f, 0.01f);
}

TEST(Path, russian_roulette_does_not_change_the_mean) {
  Scene scene = scene_from_above(3000);
  scene.environment.radiance = Color(1.0f);
  scene.settings.max_bounces = scene.settings.diffuse_bounces = 100;
  const Id<Material> grey = add_material(scene, DiffuseShader{.color = Color(0.5f), .is_two_sided = true});
  add_instance(scene, square(1, 0), grey);
  Mesh wall = square(1, 0);
  for (Vec3f& p : wall.positions) p = {0.3f, p.x, p.y};
  add_instance(scene, wall, grey);
  scene.settings.roulette_threshold = 0;
  const Color without = render_mean(scene).radiance;
  scene.settings.roulette_threshold = 1;
  expect_radiance(scene, without, 0.01f);
}

TEST(Integrator, a_batch_of_one_gives_the_same_sample) {
  Scene scene = scene_from_above(1);
  scene.environment.radiance = Color(1.0f);
  scene.lights.append(PointLight{.position = {1, 0, 2}, .intensity = Color(10.0f), .radius = 0.3f});
  add_instance(scene, Sphere{{0, 0, 0}, 1}, add_material(scene, GlassShader{.roughness = 0.3f}));
  Report report;
  const PreparedScene prepared = prepare(scene, report);
  CameraPaths paths;
  for (std::uint32_t i = 0; i < 100; ++i)
    paths.add(prepared.view.ray({4, 4}), Sampler(SamplerKind::sobol, {4, 4}, 0).at_sample(i));
  std::vector<PixelSample> together(paths.size());
  const std::unique_ptr<Integrator> integrator = make_integrator(prepared);
  integrator->render(paths, together);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    PixelSample alone;
    CameraPaths path;
    path.add(paths.rays[i], paths.samplers[i]);
    integrator->render(path, {&alone, 1});
    EXPECT_EQ(alone.radiance, together[i].radiance) << i;
  }
}

}  // namespace
}  // namespace basicrt
