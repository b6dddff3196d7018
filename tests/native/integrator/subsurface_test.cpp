// SPDX-License-Identifier: GPL-3.0-or-later
// Light beneath surfaces: thick bodies against Chandrasekhar's closed form, thin ones against the volumes' own path
// tracer, and what is inside bodies.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bsdf/subsurface_medium.h"
#include "integrator_scenes.h"

namespace basicrt {
namespace {

// In which all that comes out meets the same light.
Scene furnace(int samples) {
  Scene scene = scene_from_above(samples);
  scene.environment.radiance = Color(1.0f);
  scene.settings.max_bounces = scene.settings.volume_bounces = 1024;
  scene.settings.roulette_threshold = 0;
  return scene;
}

// Light enters straight on, as good as unbent.
SubsurfaceShader straight(SubsurfaceModel model, Color color, float radius, float anisotropy = 0) {
  return {.color = color,
          .radius = Vec3f(radius),
          .scale = 1.0f,
          .ior = 1.01f,
          .alpha = 0.0f,
          .anisotropy = anisotropy,
          .model = model};
}

Subsurface lobe_of(const SubsurfaceShader& shader) {
  return {shader.model,        shader.color.constant, shader.radius.constant,
          shader.ior.constant, shader.alpha.constant, shader.anisotropy.constant};
}

// Chandrasekhar's H of isotropic scattering, at grazing to straight directions: his integral equation, iterated.
double chandrasekhar_h(double albedo, double cosine) {
  constexpr int count = 400;
  std::array<double, count> h;
  h.fill(1);
  const auto node = [](int i) { return (i + 0.5) / count; };
  const auto value = [&](double mu) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += h[i] * node(i) / (mu + node(i)) / count;
    return 1 / (std::sqrt(1 - albedo) + albedo / 2 * sum);  // the form that converges for any albedo
  };
  for (int step = 0; step < 60; ++step) {
    std::array<double, count> next;
    for (int i = 0; i < count; ++i) next[i] = value(node(i));
    h = next;
  }
  return value(cosine);
}

TEST(Subsurface, thick_body_reflects_as_chandrasekhar_says) {
  // Not of skin, where half of the light enters in other directions.
  for (const SubsurfaceModel model : {SubsurfaceModel::chiang, SubsurfaceModel::van_de_hulst}) {
    const SubsurfaceShader shader = straight(model, {0.6f, 0.4f, 0.2f}, 0.01f);
    const SubsurfaceMedium medium = make_medium(lobe_of(shader));
    Color expected;
    for (std::size_t i = 0; i < 3; ++i) {
      const double albedo = medium.albedo[i];
      expected[i] = static_cast<float>(medium.weight[i] * (1 - std::sqrt(1 - albedo) * chandrasekhar_h(albedo, 1)));
    }
    Scene scene = furnace(1024);
    add_instance(scene, square(10, 0), add_material(scene, shader));
    SCOPED_TRACE(enum_names<SubsurfaceModel>[static_cast<std::size_t>(model)]);
    expect_radiance(scene, expected, 0.01f);
  }
}

// The share of light from straight above that a plate lets out again on any side.
MeanColor light_out_of_plate(const SubsurfaceShader& shader, float thickness) {
  Scene scene = furnace(1024);
  add_instance(scene, box({-1, -1, -thickness}, {1, 1, 0}), add_material(scene, shader));
  return render_mean(scene);
}

MeanColor light_out_of_volume(const SubsurfaceMedium& medium, float thickness) {
  const Color scattering = medium.extinction * medium.albedo;
  Material material;
  material.volume = material.add(VolumeShader{
      .absorption = medium.extinction - scattering, .scattering = scattering, .anisotropy = medium.anisotropy});
  Scene scene = furnace(1024);
  add_instance(scene, box({-1, -1, -thickness}, {1, 1, 0}), scene.materials.append(std::move(material)));
  return render_mean(scene);
}

TEST(Subsurface, thin_body_is_as_the_same_volume) {
  for (const auto& [anisotropy, tolerance] :
       {std::pair(0.0f, 0.01f), std::pair(0.5f, 0.015f), std::pair(-0.5f, 0.015f)}) {
    const SubsurfaceShader shader = straight(SubsurfaceModel::van_de_hulst, {0.95f, 0.6f, 0.3f}, 0.05f, anisotropy);
    const SubsurfaceMedium medium = make_medium(lobe_of(shader));
    for (const float thickness : {0.02f, 0.1f}) {
      SCOPED_TRACE(testing::Message() << "anisotropy " << anisotropy << ", thickness " << thickness);
      const Color ours = light_out_of_plate(shader, thickness).radiance;
      const Color volume = light_out_of_volume(medium, thickness).radiance * medium.weight;
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(ours[i], volume[i], tolerance * volume[i]) << "channel " << i;
    }
  }
}

TEST(Subsurface, nothing_is_lost_where_nothing_is_absorbed) {
  const SubsurfaceShader shader = straight(SubsurfaceModel::van_de_hulst, Color(1.0f), 0.2f);
  Scene scene = furnace(256);
  add_instance(scene, Sphere{.center = {0, 0, 0}, .radius = 1}, add_material(scene, shader));
  expect_radiance(scene, Color(1.0f), 0.01f);
}

TEST(Subsurface, other_objects_in_the_body_are_not_seen) {
  const SubsurfaceShader shader = straight(SubsurfaceModel::van_de_hulst, Color(0.8f), 0.2f);
  const auto make_scene = [&](bool has_core) {
    Scene scene = furnace(256);
    add_instance(scene, Sphere{.center = {0, 0, 0}, .radius = 1}, add_material(scene, shader));
    if (has_core)
      add_instance(scene, Sphere{.center = {0, 0, 0}, .radius = 0.8f}, add_material(scene, DiffuseShader{Color(0.0f)}));
    return scene;
  };
  const Color hollow = render_mean(make_scene(false)).radiance, full = render_mean(make_scene(true)).radiance;
  EXPECT_NEAR(full.x, hollow.x, 0.01f);
}

// Light is gathered where it comes out: a lamp that only lights the other side of a thin plate shines through.
TEST(Subsurface, light_from_behind_shines_through) {
  Scene scene = scene_from_above(256);
  add_instance(scene, box({-1, -1, -0.02f}, {1, 1, 0}),
               add_material(scene, straight(SubsurfaceModel::van_de_hulst, Color(0.9f), 0.05f)));
  scene.lights.append(PointLight{.position = {0, 0, -2}, .intensity = Color(10.0f)});
  EXPECT_GT(render_mean(scene).radiance.x, 0.05f);
}

TEST(Subsurface, light_is_filed_as_diffuse) {
  Scene scene = furnace(64);
  scene.settings.passes.enable(Pass::diffuse_direct);
  scene.settings.passes.enable(Pass::diffuse_indirect);
  scene.settings.passes.enable(Pass::diffuse_color);
  add_instance(scene, Sphere{.center = {0, 0, 0}, .radius = 1},
               add_material(scene, straight(SubsurfaceModel::chiang, {0.9f, 0.5f, 0.2f}, 0.1f)));
  Report report;
  const Film film = render(prepare(scene, report));
  const std::vector<float>&combined = film.values(Pass::combined), &direct = film.values(Pass::diffuse_direct),
        &indirect = film.values(Pass::diffuse_indirect), &color = film.values(Pass::diffuse_color);
  for (std::size_t pixel = 0; pixel < direct.size() / 3; ++pixel)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR((direct[3 * pixel + i] + indirect[3 * pixel + i]) * color[3 * pixel + i], combined[4 * pixel + i],
                  1e-4f);
  EXPECT_NEAR(color[0], 0.9f, 1e-3f);
}

// Unlike a mirror, which has none of its own.
TEST(Subsurface, denoisers_are_shown_its_colour) {
  Scene scene = furnace(16);
  for (const Pass pass : {Pass::denoising_albedo, Pass::denoising_normal, Pass::denoising_depth})
    scene.settings.passes.enable(pass);
  add_instance(scene, square(10, 0), add_material(scene, straight(SubsurfaceModel::chiang, {0.9f, 0.5f, 0.2f}, 0.1f)));
  Report report;
  const Film film = render(prepare(scene, report));
  const std::vector<float>& albedo = film.values(Pass::denoising_albedo);
  EXPECT_NEAR(albedo[0], 0.9f, 1e-3f);
  EXPECT_NEAR(albedo[1], 0.5f, 1e-3f);
  EXPECT_NEAR(film.values(Pass::denoising_normal)[2], -1, 1e-3f);  // towards the camera
  EXPECT_NEAR(film.values(Pass::denoising_depth)[0], 4, 1e-2f);
}

}  // namespace
}  // namespace basicrt
