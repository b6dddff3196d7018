// SPDX-License-Identifier: GPL-3.0-or-later
// Saved scenes hold everything, to the last bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "io/described_json.h"
#include "io/file.h"
#include "io/json_write.h"
#include "io/scene_text.h"
#include "io/temporary_folder.h"

namespace basicrt {
namespace {

// Every kind of everything, with numbers that have no short decimals.
Scene make_full_scene() {
  Scene scene;
  scene.settings.width = 123;
  scene.settings.seed = -9007199254740993;  // needs 54 bits
  scene.settings.exposure = 1.0f / 3;
  scene.settings.shutter_curve = {0.1f, 1, 0};
  scene.settings.filter = {FilterKind::blackman_harris, 1.0f / 7};
  scene.settings.passes.enable(Pass::normal);
  scene.settings.bvh_builder = BvhBuilder::median;
  PerspectiveCamera camera;
  camera.to_world.rows = {{{0.1f, 0.2f, 0.3f, 1e-20f}, {-0.7f, 0.6f, 0.1f, 1e10f}, {0.3f, 0.3f, -0.9f, 1.0f / 3}}};
  camera.clip_near = 1e-45f;  // denormal
  camera.motion_transforms = {camera.to_world, Transform{}};
  scene.camera = camera;
  scene.adjacent_cameras = {camera, EquirectangularCamera{}};
  scene.environment.radiance = {0.1f, 16777216.0f, 3e38f};

  scene.textures.append(ConstantTexture{.color = {0.1f, 0.2f, 0.3f}});
  scene.textures.append(CheckerboardTexture{.color0 = {1, 0, 0}, .color1 = {0, 0.1f, 0}, .scale = {3, 0.7f}});
  scene.textures.append(
      ImageTexture{.image = {.width = 2, .height = 1, .channels = 2, .pixels = {0.1f, -1, 1e30f, 0}, .path = ""}});

  const Image bytes{.width = 1, .height = 2, .channels = 1, .pixels = {}, .path = "", .bytes = {7, 255}};
  scene.textures.append(ImageTexture{.image = bytes,
                                     .interpolation = ImageInterpolation::cubic,
                                     .extension = ImageExtension::mirror,
                                     .uv_to_image = Transform({{{2, 0, 0, 0.1f}, {0, 0, 0, 0}, {0, 0, 1, 0}}}),
                                     .is_divided_by_alpha = true});
  scene.environment.layers = {{.radiance = {1, 0.1f, 0}, .seen_by = EnvironmentRays::camera},
                              {.image = bytes,
                               .projection = EnvironmentProjection::mirror_ball,
                               .interpolation = ImageInterpolation::closest,
                               .to_image = Transform({{{0, 1, 0, 0.1f}, {1, 0, 0, 0}, {0, 0, 1, 0}}}),
                               .seen_by = EnvironmentRays::scattered}};

  Material material{.name = "all \"kinds\"\n\xc3\xa4", .nodes = {}};
  ColorInput textured;
  textured.texture = Id<Texture>{2};
  NumberInput shared;
  shared.texture = Id<Texture>{3};
  shared.is_alpha = true;
  const NodeIndex first = material.add(DiffuseShader{.color = textured, .is_two_sided = true});
  material.add(GlossyShader{.color = Color(0.3f), .roughness = 0.1f});
  material.add(ConductorShader{.is_ggx = true});
  material.add(RefractionShader{.ior = 1.1f});
  material.add(GlassShader{.transmit_color = textured});
  material.add(TransparentShader{});
  const NodeIndex emission =
      material.add(EmissionShader{.radiance = textured, .is_two_sided = false, .strength = 0.3f});
  material.add(
      PrincipledShader{.base_color = textured, .metallic = 0.9f, .emission = Color(0.1f, 0, 0), .alpha = shared});
  const NodeIndex mix = material.add(MixShader{.factor = 0.1f, .first = first, .second = no_node});
  material.surface = material.add(AddShader{.first = mix, .second = emission});
  material.volume = material.add(VolumeShader{
      .absorption = {1, 2, 3}, .scattering = {0.1f, 0.2f, 0.3f}, .phase = PhaseKind::draine, .anisotropy = 0.5f});
  scene.materials.append(material);
  scene.materials.append(Material{.name = "", .nodes = {GlassShader{}}, .surface = 0});
  scene.materials.append(Material{.name = "twin", .nodes = {GlassShader{}}, .surface = 0});
  scene.materials.append(Material{.name = "twin", .nodes = {GlassShader{}, DiffuseShader{}}, .surface = 0});
  scene.materials.append(Material{.name = "material1", .nodes = {}});
  scene.world_volume = scene.materials.append(Material{.name = "fog", .nodes = {VolumeShader{}}, .volume = 0});

  scene.shapes.append(
      Mesh{.positions = {{0.1f, 0, 0}, {1, 0, 1.0f / 3}, {0, 1, 0}},
           .triangles = {{0, 1, 2}},
           .corner_normals = {{0, 0, 1}, {0, 0.1f, 1}, {0, 0, 1}},
           .uvs = {{0, 0}, {0.1f, 0}, {0, 0.7f}},
           .material_slots = {3},
           .motion_positions = {{{0.3f, 0, 0}, {1, 0, 1}, {0, 1, 0}}, {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}},
           .motion_corner_normals = {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}},
           .adjacent_positions = {{{0.3f, 0, 0}, {1, 0, 1}, {0, 1, 0}}, {{0, 0, 2}, {1, 0, 0.1f}, {0, 1, 2}}}});
  scene.shapes.append(Sphere{.center = {0.1f, 0.2f, 0.3f}, .radius = 0.7f});
  Transform transform;
  transform.rows[0] = {2, 0, 0.1f, -1};
  scene.instances.append({.name = "mesh",
                          .shape = {0},
                          .object_to_world = transform,
                          .materials = {{3}, {}, {2}, {1}, {4}, {0}},
                          .visibility = ray_camera | ray_glossy,
                          .motion_transforms = {Transform{}, transform},
                          .adjacent_transforms = {transform, Transform{}}});
  scene.instances.append({.name = "",
                          .shape = {1},
                          .object_to_world = {},
                          .materials = {},
                          .info = {.alpha = 0.3f, .properties = {{"age", {1, 2, 0.1f}}, {"name", Vec3f(0.7f)}}}});
  scene.instances.append({.name = "unseen", .shape = {1}, .object_to_world = {}, .materials = {}, .visibility = 0});

