// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes: dimmed light and single scattering against closed forms and numeric integrals, energy in furnaces, and which
// volumes a path is in.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bsdf/phase.h"
#include "integrator_scenes.h"
#include "math/constants.h"

namespace basicrt {
namespace {

Id<Material> add_volume(Scene& scene, const VolumeShader& volume, std::optional<ShaderNode> surface = {}) {
  Material material;
  material.volume = material.add(volume);
  if (surface) material.surface = material.add(*surface);
  return scene.materials.append(std::move(material));
}

Color dimmed(Color extinction, float distance) {
  return {std::exp(-extinction.x * distance), std::exp(-extinction.y * distance), std::exp(-extinction.z * distance)};
}

void set_all_bounces(Scene& scene, int bounces) {
  RenderSettings& settings = scene.settings;
  settings.max_bounces = settings.volume_bounces = settings.transmission_bounces = settings.glossy_bounces = bounces;
}

// Looks down on a square at z = 0 that shines.
Scene shining_floor(int samples) {
  Scene scene = scene_from_above(samples);
  add_instance(scene, square(20, 0), add_material(scene, EmissionShader{}));
  return scene;
}

double integrate_along(double begin, double end, const std::function<double(double)>& f) {
  constexpr int steps = 4000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(begin + (end - begin) * (i + 0.5) / steps);
  return sum * (end - begin) / steps;
}

const Color absorption{0.2f, 0.5f, 1.5f};

TEST(Absorption, dims_light_by_lambert_and_beer) {
  Scene scene = shining_floor(1);
  add_instance(scene, box({-1, -1, 1}, {1, 1, 2.5f}), add_volume(scene, {.absorption = absorption}));
  expect_radiance(scene, dimmed(absorption, 1.5f), 1e-5f);
}

TEST(Absorption, of_overlapping_and_nested_shapes_adds_up) {
  Scene scene = shining_floor(1);
  const Color inner{1, 0, 0.1f};
  add_instance(scene, box({-1, -1, 1}, {1, 1, 3}), add_volume(scene, {.absorption = absorption}));
  add_instance(scene, box({-0.5f, -0.5f, 1.5f}, {0.5f, 0.5f, 2}), add_volume(scene, {.absorption = inner}));
  add_instance(scene, box({-0.7f, -0.5f, 2.5f}, {0.5f, 0.8f, 3.5f}), add_volume(scene, {.absorption = inner}));
  expect_radiance(scene, dimmed(absorption, 2) * dimmed(inner, 1.5f), 1e-5f);
}

TEST(Absorption, begins_at_a_camera_inside) {
  Scene scene = shining_floor(1);
  add_instance(scene, box({-1, -1, 1}, {1, 1, 5}), add_volume(scene, {.absorption = absorption}));
  add_instance(scene, box({-2, -2, 0.5f}, {2, 2, 6}), add_volume(scene, {.absorption = Color(0.1f)}));
  // Above the camera, of which it is not inside.
  add_instance(scene, box({-2, -2, 4.5f}, {2, 2, 5.5f}), add_volume(scene, {.absorption = Color(7.0f)}));
  expect_radiance(scene, dimmed(absorption, 3) * dimmed(Color(0.1f), 3.5f), 1e-5f);
}

TEST(Absorption, of_the_world_fills_space_and_hides_what_is_infinitely_far) {
  Scene scene = shining_floor(1);
  scene.world_volume = add_volume(scene, {.absorption = Color(0.3f, 0.1f, 0)});
  add_instance(scene, box({-1, -1, 1}, {1, 1, 2}), add_volume(scene, {.absorption = absorption}));
  expect_radiance(scene, dimmed(Color(0.3f, 0.1f, 0), 4) * dimmed(absorption, 1), 1e-5f);

  Scene empty = scene_from_above(1);
  empty.environment.radiance = Color(1.0f);
  empty.world_volume = add_volume(empty, {.absorption = Color(0.3f, 0.1f, 0)});
  expect_radiance(empty, Color(0, 0, 1), 1e-6f);
}

TEST(Absorption, dims_lamps_that_are_seen_and_lamps_that_light) {
  Scene seen = scene_from_above(1);
  Transform up;
  up.rows = {{{2, 0, 0, 0}, {0, -2, 0, 0}, {0, 0, -1, 2}}};
  seen.lights.append(AreaLight{.to_world = up});
  seen.world_volume = add_volume(seen, {.absorption = absorption});
  expect_radiance(seen, dimmed(absorption, 2), 1e-5f);

  Scene lit = scene_from_above(1);
  add_instance(lit, square(20, 0), add_material(lit, DiffuseShader{.color = Color(1.0f)}));
  lit.lights.append(PointLight{.position = {0, 0, 6}, .intensity = Color(36 * pi)});
  add_instance(lit, box({-1, -1, 4.5f}, {1, 1, 5.5f}), add_volume(lit, {.absorption = absorption}));
  expect_radiance(lit, dimmed(absorption, 1), 1e-3f);
}

TEST(Absorption, fills_glass) {
  Scene scene = shining_floor(4);
  set_all_bounces(scene, 12);
  const GlassShader glass{.ior = 1};
  add_instance(scene, box({-1, -1, 1}, {1, 1, 2}), add_volume(scene, {.absorption = absorption}, glass));
  expect_radiance(scene, dimmed(absorption, 1), 1e-4f);
}

TEST(VolumeEmission, adds_up_along_the_ray_and_is_dimmed) {
  Scene scene = scene_from_above(1);
  const Color emission{1, 2, 3}, extinction{0, 0.5f, 2};
  add_instance(scene, box({-1, -1, 0}, {1, 1, 2}), add_volume(scene, {.absorption = extinction, .emission = emission}));
  const Color expected{2, 2 * (1 - std::exp(-1.0f)) / 0.5f, 3 * (1 - std::exp(-4.0f)) / 2};
  expect_radiance(scene, expected, 1e-5f);
}

// A uniform volume everywhere, a lamp beside the camera's ray, which ends on a black floor.
TEST(Scattering, of_a_point_light_in_fog_is_the_integral_along_the_ray) {
  const Color scattering{0.1f, 0.3f, 0.0f}, extinction = scattering + Color(0.05f, 0, 0.2f);
  Scene scene = scene_from_above(1000);
  scene.settings.volume_bounces = 0;
  Material black;
  scene.instances.append({.name = "",
                          .shape = scene.shapes.append(square(20, 0)),
                          .object_to_world = {},
                          .materials = {scene.materials.append(black)}});
  scene.world_volume =
      add_volume(scene, {.absorption = Color(0.05f, 0, 0.2f), .scattering = scattering, .anisotropy = 0.4f});
  const Vec3d lamp{0.5, 0, 2.5};
  scene.lights.append(PointLight{.position = Vec3f(lamp), .intensity = Color(10.0f)});
  Color expected;
  for (std::size_t c = 0; c < 3; ++c)
    expected[c] = static_cast<float>(integrate_along(0, 4, [&](double t) {
      const Vec3d to_lamp = lamp - Vec3d{0, 0, 4 - t};
      const double distance = length(to_lamp);
      const double phase = HenyeyGreenstein(0.4f).eval(static_cast<float>(-to_lamp.z / distance));
      return scattering[c] * phase * std::exp(-extinction[c] * (t + distance)) * 10 / (distance * distance);
    }));
  expect_radiance(scene, expected, 0.01f);
}

TEST(Scattering, of_the_sun_in_a_box_is_the_integral_along_the_ray) {
  const Color scattering{0.5f, 1, 2};
  Scene scene = scene_from_above(400);
  scene.settings.volume_bounces = 0;
  add_instance(scene, box({-1, -1, 0}, {1, 1, 2}), add_volume(scene, {.scattering = scattering}));
  scene.lights.append(SunLight{.direction = {-1, 0, 0}, .irradiance = Color(3.0f)});
  Color expected;
  for (std::size_t c = 0; c < 3; ++c)
    expected[c] = 3 / (4 * pi) * std::exp(-scattering[c]) * (1 - std::exp(-2 * scattering[c]));
  expect_radiance(scene, expected, 0.01f);
}

// Light that is the same from everywhere stays so where nothing is absorbed.
TEST(Scattering, loses_no_light_in_a_white_world) {
  Scene scene = scene_from_above(150);
  scene.environment.radiance = Color(1.0f);
  set_all_bounces(scene, 1000);
  add_instance(scene, box({-1, -1, 0}, {1, 1, 2}),
               add_volume(scene, {.scattering = Color(0.3f, 1, 3), .anisotropy = 0.3f}));
  add_instance(scene, box({-0.5f, -0.5f, 0.5f}, {0.5f, 1.5f, 1}),
               add_volume(scene, {.scattering = Color(1.0f), .phase = PhaseKind::rayleigh}));
  expect_radiance(scene, Color(1.0f), 0.02f);
}

TEST(Scattering, loses_no_light_among_shining_walls_that_are_sampled) {
  Scene scene = scene_from_above(150);
  set_all_bounces(scene, 1000);
  add_instance(scene, Sphere{.center = {0, 0, 2}, .radius = 3}, add_material(scene, EmissionShader{}));
  add_instance(scene, box({-1, -1, 0}, {1, 1, 2}),
               add_volume(scene, {.scattering = Color(0.3f, 1, 3), .anisotropy = -0.3f}));
  expect_radiance(scene, Color(1.0f), 0.02f);
}

TEST(Scattering, happens_once_more_than_the_limit_says) {
  const auto render_with = [](int bounces) {
    Scene scene = scene_from_above(400);
    scene.settings.volume_bounces = bounces;
    add_instance(scene, box({-1, -1, 0}, {1, 1, 2}), add_volume(scene, {.scattering = Color(2.0f)}));
    scene.lights.append(SunLight{.direction = {-1, 0, 0}, .irradiance = Color(3.0f)});
    return render_mean(scene).radiance.x;
  };
  const float once = render_with(0), twice = render_with(1), often = render_with(100);
  EXPECT_GT(twice, 1.2f * once);
  EXPECT_GT(often, 1.1f * twice);
}

TEST(Scattering, is_not_lit_by_lamps_that_do_not_light_volumes) {
  Scene scene = scene_from_above(4);
  add_instance(scene, box({-1, -1, 0}, {1, 1, 2}), add_volume(scene, {.scattering = Color(2.0f)}));
  scene.lights.append(SunLight{.direction = {-1, 0, 0}, .irradiance = Color(3.0f), .is_volume_visible = false});
  expect_radiance(scene, Color(0.0f), 0);
}

TEST(Volumes, with_more_shapes_around_a_point_than_are_kept_go_on_without_the_last) {
  Scene scene = scene_from_above(1);
  add_instance(scene, square(20, -1), add_material(scene, EmissionShader{}));
  for (int i = 0; i < 10; ++i) {
    const float size = 1 - 0.05f * static_cast<float>(i);
    add_instance(scene, box({-size, -size, 1 - size}, {size, size, 1 + size}),
                 add_volume(scene, {.absorption = Color(0.1f)}));
  }
  float depth = 0;
  for (int i = 0; i < 8; ++i) depth += 2 - 0.1f * static_cast<float>(i);
  expect_radiance(scene, dimmed(Color(0.1f), depth), 1e-5f);
}

TEST(Volumes, are_opaque_in_the_film_where_they_take_the_background_away) {
  Scene scene = scene_from_above(1);
  scene.settings.is_film_transparent = true;
  add_instance(scene, box({-1, -1, 0}, {1, 1, 2}), add_volume(scene, {.absorption = Color(0.5f)}));
  EXPECT_NEAR(render_mean(scene).alpha, 1 - std::exp(-1.0f), 1e-5f);
}

}  // namespace
}  // namespace basicrt
