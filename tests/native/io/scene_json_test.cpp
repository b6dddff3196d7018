// SPDX-License-Identifier: GPL-3.0-or-later
// What scene files mean.
#include "io/scene_json.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "io/scene_text.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

const std::filesystem::path source_dir = BASICRT_SOURCE_DIR;

Color emission_of(const Scene& scene, std::uint32_t instance) {
  const Material& material = scene.materials[scene.instances[instance].materials.at(0)];
  for (const ShaderNode& node : material.nodes)
    if (const auto* emission = std::get_if<EmissionShader>(&node)) return emission->radiance.constant;
  return Color(0.0f);
}

TEST(SceneJson, every_scene_of_the_assignment_loads_unmodified) {
  const std::filesystem::path folder = source_dir / "../shared/seed";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the assignment's scenes are not here";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    ++count;
    Report report;
    const Scene scene = load_scene(entry.path(), report);
    validate(scene);
    EXPECT_FALSE(scene.instances.empty()) << entry.path();
    for (const std::string& warning : report.warnings())
      EXPECT_EQ(warning, "integrator: there is no \"bdpt\" yet: the scene is rendered with \"path\"") << entry.path();
  }
  EXPECT_GT(count, 0);
}

TEST(SceneJson, our_copy_of_the_assignment_s_scene_has_its_values) {
  const std::filesystem::path seed = source_dir / "../shared/seed/cbox_no_light_refract.json";
  if (!std::filesystem::exists(seed)) GTEST_SKIP() << "the assignment's scenes are not here";
  Report report;
  const Scene theirs = load_scene(seed, report);
  const Scene ours = load_scene(source_dir / "scenes/cbox_no_light_refract/scene.json", report);
  ASSERT_EQ(ours.shapes.size(), theirs.shapes.size());
  for (std::uint32_t i = 0; i < ours.shapes.size(); ++i)
    EXPECT_EQ(std::get<Mesh>(ours.shapes[i]).positions, std::get<Mesh>(theirs.shapes[i]).positions) << i;
  ASSERT_EQ(ours.instances.size(), theirs.instances.size());
  for (std::uint32_t i = 0; i < ours.instances.size(); ++i) {
    EXPECT_EQ(ours.instances[i].object_to_world, theirs.instances[i].object_to_world) << i;
    EXPECT_EQ(ours.instances[i].materials, theirs.instances[i].materials) << i;
  }
  EXPECT_EQ(std::get<PerspectiveCamera>(*ours.camera).to_world, std::get<PerspectiveCamera>(*theirs.camera).to_world);
  EXPECT_EQ(ours.settings.samples, theirs.settings.samples);
  EXPECT_EQ(ours.settings.point_light_position, theirs.settings.point_light_position);
  EXPECT_EQ(ours.settings.point_light_flux, theirs.settings.point_light_flux);
}

TEST(SceneJson, every_scene_of_ours_loads_without_a_warning) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir / "scenes")) {
    const std::filesystem::path path = entry.path() / "scene.json";
    if (!std::filesystem::exists(path)) continue;
    ++count;
    Report report;
    validate(load_scene(path, report));
    EXPECT_TRUE(report.warnings().empty()) << path;
  }
  EXPECT_GE(count, 3);
}

TEST(SceneJson, the_camera_looks_from_position_to_look_at_with_a_vertical_field_of_view) {
  const Scene scene = scene_of(R"({
    "film": {"resolution": [200, 100]},
    "camera": {"position": [0, 1, 6], "look_at": [0, 1, 0], "ref_up": [0, 1, 0], "fov": 90, "focal_length": 2}})");
  const auto& camera = std::get<PerspectiveCamera>(*scene.camera);
  EXPECT_EQ(camera.to_world.column(3), Vec3f(0, 1, 6));
  EXPECT_NEAR(length(camera.to_world.vector(Vec3f(0, 0, -1)) - Vec3f(0, 0, -1)), 0, 1e-6);
  EXPECT_NEAR(camera.window_max.y, 1, 1e-6);  // tan 45 degrees
  EXPECT_NEAR(camera.window_max.x, 2, 1e-6);
}