  scene.lights.append(PointLight{.position = {0.1f, 2, 3}, .radius = 0.1f, .is_soft = true});
  Material luminaire{.name = "luminaire"};
  const OperationIndex table = luminaire.add(IesOperation{.horizontal = {0, 0.1f}, .values = {1, 0.3f, 2, 0.7f}});
  luminaire.surface = luminaire.add(EmissionShader{.radiance = table});
  scene.lights.append(SpotLight{.to_world = transform,
                                .angle = 0.1f,
                                .material = scene.materials.append(luminaire),
                                .object_to_world = transform});
  scene.lights.append(SunLight{.direction = {0, -1, 0.1f}, .angle = 0.01f});
  scene.lights.append(AreaLight{.to_world = transform, .is_ellipse = true});
  return scene;
}

TEST(WriteScene, saving_what_was_loaded_gives_the_same_text) {
  const std::string text = scene_to_json(make_full_scene());
  EXPECT_EQ(scene_to_json(scene_of(text)), text);
}

TEST(WriteScene, tables_keep_their_order_and_names) {
  const Scene scene = make_full_scene(), loaded = scene_of(scene_to_json(scene));
  ASSERT_EQ(loaded.materials.size(), scene.materials.size());
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    EXPECT_EQ(loaded.materials[i].name, scene.materials[i].name);
    EXPECT_EQ(loaded.materials[i].surface, scene.materials[i].surface);
    EXPECT_EQ(loaded.materials[i].volume, scene.materials[i].volume);
    ASSERT_EQ(loaded.materials[i].nodes.size(), scene.materials[i].nodes.size());
    for (std::size_t node = 0; node < scene.materials[i].nodes.size(); ++node)
      EXPECT_EQ(loaded.materials[i].nodes[node].index(), scene.materials[i].nodes[node].index());
  }
  EXPECT_EQ(loaded.world_volume, scene.world_volume);
  ASSERT_EQ(loaded.instances.size(), scene.instances.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    EXPECT_EQ(loaded.instances[i].name, scene.instances[i].name);
    EXPECT_EQ(loaded.instances[i].shape, scene.instances[i].shape);
    EXPECT_EQ(loaded.instances[i].materials, scene.instances[i].materials);
    EXPECT_EQ(loaded.instances[i].visibility, scene.instances[i].visibility);
    EXPECT_EQ(loaded.instances[i].object_to_world, scene.instances[i].object_to_world);
    EXPECT_EQ(loaded.instances[i].motion_transforms, scene.instances[i].motion_transforms);
    EXPECT_EQ(loaded.instances[i].adjacent_transforms, scene.instances[i].adjacent_transforms);
  }
  const auto &mesh = std::get<Mesh>(scene.shapes[0]), &loaded_mesh = std::get<Mesh>(loaded.shapes[0]);
  EXPECT_EQ(loaded_mesh.positions, mesh.positions);
  EXPECT_EQ(loaded_mesh.triangles, mesh.triangles);
  EXPECT_EQ(loaded_mesh.corner_normals, mesh.corner_normals);
  EXPECT_EQ(loaded_mesh.uvs, mesh.uvs);
  EXPECT_EQ(loaded_mesh.material_slots, mesh.material_slots);
  EXPECT_EQ(loaded_mesh.motion_positions, mesh.motion_positions);
  EXPECT_EQ(loaded_mesh.motion_corner_normals, mesh.motion_corner_normals);
  EXPECT_EQ(loaded_mesh.adjacent_positions, mesh.adjacent_positions);
  ASSERT_EQ(loaded.adjacent_cameras.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<EquirectangularCamera>(loaded.adjacent_cameras[1]));
  EXPECT_EQ(std::get<ImageTexture>(loaded.textures[2]).image.pixels,
            std::get<ImageTexture>(scene.textures[2]).image.pixels);
  EXPECT_EQ(loaded.settings.seed, scene.settings.seed);
  EXPECT_EQ(loaded.settings.shutter_curve, scene.settings.shutter_curve);
  EXPECT_EQ(loaded.settings.passes, scene.settings.passes);
  const auto& camera = std::get<PerspectiveCamera>(*loaded.camera);
  EXPECT_EQ(camera.to_world, std::get<PerspectiveCamera>(*scene.camera).to_world);
  EXPECT_EQ(camera.motion_transforms, std::get<PerspectiveCamera>(*scene.camera).motion_transforms);
  EXPECT_EQ(camera.clip_near, 1e-45f);
  EXPECT_EQ(camera.clip_far, infinity);
}

