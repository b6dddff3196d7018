// SPDX-License-Identifier: GPL-3.0-or-later
// What the benchmark of rays traces: each scene fills about [-1, 1]^3 around the origin, open or seen through towards +z.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bvh/tracer.h"
#include "geometry/shape.h"
#include "io/obj.h"
#include "meshes.h"

namespace basicrt::benchmark {

struct BenchmarkScene {
  std::string name;
  std::vector<Shape> shapes;  // meshes, all of them
  std::vector<TracedInstance> instances;

  [[nodiscard]] double triangle_count() const {  // as rays see them
    double count = 0;
    for (const TracedInstance& instance : instances)
      count += static_cast<double>(std::get<Mesh>(shapes[instance.shape]).triangles.size());
    return count;
  }
};

inline BenchmarkScene scene_of(std::string name, Mesh mesh) {
  BenchmarkScene scene{.name = std::move(name), .shapes = {}, .instances = {TracedInstance{}}};
  scene.shapes.emplace_back(std::move(mesh));
  return scene;
}

// A ball with bumps, of 4 detail^2 triangles.
inline Mesh make_pebble(int detail) {
  Mesh mesh;
  add_grid(mesh, 2 * detail, detail, [](float u, float v) {
    const float longitude = 2 * pi * u, latitude = pi * v;
    const float radius = 1 + 0.2f * std::sin(5 * longitude) * std::sin(7 * latitude);
    return Vec3f{std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                 std::sin(latitude) * std::sin(longitude)} *
           radius;
  });
  return mesh;
}

// Turned by any rotation (from a random unit quaternion), scaled and moved.
inline TransformD random_placement(std::mt19937& rng, Vec3d position, double size) {
  std::normal_distribution<double> normal;
  double w = normal(rng), x = normal(rng), y = normal(rng), z = normal(rng);
  const double scale = 1 / std::sqrt(w * w + x * x + y * y + z * z);
  w *= scale, x *= scale, y *= scale, z *= scale;
  TransformD result({{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 0},
                      {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 0},
                      {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), 0}}});
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result.rows[i][j] *= size;
    result.rows[i][3] = position[i];
  }
  return result;
}

// Pebbles strewn over hills, so close that most touch their neighbours.
inline BenchmarkScene make_instances(int count, int detail) {
  BenchmarkScene scene = scene_of("instances", make_pebble(detail));
  scene.instances.clear();
  std::mt19937 rng(13);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double spacing = 2 / std::sqrt(static_cast<double>(count));
  for (int i = 0; i < count; ++i) {
    const double x = uniform(rng), z = uniform(rng);
    const double height = 0.2 * std::sin(5 * x) * std::cos(4 * z) - 0.2;
    const double size = spacing * (0.6 + 0.3 * uniform(rng));
    TracedInstance instance{.object_to_world = random_placement(rng, {x, height, z}, size)};
    instance.world_to_object = inverse(instance.object_to_world);
    scene.instances.push_back(instance);
  }
  return scene;
}

// From a file, moved and scaled to fill [-1, 1]^3 along its longest axis.
inline BenchmarkScene read_obj_scene(const std::filesystem::path& path) {
  Report report;
  Mesh mesh = read_obj(path, report);
  const Bounds3f box = bounds(mesh);
  const float scale = 2 / max_component(box.extent());
  for (Vec3f& position : mesh.positions) position = (position - box.center()) * scale;
  return scene_of(path.stem().string(), std::move(mesh));
}

struct SceneMaker {
  std::string name;
  std::function<BenchmarkScene()> make;
};

// One after the other, so that no more than one is in memory.
inline std::vector<SceneMaker> scene_makers(bool is_small) {
  const auto mesh = [](const char* name, Mesh (*make)(int), int detail) {
    return SceneMaker{name, [=] { return scene_of(name, make(detail)); }};
  };
  const auto soup = [](int count) { return make_soup(count); };
  const auto overlap = [](int count) { return make_soup(count, 0.2f); };
  return {mesh("cornell", make_cornell, is_small ? 32 : 380),
          mesh("terrain", make_terrain, is_small ? 64 : 707),
          mesh("soup", soup, is_small ? 10000 : 1000000),
          mesh("overlap", overlap, is_small ? 2000 : 200000),
          mesh("hall", make_hall, is_small ? 30 : 220),
          mesh("hair", make_hair, is_small ? 10000 : 1000000),
          {"instances", [=] { return is_small ? make_instances(500, 7) : make_instances(50000, 71); }}};
}

}  // namespace basicrt::benchmark