TEST(SceneJson, objects_are_transformed_and_then_translated) {
  const Scene scene = scene_of(R"({"objects": [{"type": "sphere",
    "transform": [2, 0, 0, 10,  0, 3, 0, 20,  0, 0, 4, 30,  0, 0, 0, 1], "translate": [1, 2, 3]}]})");
  EXPECT_EQ(scene.instances[0].object_to_world.point(Vec3f(1, 1, 1)), Vec3f(13, 25, 37));
}

TEST(SceneJson, textures_are_found_by_texture_name_or_in_place_of_a_colour) {
  const Scene scene = scene_of(R"({
    "textures": {"grey": {"type": "constant", "color": [0.5, 0.5, 0.5]},
                 "board": {"type": "checkerboard", "color0": [0, 0, 0], "color1": [1, 1, 1],
                           "tex_coordinate_generator": {"type": "uvmapping2d", "scale": [4, 2], "delta": [0.5, 0]}}},
    "materials": {"a": {"type": "diffuse", "texture_name": "grey"},
                  "b": {"type": "roughconductor", "texture_name": "board"},
                  "c": {"type": "glass", "T": "board"},
                  "d": {"type": "diffuse", "color": [0.1, 0.2, 0.3]}}})");
  EXPECT_EQ(std::get<DiffuseShader>(scene.materials[0].nodes[0]).color.texture, Id<Texture>{0});
  EXPECT_EQ(std::get<ConductorShader>(scene.materials[1].nodes[0]).color.texture, Id<Texture>{1});
  EXPECT_EQ(std::get<GlassShader>(scene.materials[2].nodes[0]).transmit_color.texture, Id<Texture>{1});
  EXPECT_FALSE(std::get<GlassShader>(scene.materials[2].nodes[0]).reflect_color.texture.is_valid());
  EXPECT_EQ(std::get<DiffuseShader>(scene.materials[3].nodes[0]).color.constant, Color(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(std::get<CheckerboardTexture>(scene.textures[1]).scale, Vec2f(4, 2));
  EXPECT_EQ(std::get<CheckerboardTexture>(scene.textures[1]).delta, Vec2f(0.5f, 0));
}

TEST(SceneJson, the_assignment_s_defaults_hold) {
  const Scene scene = scene_of(R"({"integrator": {"type": "intersection_test"},
    "materials": {"a": {"type": "refraction"}, "b": {"type": "glass"}, "c": {"type": "diffuse"}}})");
  EXPECT_EQ(scene.settings.samples, 8);
  EXPECT_EQ(scene.settings.max_depth, 16);
  EXPECT_EQ(scene.settings.filter.kind, FilterKind::box);
  EXPECT_EQ(scene.settings.filter.radius, 0.5f);
  EXPECT_EQ(std::get<RefractionShader>(scene.materials[0].nodes[0]).ior, 1.5f);
  EXPECT_EQ(std::get<GlassShader>(scene.materials[1].nodes[0]).ior, 1.5f);
  EXPECT_FALSE(std::get<DiffuseShader>(scene.materials[2].nodes[0]).is_two_sided);
  EXPECT_EQ(scene_of(R"({"integrator": {"type": "path"}})").settings.roulette_threshold, 0.1f);
}

TEST(SceneJson, an_area_light_shines_on_the_normal_s_side_of_a_black_object) {
  const Scene scene =
      scene_of(R"({"objects": [{"type": "sphere", "light": {"type": "area", "radiance": [1, 2, 3]}}]})");
  const Material& material = scene.materials[scene.instances[0].materials.at(0)];
  ASSERT_EQ(material.nodes.size(), 1u);
  EXPECT_EQ(material.surface, 0u);
  EXPECT_EQ(emission_of(scene, 0), Color(1, 2, 3));
  EXPECT_FALSE(std::get<EmissionShader>(material.nodes[0]).is_two_sided);
}