TEST(WriteScene, every_kind_of_camera_reads_back_as_itself) {
  for (std::size_t index = 0; index < std::variant_size_v<Camera>; ++index)
    VariantKinds<Camera>::visit_index(index, [&]<class Kind>(Kind camera) {
      // Another value in each field that holds one number.
      float value = 0.1f;
      for_each_field<Kind>([&]<class Value>(const Field<Kind, Value>& field) {
        if constexpr (std::same_as<Value, float>) camera.*field.member = value += 0.3f;
        if constexpr (std::same_as<Value, int>) camera.*field.member = 7;
      });
      Scene scene;
      scene.camera = camera;
      const Scene loaded = scene_of(scene_to_json(scene));
      ASSERT_TRUE(std::holds_alternative<Kind>(*loaded.camera)) << Kind::kind;
      for_each_field<Kind>([&](const auto& field) {
        EXPECT_EQ(std::get<Kind>(*loaded.camera).*field.member, camera.*field.member)
            << Kind::kind << "." << field.name;
      });
    });
}

TEST(WriteScene, any_float_reads_back_as_itself) {
  constexpr unsigned seed = 20261122;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int i = 0; i < 200000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (!std::isfinite(value)) continue;
    const float read_back = static_cast<float>(Json::parse(write(value).dump()).get<double>());
    ASSERT_EQ(std::bit_cast<std::uint32_t>(read_back), std::bit_cast<std::uint32_t>(value)) << value;
  }
}

TEST(WriteScene, floats_are_written_as_people_write_them) {
  EXPECT_EQ(write(0.1f).dump(), "0.1");
  EXPECT_EQ(write(2.0f).dump(), "2.0");
}

TEST(WriteScene, the_scenes_of_the_repository_survive_saving) {
  const std::filesystem::path scenes = std::filesystem::path(BASICRT_SOURCE_DIR) / "scenes";
  for (const char* name : {"cbox_no_light_refract", "cbox_path", "materials"}) {
    Report report;
    const std::string text = scene_to_json(load_scene(scenes / name / "scene.json", report));
    EXPECT_EQ(scene_to_json(scene_of(text)), text) << name;
  }
}

TEST(WriteScene, a_scene_that_is_not_sound_is_not_saved) {
  const TemporaryFolder folder;
  Scene scene = make_full_scene();
  scene.instances.append({.name = "", .shape = {99}, .object_to_world = {}, .materials = {}});
  EXPECT_EQ(error_of([&] { save_scene(scene, folder.path() / "scene.json"); }),
            "instances[3].shape: id 99, but the scene has 2 shapes");
  EXPECT_TRUE(folder.files().empty());
}

TEST(WriteScene, a_saved_file_is_the_text_and_replaces_what_was_there) {
  const TemporaryFolder folder;
  const auto path = folder.write("scene.json", "old");
  save_scene(make_full_scene(), path);
  EXPECT_EQ(read_file(path), scene_to_json(make_full_scene()));
  EXPECT_EQ(folder.files(), std::vector<std::string>{"scene.json"});
}

}  // namespace
}  // namespace basicrt
