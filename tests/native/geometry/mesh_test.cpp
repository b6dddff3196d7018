// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes say what is wrong with them, and lose only the triangles that can't be hit.
#include "geometry/mesh.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "base/error.h"
#include "geometry/shape.h"

namespace basicrt {
namespace {

Mesh two_triangles() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.corner_normals.assign(6, {0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  mesh.material_slots = {0, 1};
  return mesh;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(Mesh, bounds_hold_the_vertices_that_are_used) {
  Mesh mesh = two_triangles();
  mesh.positions.push_back({100, 100, 100});  // by no triangle
  const Bounds3f box = bounds(mesh);
  EXPECT_EQ(box.lower, Vec3f(0, 0, 0));
  EXPECT_EQ(box.upper, Vec3f(1, 1, 2));
  EXPECT_TRUE(bounds(Mesh{}).is_empty());
}

TEST(Mesh, sound_meshes_pass) {
  EXPECT_NO_THROW(validate(two_triangles(), "m"));
  EXPECT_NO_THROW(validate(Mesh{}, "m"));
}

TEST(Mesh, a_fault_is_named_with_its_item_and_value) {
  const auto fault = [](const std::function<void(Mesh&)>& damage) {
    Mesh mesh = two_triangles();
    damage(mesh);
    return message_of([&] { validate(mesh, "shapes[2]"); });
  };
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(fault([](Mesh& m) { m.triangles[1][2] = 9; }),
            "shapes[2].triangles[1]: index 9, but the mesh has 4 positions");
  EXPECT_EQ(fault([](Mesh& m) { m.corner_normals.pop_back(); }),
            "shapes[2].corner_normals: must have three for each triangle (6) or none, has 5");
  EXPECT_EQ(fault([](Mesh& m) { m.uvs.resize(7); }),
            "shapes[2].uvs: must have three for each triangle (6) or none, has 7");
  EXPECT_EQ(fault([](Mesh& m) { m.material_slots.resize(1); }),
            "shapes[2].material_slots: must have one for each triangle (2) or none, has 1");
  EXPECT_EQ(fault([&](Mesh& m) { m.positions[3].y = nan; }),
            "shapes[2].positions[3]: must be finite, is NaN or infinite");
  EXPECT_EQ(fault([&](Mesh& m) { m.corner_normals[4].z = -inf; }),
            "shapes[2].corner_normals[4]: must be finite, is NaN or infinite");
  EXPECT_EQ(fault([&](Mesh& m) { m.uvs[5].x = inf; }), "shapes[2].uvs[5]: must be finite, is NaN or infinite");
}

TEST(Mesh, triangles_without_area_go_and_the_others_keep_their_data) {
  Mesh mesh = two_triangles();
  mesh.triangles.insert(mesh.triangles.begin() + 1, {2, 2, 3});
  mesh.corner_normals.insert(mesh.corner_normals.begin() + 3, 3, {1, 0, 0});
  mesh.uvs.insert(mesh.uvs.begin() + 3, 3, {7, 7});
  mesh.material_slots.insert(mesh.material_slots.begin() + 1, 9);
  Report report;
  const Mesh cleaned = remove_degenerate_triangles(mesh, "shapes[0]", report);
  const Mesh expected = two_triangles();
  EXPECT_EQ(cleaned.triangles, expected.triangles);
  EXPECT_EQ(cleaned.corner_normals, expected.corner_normals);
  EXPECT_EQ(cleaned.uvs, expected.uvs);
  EXPECT_EQ(cleaned.material_slots, expected.material_slots);
  ASSERT_EQ(report.warnings().size(), 1u);
  EXPECT_EQ(report.warnings()[0], "shapes[0]: 1 of 3 triangles have no area and are left out");
}

TEST(Mesh, corners_on_a_line_have_no_area_but_slivers_and_tiny_triangles_do) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {2, 4, 6}, {3, 6, 9}, {1, 0, 0}, {0.5f, 1e-7f, 0}, {1e-40f, 0, 0}, {0, 1e-40f, 1e-40f}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}, {0, 5, 6}};  // on a line, a sliver, tiny
  Report report;
  const Mesh cleaned = remove_degenerate_triangles(mesh, "m", report);
  ASSERT_EQ(cleaned.triangles.size(), 2u);
  EXPECT_EQ(cleaned.triangles[0], mesh.triangles[1]);
  EXPECT_EQ(cleaned.triangles[1], mesh.triangles[2]);
}

TEST(Mesh, a_mesh_without_degenerate_triangles_gives_no_warning) {
  Report report;
  EXPECT_EQ(remove_degenerate_triangles(two_triangles(), "m", report).triangles.size(), 2u);
  EXPECT_TRUE(report.warnings().empty());
}

TEST(Shape, a_sphere_needs_a_finite_centre_and_a_positive_radius) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NO_THROW(validate(Shape(Sphere{{1, 2, 3}, 4}), "s"));
  EXPECT_EQ(message_of([&] { validate(Shape(Sphere{{1, nan, 3}, 4}), "shapes[1]"); }),
            "shapes[1].center: must be finite, is NaN or infinite");
  for (const float radius : {0.0f, -1.0f, nan, std::numeric_limits<float>::infinity()})
    EXPECT_NE(message_of([&] { validate(Shape(Sphere{{}, radius}), "shapes[1]"); }).find("shapes[1].radius: must be"),
              std::string::npos);
}

TEST(Shape, a_sphere_is_inside_its_bounds) {
  const Bounds3f box = bounds(Shape(Sphere{{1000.1f, 0, -3}, 0.1f}));
  EXPECT_LT(double{box.lower.x}, double{1000.1f} - double{0.1f});
  EXPECT_GT(double{box.upper.x}, double{1000.1f} + double{0.1f});
  EXPECT_LT(box.extent().x, 0.2002f);
}

}  // namespace
}  // namespace basicrt