TEST(SceneJson, an_area_light_keeps_the_object_s_material_and_leaves_that_of_others_dark) {
  const Scene scene = scene_of(R"({"materials": {"a": {"type": "diffuse"}}, "objects": [
    {"type": "sphere", "material_name": "a", "light": {"type": "area", "radiance": [1, 2, 3]}},
    {"type": "sphere", "material_name": "a"}]})");
  const Material& shining = scene.materials[scene.instances[0].materials.at(0)];
  const auto& sum = std::get<AddShader>(shining.nodes.at(shining.surface));
  EXPECT_TRUE(std::holds_alternative<DiffuseShader>(shining.nodes[sum.first]));
  EXPECT_TRUE(std::holds_alternative<EmissionShader>(shining.nodes[sum.second]));
  EXPECT_EQ(emission_of(scene, 1), Color(0.0f));
}

TEST(SceneJson, the_environment_is_the_texture_times_the_scale) {
  EXPECT_EQ(scene_of(R"({"textures": {"a": {"type": "constant", "color": [1, 2, 4]}},
                         "environment_map": {"texture_name": "a", "scale": 0.5}})")
                .environment.radiance,
            Color(0.5f, 1, 2));
  EXPECT_EQ(scene_of(R"({"environment": {"radiance": [1, 2, 3]}})").environment.radiance, Color(1, 2, 3));
}

TEST(SceneJson, an_image_around_the_scene_is_a_layer_with_y_up) {
  const Scene scene = scene_of(R"({
    "textures": {"a": {"type": "image", "width": 4, "height": 2, "channels": 1, "pixels": [0, 1, 2, 3, 4, 5, 6, 7],
                       "interpolation": "closest"}},
    "environment_map": {"texture_name": "a", "scale": [1, 2, 4]}})");
  ASSERT_EQ(scene.environment.layers.size(), 1u);
  const auto at = [&](Vec3f direction) { return eval_environment(scene.environment, direction, true).x; };
  EXPECT_EQ(at({-0.1f, -0.1f, -1}), 1);  // ahead, low and to the left
  EXPECT_EQ(at({0.1f, -0.1f, -1}), 2);
  EXPECT_EQ(at({0.1f, 0.1f, -1}), 6);
  EXPECT_EQ(at({0.1f, 0.1f, 1}), 7);  // behind
  EXPECT_EQ(eval_environment(scene.environment, {0.1f, 0.1f, 1}, true).z, 28);
}

TEST(SceneJson, a_checkerboard_around_the_scene_becomes_its_average_with_a_warning) {
  Report report;
  const Scene scene = scene_of(R"({"objects": [{"type": "sphere"}],
    "textures": {"a": {"type": "checkerboard", "color0": [0, 1, 2], "color1": [4, 3, 2]}},
    "environment_map": {"texture_name": "a"}})",
                               report);
  EXPECT_EQ(scene.environment.radiance, Color(2, 2, 2));
  ASSERT_EQ(report.warnings().size(), 1u);
  EXPECT_TRUE(report.warnings()[0].starts_with("environment_map.texture_name: "));
}

