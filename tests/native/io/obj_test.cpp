// SPDX-License-Identifier: GPL-3.0-or-later
// OBJ files, good and bad.
#include "io/obj.h"

#include <gtest/gtest.h>

#include "error_of.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

const std::string square =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

class ObjFile : public testing::Test {
 protected:
  Mesh read(const std::string& text) { return read_obj(folder_.write("mesh.obj", text), report_); }
  std::string problem_of(const std::string& text) {
    const std::string message = error_of([&] { (void)read(text); });
    const std::string name = (folder_.path() / "mesh.obj").string();
    EXPECT_TRUE(message.empty() || message.starts_with(name)) << message;
    return message.empty() ? message : message.substr(name.size());
  }
  static Vec3f normal(const Mesh& mesh, std::uint32_t triangle) {
    const Vec3f p0 = mesh.position(triangle, 0);
    return cross(mesh.position(triangle, 1) - p0, mesh.position(triangle, 2) - p0);
  }

  TemporaryFolder folder_;
  Report report_;
};

TEST_F(ObjFile, polygons_become_triangles_that_cover_the_same_area) {
  const Mesh mesh = read(square + "f 1/1 2/2 3/3 4/4\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_FLOAT_EQ(normal(mesh, 0).z / 2 + normal(mesh, 1).z / 2, 1);
  ASSERT_EQ(mesh.uvs.size(), 6u);
  for (std::uint32_t corner = 0; corner < 6; ++corner) {  // in this file a corner's uv is its place
    const Vec3f position = mesh.position(corner / 3, static_cast<int>(corner % 3));
    EXPECT_EQ(mesh.uvs[corner], Vec2f(position.x, position.y));
  }
}

TEST_F(ObjFile, a_concave_polygon_is_not_filled_in) {
  // An arrow head: the square without the triangle below its centre.
  const Mesh mesh = read("v 0 0 0\nv 0.5 0.5 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4 5\n");
  float area = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    EXPECT_GT(normal(mesh, i).z, 0);
    area += normal(mesh, i).z / 2;
  }
  EXPECT_FLOAT_EQ(area, 0.75f);
}

TEST_F(ObjFile, faces_are_wound_to_agree_with_their_normals) {
  const Mesh mesh = read(square + "vn 0 0 -1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/1/2 3/3/2 4/4/2\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_LT(normal(mesh, 0).z, 0);
  EXPECT_GT(normal(mesh, 1).z, 0);
  EXPECT_EQ(mesh.corner_normals[0], Vec3f(0, 0, -1));
  EXPECT_EQ(mesh.uvs[1], Vec2f(1, 1)) << "the uvs follow their corners";
  EXPECT_EQ(mesh.position(0, 1), Vec3f(1, 1, 0));
}

TEST_F(ObjFile, without_normals_the_winding_stays) { EXPECT_LT(normal(read(square + "f 1 3 2\n"), 0).z, 0); }

TEST_F(ObjFile, normals_and_uvs_are_kept_only_where_every_corner_has_them) {
  const Mesh mesh = read(square + "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1 3 4\n");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_TRUE(mesh.corner_normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
}

TEST_F(ObjFile, indices_may_count_from_the_end_and_lines_end_as_on_windows) {
  const Mesh mesh = read("v 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nf -3 -2 -1\r\n");
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}}));
}

TEST_F(ObjFile, a_missing_file_is_named) {
  const auto path = folder_.path() / "none.obj";
  EXPECT_EQ(error_of([&] { (void)read_obj(path, report_); }),
            path.string() + ": can't be opened: No such file or directory");
}

TEST_F(ObjFile, an_index_out_of_range_is_named) {
  EXPECT_EQ(problem_of(square + "f 1 2 9\n"), ": a face refers to vertex 9, but there are 4");
  EXPECT_EQ(problem_of(square + "f 1 2 3 4 9 2\n"), ": a face refers to vertex 9, but there are 4");
  EXPECT_EQ(problem_of(square + "f 1/1 2/2 3/7\n"), ": a face refers to texture coordinate 7, but there are 4");
  EXPECT_EQ(problem_of(square + "f 1//1 2//1 3//1\n"), ": a face refers to normal 1, but there are 0");
  EXPECT_EQ(problem_of(square + "f 1 2 -9\n"), ": a face refers to vertex -9, but there are 4");
  EXPECT_EQ(problem_of(square + "f 1 2 -2000000000 4\n"), ": a face refers to vertex -2000000000, but there are 4");
  EXPECT_EQ(problem_of(square + "f 1 2 0\n"), ": a face refers to vertex 0, but there are 4");
}

TEST_F(ObjFile, a_number_that_is_none_is_named_with_its_line) {
  EXPECT_EQ(problem_of("v 0 0 0\nv 1 nan 0\nv 1 1 0\nf 1 2 3\n"), ":2: \"nan\" is not a finite number");
  EXPECT_EQ(problem_of("v 0 0 0\nv 1 0 inf\nv 1 1 0\nf 1 2 3\n"), ":2: \"inf\" is not a finite number");
  EXPECT_EQ(problem_of("v 0 0 0\nv 1 0 x\nv 1 1 0\nf 1 2 3\n"), ":2: \"x\" is not a finite number");
  EXPECT_EQ(problem_of("v 0 0 0\nv 1 0\nv 1 1 0\nf 1 2 3\n"), ":2: v needs 3 numbers");
}

TEST_F(ObjFile, a_number_too_large_for_a_float_is_refused) {
  EXPECT_NE(problem_of("v 0 0 0\nv 1e999 0 0\nv 1 1 0\nf 1 2 3\n"), "");
  EXPECT_NE(problem_of("v 0 0 0\nv 1e39 0 0\nv 1 1 0\nf 1 2 3\n"), "");
}

TEST_F(ObjFile, a_file_without_faces_is_empty) {
  EXPECT_TRUE(read("v 0 0 0\n").triangles.empty());
  EXPECT_TRUE(read("").triangles.empty());
}

TEST_F(ObjFile, bytes_that_are_no_text_are_survived) {
  std::string bytes;
  for (int i = 0; i < 4096; ++i) bytes.push_back(static_cast<char>((i * 131) % 256));
  (void)problem_of(bytes);
  (void)problem_of("f\nf 1\nf 1 2\nv\nvn\nvt\ng\no\nusemtl\nmtllib\n");
}

}  // namespace
}  // namespace basicrt
