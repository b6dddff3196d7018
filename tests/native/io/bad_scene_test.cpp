// SPDX-License-Identifier: GPL-3.0-or-later
// Scene files with one mistake each: the message names the place, the rule and what was there.
#include <gtest/gtest.h>

#include "io/scene_text.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

struct BadScene {
  const char* name;
  const char* json;
  const char* message;  // how it begins
};
void PrintTo(const BadScene& scene, std::ostream* stream) { *stream << scene.name; }

class BadSceneFile : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneFile, is_one_clear_error) {
  const std::string problem = load_problem_of(GetParam().json);
  EXPECT_TRUE(problem.starts_with(GetParam().message)) << problem;
  EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
}

const BadScene bad_scenes[] = {
    // Text that is no JSON: file, line and column.
    {"truncated", "{\n  \"film\": {\n", "test.json:3:1: syntax error"},
    {"malformed", "{\n  \"film\": {\"resolution\": [1 2]}\n}", "test.json:2:29: syntax error"},
    {"empty_file", "", "test.json:1:1: "},
    {"bad_utf8", "{\n \"\xff\": 1}", "test.json:2:3: "},
    {"huge_number", "{\n \"film\": {\"resolution\": [1e999, 1]}}", "test.json:2:26: number overflow"},
    {"not_an_object", "[]", "scene: must be an object, is an array of 0"},

    // Unknown names: the nearest that exists.
    {"unknown_root_key", R"({"flim": {}})", "flim: unknown key; did you mean \"film\"?"},
    {"unknown_shader_key", R"({"materials": {"glas": {"type": "glass", "etta": 2}}})",
     "materials.glas.etta: unknown key; did you mean \"eta\"?"},
    {"unknown_shader", R"({"materials": {"a": {"type": "difuse"}}})",
     "materials.a.type: unknown type \"difuse\"; did you mean \"diffuse\"?"},
    {"unknown_texture_type", R"({"textures": {"a": {"type": "constent"}}})",
     "textures.a.type: unknown type \"constent\"; did you mean \"constant\"?"},
    {"unknown_object", R"({"objects": [{"type": "spere"}]})",
     "objects[0].type: unknown type \"spere\"; did you mean \"sphere\"?"},
    {"unknown_light", R"({"lights": [{"type": "pont"}]})",
     "lights[0].type: unknown type \"pont\"; did you mean \"point\"?"},
    {"unknown_filter", R"({"film": {"filter": {"type": "gausian"}}})",
     "film.filter.type: unknown name \"gausian\"; did you mean \"gaussian\"?"},
    {"unknown_integrator", R"({"integrator": {"type": "pth"}})",
     "integrator.type: unknown integrator \"pth\"; did you mean \"path\"?"},
    {"unknown_pass", R"({"settings": {"passes": ["depth"]}})",
     "settings.passes[0]: unknown pass \"depth\"; did you mean \"Depth\"?"},
    {"unknown_material",
     R"({"materials": {"glass": {"type": "glass"}}, "objects": [{"type": "sphere", "material_name": "glas"}]})",
     "objects[0].material_name: no material is named \"glas\"; did you mean \"glass\"?"},
    {"unknown_texture", R"({"materials": {"a": {"type": "diffuse", "texture_name": "b"}}})",
     "materials.a.texture_name: no texture is named \"b\"; there are none"},
    {"unknown_shape", R"({"objects": [{"shape": "ball"}]})", "objects[0].shape: no shape is named \"ball\""},
    {"material_of_itself", R"({"materials": {"a": {"type": "mix", "first": "a"}}})",
     "materials.a.first: no material is named \"a\""},
    {"sphere_with_a_path", R"({"objects": [{"type": "sphere", "path": "a.obj"}]})", "objects[0].path: unknown key"},

    // Values of another type.
    {"string_for_number", R"({"objects": [{"type": "sphere", "radius": "1"}]})",
     "objects[0].radius: must be a number, is a string"},
    {"object_for_array", R"({"objects": {}})", "objects: must be an array, is an object"},
    {"array_for_object", R"({"materials": []})", "materials: must be an object, is an array of 0"},
    {"short_vector", R"({"objects": [{"type": "sphere", "center": [1, 2]}]})",
     "objects[0].center: must be an array of 3 numbers, is an array of 2"},
    {"fraction_for_integer", R"({"integrator": {"type": "path", "spp": 1.5}})",
     "integrator.spp: must be an integer, is 1.5"},
    {"number_for_bool", R"({"materials": {"a": {"type": "diffuse", "twosided": 1}}})",
     "materials.a.twosided: must be true or false, is 1"},
    {"null_for_string", R"({"objects": [{"type": null}]})", "objects[0].type: must be a string, is null"},
    {"missing_type", R"({"objects": [{}]})", "objects[0]: \"type\" is missing"},
    {"missing_radiance", R"({"objects": [{"type": "sphere", "light": {"type": "area"}}]})",
     "objects[0].light: \"radiance\" is missing"},
    {"two_materials",
     R"({"materials": {"a": {"type": "glass"}}, "objects": [{"type": "sphere", "material_name": "a", "materials": ["a"]}]})",
     "objects[0].material_name: give this or"},

    // Numbers that make no picture.
    {"zero_resolution", R"({"film": {"resolution": [0, 100]}})", "film.resolution[0]: must be in [1, 65536], is 0"},
    {"negative_resolution", R"({"film": {"resolution": [100, -5]}})",
     "film.resolution[1]: must be in [1, 65536], is -5"},
    {"huge_resolution", R"({"film": {"resolution": [1000000000, 1]}})",
     "film.resolution[0]: must be in [1, 65536], is 1000000000"},
    {"integer_overflow", R"({"film": {"resolution": [99999999999, 1]}})", "film.resolution[0]: must be in ["},
    {"unsigned_overflow", R"({"settings": {"seed": 18446744073709551615}})", "settings.seed: must be in ["},
    {"float_overflow", R"({"objects": [{"type": "sphere", "radius": 1e39}]})",
     "objects[0].radius: must be a number that a 32-bit float can hold, is 1e+39"},
    {"zero_spp", R"({"integrator": {"type": "path", "spp": 0}})", "integrator.spp: must be in [1, 16777216], is 0"},
    {"zero_depth", R"({"integrator": {"type": "path", "max_depth": 0}})", "integrator.max_depth: must be in [1, 1024]"},
    {"roughness", R"({"materials": {"a": {"type": "glossy", "roughness": 1.5}}})",
     "materials.a.roughness: must be in [0, 1], is 1.5"},
    {"nested_roughness", R"({"materials": {"a": {"type": "mix", "second": {"type": "glossy", "roughness": -1}}}})",
     "materials.a.second.roughness: must be in [0, 1], is -1"},
    {"negative_radiance", R"({"objects": [{"type": "sphere", "light": {"type": "area", "radiance": [1, -1, 1]}}]})",
     "objects[0].light.radiance: must be at least 0, is -1"},
    {"zero_radius", R"({"objects": [{"type": "sphere", "radius": 0}]})", "objects[0].radius: must be above 0, is 0"},
    {"camera_in_its_target", R"({"camera": {"position": [1, 2, 3], "look_at": [1, 2, 3], "fov": 30}})",
     "camera.look_at: must differ from position"},
    {"camera_along_up", R"({"camera": {"position": [0, 0, 0], "look_at": [0, 2, 0], "fov": 30}})",
     "camera: ref_up must not be parallel"},
    {"half_turn_of_view", R"({"camera": {"position": [0, 0, 0], "look_at": [1, 0, 0], "fov": 180}})",
     "camera.fov: must be between 0 and 180 degrees, is 180"},
    {"projective_motion",
     R"({"objects": [{"type": "sphere", "motion_transforms": [[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]]}]})",
     "objects[0].motion_transforms[0]: "},
    {"motion_of_too_few_vertices",
     R"({"objects": [{"type": "mesh", "positions": [0,0,0,1,0,0,0,1,0], "triangles": [0,1,2], "motion_positions": [[0,0,0]]}]})",
     "objects[0].motion_positions[0]: has 1 vectors, but at time 0 there are 3"},
    {"motion_of_an_obj", R"({"objects": [{"type": "mesh", "path": "a.obj", "motion_positions": []}]})",
     "objects[0].path: give this or \"motion_positions\", not both"},
    {"adjacent_positions_of_too_few_vertices",
     R"({"objects": [{"type": "mesh", "positions": [0,0,0,1,0,0,0,1,0], "triangles": [0,1,2], "adjacent_positions": [[0,0,0], [0,0,0]]}]})",
     "objects[0].adjacent_positions[0]: has 1 vectors, but there are 3 positions"},
    {"adjacent_positions_of_one_frame",
     R"({"objects": [{"type": "mesh", "positions": [0,0,0,1,0,0,0,1,0], "triangles": [0,1,2], "adjacent_positions": [[0,0,0,1,0,0,0,1,0]]}]})",
     "objects[0].adjacent_positions: must be those of two frames"},
    {"shutter_that_is_negative", R"({"settings": {"shutter_curve": [1, -1]}})",
     "settings.shutter_curve: must be at least 0, is -1"},
    {"projective_transform", R"({"objects": [{"type": "sphere", "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]}]})",
     "objects[0].transform: the last row must be 0 0 0 1"},

    // Meshes.
    {"index_out_of_range",
     R"({"objects": [{"type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0], "triangles": [0, 1, 3]}]})", "objects[0]"},
    {"negative_index",
     R"({"objects": [{"type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0], "triangles": [0, 1, -1]}]})",
     "objects[0].triangles[2]: must be in [0, 4294967295], is -1"},
    {"odd_positions", R"({"objects": [{"type": "mesh", "positions": [0,0,0,1], "triangles": []}]})",
     "objects[0].positions: must have a multiple of 3 numbers, has 4"},
    {"null_position", R"({"objects": [{"type": "mesh", "positions": [0,0,null], "triangles": []}]})",
     "objects[0].positions[2]: must be a number, is null"},
    {"few_normals",
     R"({"objects": [{"type": "mesh", "positions": [0,0,0, 1,0,0, 0,1,0], "triangles": [0,1,2], "corner_normals": [0,0,1]}]})",
     "objects[0]"},
    {"two_meshes_in_one", R"({"objects": [{"type": "mesh", "path": "a.obj", "positions": [], "triangles": []}]})",
     "objects[0].path: give this or \"positions\", not both"},
    {"missing_obj", R"({"objects": [{"type": "mesh", "path": "no/such/file.obj"}]})",
     "no/such/file.obj: can't be opened: No such file or directory"},
    {"few_pixels", R"({"textures": {"a": {"type": "image", "width": 2, "height": 2, "channels": 3, "pixels": [1]}}})",
     "textures.a.pixels: must be an array of width x height x channels numbers, is an array of 1"},
    {"large_byte", R"({"images": {"a": {"width": 1, "height": 1, "channels": 1, "bytes": [256]}}})",
     "images.a.bytes: must be in [0, 255], is 256"},
    {"unknown_image", R"({"textures": {"a": {"type": "image", "image": "b"}}})",
     "textures.a.image: no image is named \"b\""},
    {"two_images", R"({"images": {"b": {"width": 1, "height": 1, "channels": 1, "bytes": [1]}},
                      "textures": {"a": {"type": "image", "image": "b", "path": "c.png"}}})",
     "textures.a.path: give this or \"image\", not both"},
    {"dark_layer", R"({"environment": {"layers": [{"radiance": [1, -1, 1]}]}})",
     "environment.layers[0].radiance: must be at least 0, is -1"},
    {"node_after", R"({"materials": {"a": {"nodes": [{"type": "mix", "first": 1}, {"type": "glass"}], "surface": 0}}})",
     "materials.a.nodes[0].first: no node 1 comes before this"},
};
INSTANTIATE_TEST_SUITE_P(Each, BadSceneFile, testing::ValuesIn(bad_scenes),
                         [](const auto& scene) { return scene.param.name; });

