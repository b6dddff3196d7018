// SPDX-License-Identifier: GPL-3.0-or-later
// Small scenes of known radiance, and the mean of their picture.
#pragma once

#include <gtest/gtest.h>

#include "render/session.h"

namespace basicrt {

inline Mesh square(float half_size, float z) {
  Mesh mesh;
  mesh.positions = {
      {-half_size, -half_size, z}, {half_size, -half_size, z}, {half_size, half_size, z}, {-half_size, half_size, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Normals outwards.
inline Mesh box(Vec3f lower, Vec3f upper) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.push_back(
        {(corner & 1) ? upper.x : lower.x, (corner & 2) ? upper.y : lower.y, (corner & 4) ? upper.z : lower.z});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

inline Id<Material> add_material(Scene& scene, ShaderNode node) {
  Material material;
  material.surface = material.add(std::move(node));
  return scene.materials.append(std::move(material));
}

inline void add_instance(Scene& scene, Shape shape, Id<Material> material) {
  scene.instances.append(
      {.name = "", .shape = scene.shapes.append(std::move(shape)), .object_to_world = {}, .materials = {material}});
}

// A few pixels that look straight down on the origin from z = 4.
inline Scene scene_from_above(int samples) {
  Scene scene;
  PerspectiveCamera camera;
  camera.to_world.rows[2][3] = 4;
  camera.window_min = {-1e-3f, -1e-3f};
  camera.window_max = {1e-3f, 1e-3f};
  scene.camera = camera;
  scene.settings.width = scene.settings.height = 8;
  scene.settings.samples = samples;
  scene.settings.passes.enable(Pass::depth);
  return scene;
}

struct MeanColor {
  Color radiance{0.0f};
  float alpha = 0;
};

inline MeanColor render_mean(const Scene& scene) {
  Report report;
  const Film film = render(prepare(scene, report));
  MeanColor mean;
  const std::vector<float>& combined = film.values(Pass::combined);
  const float scale = 4.0f / static_cast<float>(combined.size());
  for (std::size_t i = 0; i < combined.size(); i += 4) {
    mean.radiance += Color(combined[i], combined[i + 1], combined[i + 2]) * scale;
    mean.alpha += combined[i + 3] * scale;
  }
  return mean;
}

inline void expect_radiance(const Scene& scene, Color expected, float relative) {
  const Color mean = render_mean(scene).radiance;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(mean[i], expected[i], relative * expected[i] + 1e-7f) << "channel " << i;
}

}  // namespace basicrt
