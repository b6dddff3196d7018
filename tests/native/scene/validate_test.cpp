// SPDX-License-Identifier: GPL-3.0-or-later
// Each rule of validate(), broken once.
#include <gtest/gtest.h>

#include <cmath>

#include "bsdf/bsdf.h"
#include "error_of.h"
#include "scene/scene.h"

namespace basicrt {
namespace {

Scene make_scene() {
  Scene scene;
  scene.camera = PerspectiveCamera{};
  scene.textures.append(ConstantTexture{});
  scene.materials.append(Material{.name = "a", .nodes = {DiffuseShader{}}, .surface = 0});
  scene.shapes.append(Sphere{});
  scene.instances.append({.name = "", .shape = {0}, .object_to_world = {}, .materials = {{0}}});
  return scene;
}

std::string problem_of(const Scene& scene) {
  return error_of([&] { validate(scene); });
}

template <class Change>
std::string problem_after(Change&& change) {
  Scene scene = make_scene();
  change(scene);
  return problem_of(scene);
}

std::string problem_of_placement(const Transform& transform) {
  return problem_after([&](Scene& scene) {
    scene.instances.append({.name = "", .shape = {0}, .object_to_world = transform, .materials = {}});
  });
}

std::string problem_of_material(const Material& material) {
  return problem_after([&](Scene& scene) { scene.materials.append(material); });
}

Transform scale(float x, float y, float z) { return Transform({{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}}}); }

TEST(Validate, a_sound_scene_and_one_with_nothing_but_a_camera_pass) {
  EXPECT_EQ(problem_of(make_scene()), "");
  Scene empty;
  empty.camera = OrthographicCamera{};
  EXPECT_EQ(problem_of(empty), "");
}

TEST(Validate, rendering_needs_a_camera_and_describing_does_not) {
  Scene scene;
  EXPECT_EQ(problem_of(scene), "camera: the scene has none");
  EXPECT_EQ(error_of([&] { validate_description(scene); }), "");
}

TEST(Validate, ids_lead_to_entries) {
  EXPECT_EQ(problem_after([](Scene& scene) {
              scene.instances.append({.name = "", .shape = {0}, .object_to_world = {}, .materials = {{}, {7}}});
            }),
            "instances[1].materials[1]: id 7, but the scene has 1 materials");
  EXPECT_EQ(problem_after([](Scene& scene) {
              scene.instances.append({.name = "", .shape = {}, .object_to_world = {}, .materials = {}});
            }),
            "instances[1].shape: id none, but the scene has 1 shapes");
  ColorInput textured;
  textured.texture = Id<Texture>{1};
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {GlossyShader{.color = textured}}, .surface = 0}),
            "materials[1].color: id 1, but the scene has 1 textures");
}

TEST(Validate, nodes_refer_backwards) {
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {DiffuseShader{}, MixShader{.first = 0, .second = 1}}}),
            "materials[1].nodes[1].second: node 1 does not come before node 1");
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {AddShader{.first = 2}, DiffuseShader{}, DiffuseShader{}}}),
            "materials[1].nodes[0].first: node 2 does not come before node 0");
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {DiffuseShader{}}, .surface = 1}),
            "materials[1].surface: node 1, but the material has 1 nodes");
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {MixShader{}}, .surface = 0}), "");
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {VolumeShader{}}, .volume = 1}),
            "materials[1].volume: node 1, but the material has 1 nodes");
}

// Shading has room for so many lobes and no more: one more would be written past its end.
TEST(Validate, a_material_makes_no_more_lobes_than_shading_has_room_for) {
  Material material;
  NodeIndex sum = material.add(DiffuseShader{});
  for (int lobes = 2; lobes <= Bsdf::max_lobes; ++lobes)
    sum = material.add(AddShader{.first = sum, .second = material.add(DiffuseShader{})});
  material.surface = sum;
  EXPECT_EQ(problem_of_material(material), "");
  material.surface = material.add(AddShader{.first = sum, .second = 0});
  const std::string most = std::to_string(Bsdf::max_lobes), more = std::to_string(Bsdf::max_lobes + 1);
  EXPECT_EQ(problem_of_material(material),
            "materials[1]: combines more shaders than can be rendered: its graph makes " + more +
                " lobes, but at most " + most + " are allowed");
}

