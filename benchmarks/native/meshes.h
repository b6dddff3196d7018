// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes that benchmarks make themselves.
#pragma once

#include <cmath>
#include <random>

#include "geometry/mesh.h"
#include "math/constants.h"

namespace basicrt::benchmark {

// Calls point(u, v) on a grid over [0, 1]^2 and joins the points by triangles.
template <class Point>
void add_grid(Mesh& mesh, int columns, int rows, Point&& point) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.positions.push_back(
          point(static_cast<float>(i) / static_cast<float>(columns), static_cast<float>(j) / static_cast<float>(rows)));
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const std::uint32_t a = first + j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
}

// A box open towards +z with a finely tessellated sphere in it.
inline Mesh make_cornell(int detail) {
  Mesh mesh;
  add_grid(mesh, 1, 1, [](float u, float v) { return Vec3f{2 * u - 1, -1, 2 * v - 1}; });
  add_grid(mesh, 1, 1, [](float u, float v) { return Vec3f{2 * u - 1, 1, 2 * v - 1}; });
  add_grid(mesh, 1, 1, [](float u, float v) { return Vec3f{-1, 2 * u - 1, 2 * v - 1}; });
  add_grid(mesh, 1, 1, [](float u, float v) { return Vec3f{1, 2 * u - 1, 2 * v - 1}; });
  add_grid(mesh, 1, 1, [](float u, float v) { return Vec3f{2 * u - 1, 2 * v - 1, -1}; });
  add_grid(mesh, 2 * detail, detail, [](float u, float v) {
    const float longitude = 2 * pi * u, latitude = pi * v;
    return Vec3f{std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                 std::sin(latitude) * std::sin(longitude)} *
           0.5f;
  });
  return mesh;
}

inline Mesh make_terrain(int detail) {
  Mesh mesh;
  add_grid(mesh, detail, detail, [](float u, float v) {
    float height = 0;
    for (int octave = 0; octave < 6; ++octave) {
      const float frequency = static_cast<float>(3 << octave);
      height += std::sin(frequency * u + static_cast<float>(octave)) * std::cos(frequency * v) / frequency;
    }
    return Vec3f{2 * u - 1, height, 2 * v - 1};
  });
  return mesh;
}

inline Mesh make_soup(int count, float size = 0.02f) {
  Mesh mesh;
  std::mt19937 rng(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto vector = [&] { return Vec3f{uniform(rng), uniform(rng), uniform(rng)}; };
  for (int i = 0; i < count; ++i) {
    const Vec3f center = vector();
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(center + vector() * size);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// Turned columns, walls and beams of few large triangles, with finely tessellated balls among them.
inline Mesh make_hall(int detail) {
  Mesh mesh;
  std::mt19937 rng(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto add_beam = [&](Vec3f from, Vec3f to, float width, int sides) {
    const Vec3f along = normalize(to - from), across = normalize(cross(along, Vec3f{0.3f, 0.5f, 0.8f}));
    const Vec3f third = cross(along, across);
    add_grid(mesh, sides, 1, [&](float u, float v) {
      return from + (to - from) * v + (across * std::cos(2 * pi * u) + third * std::sin(2 * pi * u)) * width;
    });
  };
  for (int i = 0; i < detail * detail / 20; ++i) {
    const Vec3f from{uniform(rng), uniform(rng), uniform(rng)};
    const bool is_column = i % 3 == 0;
    const Vec3f turn{0.3f * uniform(rng), 1, 0.3f * uniform(rng)};
    const Vec3f to = is_column ? from + turn * 0.8f : from + Vec3f{uniform(rng), 0.2f * uniform(rng), uniform(rng)};
    add_beam(from, to, 0.004f + 0.01f * std::abs(uniform(rng)), 8);
  }
  for (int i = 0; i < 12; ++i) {
    const Vec3f center{uniform(rng), uniform(rng), uniform(rng)};
    add_grid(mesh, detail, detail / 2, [&](float u, float v) {
      const float longitude = 2 * pi * u, latitude = pi * v;
      return center + Vec3f{std::sin(latitude) * std::cos(longitude), std::cos(latitude),
                            std::sin(latitude) * std::sin(longitude)} *
                          0.1f;
    });
  }
  return mesh;
}

// Tufts of long thin triangles.
inline Mesh make_hair(int count) {
  Mesh mesh;
  std::mt19937 rng(9);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto vector = [&] { return Vec3f{uniform(rng), uniform(rng), uniform(rng)}; };
  constexpr int segments = 8;  // of a strand, two triangles each
  for (int strand = 0; 2 * segments * strand < count; ++strand) {
    Vec3f position = vector(), direction = vector() * 0.04f;
    const Vec3f width = vector() * 0.0005f;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i <= segments; ++i) {
      mesh.positions.push_back(position - width);
      mesh.positions.push_back(position + width);
      direction += vector() * 0.01f;
      position += direction;
    }
    for (std::uint32_t i = 0; i < segments; ++i) {
      const std::uint32_t a = first + 2 * i;
      mesh.triangles.push_back({a, a + 1, a + 2});
      mesh.triangles.push_back({a + 2, a + 1, a + 3});
    }
  }
  return mesh;
}

}  // namespace basicrt::benchmark