TEST(BadScene, nesting_without_end_is_refused_before_anything_recurses) {
  const std::string open = R"({"type": "mix", "first": )";
  std::string json = R"({"materials": {"a": )";
  for (int i = 0; i < 100000; ++i) json += open;
  EXPECT_NE(load_problem_of(json).find("nested more than 200 deep"), std::string::npos);
  EXPECT_NE(load_problem_of(std::string(1000000, '[')).find("nested more than 200 deep"), std::string::npos);
}

TEST(BadScene, an_override_that_is_no_json_is_told_from_the_file) {
  Report report;
  EXPECT_TRUE(error_of([&] {
                (void)parse_scene("{}", ".", "test.json", report, {.override_json = "{"});
              }).starts_with("override:1:"));
}

TEST(BadScene, an_empty_scene_loads_with_a_warning) {
  Report report;
  const Scene scene = scene_of("{}", report);
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_EQ(report.warnings(), std::vector<std::string>{"objects: the scene has none"});
}

TEST(BadScene, an_object_without_triangles_is_skipped_with_a_warning) {
  const TemporaryFolder folder;
  folder.write("empty.obj", "v 0 0 0\n");
  const auto path =
      folder.write("scene.json", R"({"objects": [{"type": "mesh", "path": "empty.obj"}, {"type": "sphere"}]})");
  Report report;
  EXPECT_EQ(load_scene(path, report).instances.size(), 1u);
  EXPECT_EQ(report.warnings(), std::vector<std::string>{"objects[0]: skipped: the mesh has no triangles"});
}

TEST(BadScene, a_file_cut_short_anywhere_is_an_error_or_a_scene) {
  const std::filesystem::path path = std::filesystem::path(BASICRT_SOURCE_DIR) / "scenes/materials/scene.json";
  std::ifstream stream(path);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_GT(text.size(), 100u);
  for (std::size_t length = 0; length + 2 < text.size(); length += 7)
    EXPECT_TRUE(load_problem_of(std::string_view(text).substr(0, length)).starts_with("test.json:")) << length;
}

}  // namespace
}  // namespace basicrt