TEST(Validate, numbers_are_finite_and_in_range) {
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {GlossyShader{.roughness = 1.5f}}, .surface = 0}),
            "materials[1].roughness: must be in [0, 1], is 1.5");
  EXPECT_EQ(problem_of_material({.name = "", .nodes = {GlossyShader{.roughness = NAN}}, .surface = 0}),
            "materials[1].roughness: must be a finite number, is nan");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.lights.append(PointLight{.intensity = {1, -1, 1}}); }),
            "lights[0].intensity: must be at least 0, is -1");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.environment.radiance.y = INFINITY; }),
            "environment.radiance: must be a finite number, is inf");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.shapes.append(Sphere{.radius = -1}); }).substr(0, 9), "shapes[1]");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.textures.append(ConstantTexture{.color = {NAN, 0, 0}}); }),
            "textures[1].color: must be a finite number, is nan");
}

TEST(Validate, vertices_are_finite_and_indices_in_range) {
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
            .triangles = {{0, 1, 2}},
            .corner_normals = {},
            .uvs = {},
            .material_slots = {}};
  EXPECT_EQ(problem_after([&](Scene& scene) { scene.shapes.append(mesh); }), "");
  for (const float bad : {NAN, INFINITY}) {
    Mesh bad_mesh = mesh;
    bad_mesh.positions[1].y = bad;
    EXPECT_EQ(problem_after([&](Scene& scene) { scene.shapes.append(bad_mesh); }).substr(0, 9), "shapes[1]");
  }
  mesh.triangles[0][1] = 3;
  EXPECT_EQ(problem_after([&](Scene& scene) { scene.shapes.append(mesh); }).substr(0, 9), "shapes[1]");
}

TEST(Validate, transforms_have_inverses) {
  const std::string singular = "instances[1].transform: is singular: it flattens space and has no inverse";
  EXPECT_EQ(problem_of_placement(scale(1, 1, 0)), singular);
  EXPECT_EQ(problem_of_placement(scale(0, 0, 0)), singular);
  EXPECT_EQ(problem_of_placement(Transform({{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}})), singular);
  EXPECT_EQ(problem_of_placement(scale(NAN, 1, 1)), "instances[1].transform: must be a finite number, is nan");
  EXPECT_EQ(problem_of_placement(scale(-1, 2, 3)), "") << "mirrored is not flat";
  EXPECT_EQ(problem_of_placement(scale(1e-12f, 1e-12f, 1e-12f)), "") << "small is not flat";
  EXPECT_EQ(problem_of_placement(scale(1e6f, 1, 1e-6f)), "") << "stretched is not flat";
  EXPECT_EQ(problem_after([](Scene& scene) { scene.lights.append(SpotLight{.to_world = scale(1, 0, 1)}); }),
            "lights[0].transform: is singular: it flattens space and has no inverse");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.camera = PerspectiveCamera{{.to_world = scale(0, 1, 1)}}; }),
            "camera.transform: is singular: it flattens space and has no inverse");
}

TEST(Validate, places_are_within_reach_of_float_arithmetic) {
  EXPECT_EQ(problem_of_placement(scale(1e14f, 1e14f, 1e14f)), "");
  EXPECT_TRUE(problem_of_placement(scale(1e30f, 1, 1)).starts_with("instances[1]: reaches out to 1.0"));
  EXPECT_TRUE(problem_of_placement(scale(3e38f, 3e38f, 3e38f)).starts_with("instances[1]: reaches out to "));
}

TEST(Validate, the_border_lies_in_the_picture) {
  const auto problem_with = [](int x, int width) {
    return problem_after([&](Scene& scene) {
      scene.settings.width = 100;
      scene.settings.border_x = x;
      scene.settings.border_width = width;
    });
  };
  EXPECT_EQ(problem_with(0, 0), "");
  EXPECT_EQ(problem_with(60, 40), "");
  EXPECT_EQ(problem_with(61, 40), "settings.border_width: the border ends at 101, but the picture has 100 pixels");
  EXPECT_NE(problem_with(2147483647, 2147483647), "");
  EXPECT_NE(problem_with(100, 0), "");
}

TEST(Validate, the_picture_has_a_size) {
  EXPECT_EQ(problem_after([](Scene& scene) { scene.settings.width = 0; }),
            "settings.width: must be in [1, 65536], is 0");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.settings.height = -4; }),
            "settings.height: must be in [1, 65536], is -4");
}

TEST(Validate, the_camera_s_window_and_clipping_are_not_empty) {
  EXPECT_EQ(problem_after(
                [](Scene& scene) { scene.camera = PerspectiveCamera{{.window_min = {1, 0}, .window_max = {1, 2}}}; }),
            "camera.window_max: must be greater than window_min, in x and in y");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.camera = OrthographicCamera{{.clip_near = 2, .clip_far = 2}}; }),
            "camera.clip_far: must be greater than clip_near");
}