TEST(SceneJson, images_are_shared_by_name) {
  const Scene scene = scene_of(R"({
    "images": {"dot": {"width": 1, "height": 1, "channels": 3, "bytes": [0, 128, 255], "encoding": "linear"}},
    "textures": {"a": {"type": "image", "image": "dot"},
                 "b": {"type": "image", "image": "dot", "extension": "clip", "divide_by_alpha": true}},
    "environment": {"layers": [{"image": "dot", "seen_by": "camera", "projection": "mirror_ball"}, {"radiance": [1, 2, 3]}]}})");
  const auto &a = std::get<ImageTexture>(scene.textures[0]), &b = std::get<ImageTexture>(scene.textures[1]);
  EXPECT_EQ(a.image.bytes, (std::vector<std::uint8_t>{0, 128, 255}));
  EXPECT_EQ(a.image.encoding, ByteEncoding::linear);
  EXPECT_TRUE(a.image.has_same_pixels(b.image));
  EXPECT_EQ(b.extension, ImageExtension::clip);
  EXPECT_TRUE(b.is_divided_by_alpha);
  ASSERT_EQ(scene.environment.layers.size(), 2u);
  EXPECT_TRUE(scene.environment.layers[0].image.has_same_pixels(a.image));
  EXPECT_EQ(scene.environment.layers[0].seen_by, EnvironmentRays::camera);
  EXPECT_TRUE(scene.environment.layers[1].image.is_empty());
}

TEST(SceneJson, a_share_is_a_number_or_a_texture_or_its_alpha) {
  const Scene scene = scene_of(R"({
    "textures": {"a": {"type": "constant"}},
    "materials": {"m": {"nodes": [{"type": "principled", "alpha": {"texture": "a", "alpha": true}},
                                  {"type": "mix", "factor": "a", "first": 0}, {"type": "mix", "factor": 0.25}]}}})");
  const std::vector<ShaderNode>& nodes = scene.materials[0].nodes;
  EXPECT_TRUE(std::get<PrincipledShader>(nodes[0]).alpha.is_alpha);
  EXPECT_EQ(std::get<PrincipledShader>(nodes[0]).alpha.texture.index, 0u);
  EXPECT_EQ(std::get<MixShader>(nodes[1]).factor.texture.index, 0u);
  EXPECT_FALSE(std::get<MixShader>(nodes[1]).factor.is_alpha);
  EXPECT_EQ(std::get<MixShader>(nodes[2]).factor.constant, 0.25f);
}

TEST(SceneJson, max_depth_counts_the_surfaces_of_a_path) {
  const RenderSettings settings =
      scene_of(R"({"integrator": {"type": "path", "max_depth": 12, "spp": 3, "rr_threshold": 0.25}})").settings;
  EXPECT_EQ(settings.integrator, IntegratorKind::path);
  EXPECT_EQ(settings.max_bounces, 11);
  EXPECT_EQ(settings.diffuse_bounces, 11);
  EXPECT_EQ(settings.glossy_bounces, 11);
  EXPECT_EQ(settings.transmission_bounces, 11);
  EXPECT_EQ(settings.transparent_bounces, 11);
  EXPECT_EQ(settings.samples, 3);
  EXPECT_EQ(settings.roulette_threshold, 0.25f);
}

TEST(SceneJson, integrators_that_are_not_there_yet_become_path_with_a_warning) {
  for (const std::string name : {"bdpt", "photon"}) {
    Report report;
    const Scene scene = scene_of(R"({"integrator": {"type": ")" + name + R"(", "spp": 5},
                                     "objects": [{"type": "sphere"}]})",
                                 report);
    EXPECT_EQ(scene.settings.integrator, IntegratorKind::path);
    EXPECT_EQ(scene.settings.samples, 5);
    ASSERT_EQ(report.warnings().size(), 1u);
    EXPECT_NE(report.warnings()[0].find('"' + name + '"'), std::string::npos);
  }
}