TEST(Validate, there_is_a_frame_before_and_one_after_or_none) {
  const std::string rule = ": must be those of two frames, the one before and the one after, or none, has ";
  EXPECT_EQ(problem_after([](Scene& scene) { scene.adjacent_cameras = {PerspectiveCamera{}}; }),
            "adjacent_cameras" + rule + "1");
  const PerspectiveCamera narrow{{.window_min = {1, 0}, .window_max = {1, 2}}};
  EXPECT_EQ(problem_after([&](Scene& scene) { scene.adjacent_cameras = {PerspectiveCamera{}, narrow}; }),
            "adjacent_cameras[1].window_max: must be greater than window_min, in x and in y");
  const auto problem_with = [](const std::vector<Transform>& transforms) {
    return problem_after([&](Scene& scene) {
      Instance instance = scene.instances[0];
      instance.adjacent_transforms = transforms;
      scene.instances.set({0}, instance);
    });
  };
  Transform flat, endless;
  flat.rows[2] = {0, 0, 0, 0};
  endless.rows[0][3] = infinity;
  EXPECT_EQ(problem_with({flat, flat}), "");
  EXPECT_EQ(problem_with({flat, flat, flat}), "instances[0].adjacent_transforms" + rule + "3");
  EXPECT_TRUE(problem_with({flat, endless}).starts_with("instances[0].adjacent_transforms[1]: must be "))
      << problem_with({flat, endless});
}

TEST(Validate, a_sun_shines_somewhere) {
  EXPECT_EQ(problem_after([](Scene& scene) { scene.lights.append(SunLight{.direction = {0, 0, 0}}); }),
            "lights[0].direction: must not be zero");
}

TEST(Validate, a_lamp_s_material_is_there) {
  EXPECT_EQ(problem_after([](Scene& scene) { scene.lights.append(PointLight{.material = Id<Material>{7}}); }),
            "lights[0].material: id 7, but the scene has 1 materials");
  EXPECT_EQ(problem_after([](Scene& scene) { scene.lights.append(SunLight{.object_to_world = scale(1, 0, 1)}); }),
            "lights[0].object_transform: is singular: it flattens space and has no inverse");
}

TEST(Validate, a_luminaire_s_table_is_whole) {
  const auto problem_of = [](IesOperation node) {
    Material material;
    material.operations = {std::move(node)};
    return problem_of_material(material);
  };
  const std::string item = "materials[1].operations[0].";
  EXPECT_EQ(problem_of({}), "");
  EXPECT_EQ(problem_of({.vertical = {}}), item + "vertical: must have an angle at least");
  EXPECT_EQ(problem_of({.horizontal = {1, 0.5f}}), item + "horizontal: must ascend");
  EXPECT_EQ(problem_of({.values = {1, 2, 3}}),
            item + "values: must be one for each horizontal and vertical angle, 4, has 3");
}

TEST(Validate, an_image_has_the_pixels_that_its_size_says) {
  const auto problem_with = [](Image image) {
    return problem_after([&](Scene& scene) { scene.textures.append(ImageTexture{.image = std::move(image)}); });
  };
  EXPECT_EQ(problem_with({.width = 1, .height = 1, .channels = 3, .pixels = {1, 1, 1}, .path = ""}), "");
  EXPECT_EQ(problem_with({}), "textures[1]: the image has no pixels");
  EXPECT_EQ(problem_with({.width = 2, .height = 1, .channels = 3, .pixels = {1, 1, 1}, .path = ""}),
            "textures[1]: width, height and channels make 6 numbers, but there are 3");
  EXPECT_EQ(problem_with({.width = 1, .height = 1, .channels = 5, .pixels = {1, 1, 1, 1, 1}, .path = ""}),
            "textures[1]: an image must have 1 to 4 channels, has 5");
  EXPECT_EQ(problem_with({.width = 1, .height = 1, .channels = 1, .pixels = {INFINITY}, .path = ""}),
            "textures[1]: a pixel is inf");
}

TEST(Validate, combined_is_among_the_passes) {
  EXPECT_EQ(problem_after([](Scene& scene) { scene.settings.passes = PassLayout::none(); }),
            "settings.passes: Combined must be among them");
}

}  // namespace
}  // namespace basicrt