TEST(SceneJson, shaders_nest_and_refer_to_materials_before_them) {
  const Scene scene = scene_of(R"({"materials": {
    "red": {"type": "diffuse", "color": [1, 0, 0]},
    "veil": {"type": "mix", "factor": 0.25, "first": {"type": "transparent"}, "second": "red"},
    "both": {"type": "add", "first": "veil", "second": "veil"},
    "half": {"type": "mix", "first": null}}})");
  const Material& veil = scene.materials[1];
  const auto& mix = std::get<MixShader>(veil.nodes.at(veil.surface));
  EXPECT_EQ(mix.factor.constant, 0.25f);
  EXPECT_TRUE(std::holds_alternative<TransparentShader>(veil.nodes.at(mix.first)));
  EXPECT_EQ(std::get<DiffuseShader>(veil.nodes.at(mix.second)).color.constant, Color(1, 0, 0));
  const Material& both = scene.materials[2];
  EXPECT_EQ(both.nodes.size(), veil.nodes.size() + 1) << "what is named twice is copied once";
  const auto& sum = std::get<AddShader>(both.nodes.at(both.surface));
  EXPECT_EQ(sum.first, sum.second);
  const auto& half = std::get<MixShader>(scene.materials[3].nodes.at(0));
  EXPECT_EQ(half.first, no_node);
  EXPECT_EQ(half.second, no_node);
  validate_description(scene);
}

TEST(SceneJson, objects_share_shapes_and_have_materials_for_slots) {
  const Scene scene = scene_of(R"({
    "materials": {"a": {"type": "diffuse"}, "b": {"type": "glossy"}},
    "shapes": {"triangle": {"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "triangles": [0, 1, 2],
                            "uvs": [0, 0, 1, 0, 0, 1], "material_slots": [1]}},
    "objects": [{"shape": "triangle", "materials": ["a", null, "b"], "name": "first", "visibility": ["camera", "shadow"]},
                {"shape": "triangle"}]})");
  EXPECT_EQ(scene.shapes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].shape, scene.instances[1].shape);
  EXPECT_EQ(scene.instances[0].name, "first");
  EXPECT_EQ(scene.instances[0].materials, (std::vector<Id<Material>>{{0}, {}, {1}}));
  EXPECT_EQ(scene.instances[0].visibility, ray_camera | ray_shadow);
  EXPECT_EQ(scene.instances[1].visibility, ray_all);
  EXPECT_EQ(std::get<Mesh>(scene.shapes[0]).material_slots, std::vector<std::uint32_t>{1});
}

TEST(SceneJson, what_moves_has_keys_and_a_translation_moves_them_all) {
  const Scene scene = scene_of(R"({
    "settings": {"shutter_curve": [0, 1, 0.5]},
    "camera": {"type": "orthographic", "motion_transforms": [[1, 0, 0, 3,  0, 1, 0, 0,  0, 0, 1, 0,  0, 0, 0, 1]]},
    "objects": [{"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "triangles": [0, 1, 2],
                 "motion_positions": [[0, 0, 1, 1, 0, 1, 0, 1, 1], [0, 0, 2, 1, 0, 2, 0, 1, 2]],
                 "translate": [10, 0, 0],
                 "motion_transforms": [[1, 0, 0, 1,  0, 1, 0, 2,  0, 0, 1, 3,  0, 0, 0, 1]]}]})");
  EXPECT_EQ(scene.settings.shutter_curve, (std::vector<float>{0, 1, 0.5f}));
  ASSERT_EQ(std::get<OrthographicCamera>(*scene.camera).motion_transforms.size(), 1u);
  EXPECT_EQ(std::get<OrthographicCamera>(*scene.camera).motion_transforms[0].rows[0][3], 3);
  ASSERT_EQ(scene.instances[0].motion_transforms.size(), 1u);
  EXPECT_EQ(scene.instances[0].object_to_world.column(3), Vec3f(10, 0, 0));
  EXPECT_EQ(scene.instances[0].motion_transforms[0].column(3), Vec3f(11, 2, 3));
  const Mesh& mesh = std::get<Mesh>(scene.shapes[0]);
  ASSERT_EQ(mesh.motion_positions.size(), 2u);
  EXPECT_EQ(mesh.motion_positions[1][2], Vec3f(0, 1, 2));
}

TEST(SceneJson, frames_beside_this_one_have_transforms_positions_and_cameras) {
  const Scene scene = scene_of(R"({
    "adjacent_cameras": [{"type": "orthographic"}, {"position": [0, 0, 1], "look_at": [0, 0, 0], "fov": 45}],
    "objects": [{"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "triangles": [0, 1, 2],
                 "adjacent_positions": [[0, 0, 1, 1, 0, 1, 0, 1, 1], [0, 0, 2, 1, 0, 2, 0, 1, 2]],
                 "translate": [10, 0, 0],
                 "adjacent_transforms": [[1, 0, 0, 1,  0, 1, 0, 2,  0, 0, 1, 3,  0, 0, 0, 1],
                                         [0, 0, 0, 1,  0, 0, 0, 2,  0, 0, 0, 4,  0, 0, 0, 1]]}]})");
  ASSERT_EQ(scene.adjacent_cameras.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<OrthographicCamera>(scene.adjacent_cameras[0]));
  EXPECT_TRUE(std::holds_alternative<PerspectiveCamera>(scene.adjacent_cameras[1]));
  ASSERT_EQ(scene.instances[0].adjacent_transforms.size(), 2u);
  EXPECT_EQ(scene.instances[0].adjacent_transforms[1].column(3), Vec3f(11, 2, 4));
  const Mesh& mesh = std::get<Mesh>(scene.shapes[0]);
  ASSERT_EQ(mesh.adjacent_positions.size(), 2u);
  EXPECT_EQ(mesh.adjacent_positions[1][2], Vec3f(0, 1, 2));
}

TEST(SceneJson, an_obj_file_that_two_objects_name_is_read_once) {
  const TemporaryFolder folder;
  folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto path = folder.write(
      "scene.json", R"({"objects": [{"type": "mesh", "path": "t.obj"}, {"type": "mesh", "path": "./t.obj"}]})");
  Report report;
  const Scene scene = load_scene(path, report);
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 2u);
}

TEST(SceneJson, settings_come_after_the_assignment_s_keys) {
  const RenderSettings settings = scene_of(R"({
    "integrator": {"type": "path", "spp": 7}, "film": {"resolution": [10, 20], "filter": {"type": "tent", "radius": 1}},
    "settings": {"samples": 9, "width": 30, "passes": ["Depth"], "seed": -9007199254740993}})")
                                      .settings;
  EXPECT_EQ(settings.samples, 9);
  EXPECT_EQ(settings.width, 30);
  EXPECT_EQ(settings.height, 20);
  EXPECT_EQ(settings.seed, -9007199254740993) << "more digits than a double has";
  EXPECT_EQ(settings.filter.kind, FilterKind::tent);
  EXPECT_TRUE(settings.passes.has(Pass::depth));
  EXPECT_TRUE(settings.passes.has(Pass::combined));
}

TEST(SceneJson, an_override_merges_into_the_file) {
  Report report;
  const Scene scene = parse_scene(R"({"integrator": {"type": "path", "spp": 7, "max_depth": 3}})", ".", "test.json",
                                  report, {.override_json = R"({"integrator": {"spp": 2, "max_depth": null}})"});
  EXPECT_EQ(scene.settings.samples, 2);
  EXPECT_EQ(scene.settings.max_bounces, RenderSettings{}.max_bounces);
}

TEST(SceneJson, images_come_through_the_reader_that_is_given) {
  Report report;
  std::filesystem::path asked;
  const auto read_image = [&](const std::filesystem::path& path) {
    asked = path;
    return Image{.width = 1, .height = 1, .channels = 3, .pixels = {1, 2, 3}, .path = path.string()};
  };
  const Scene scene = parse_scene(R"({"textures": {"a": {"type": "image", "path": "b/c.exr"}}})", "folder", "test.json",
                                  report, {.override_json = "", .read_image = read_image});
  EXPECT_EQ(asked, std::filesystem::path("folder/b/c.exr"));
  EXPECT_EQ(std::get<ImageTexture>(scene.textures[0]).image.pixels, (std::vector<float>{1, 2, 3}));
}

}  // namespace
}  // namespace basicrt
