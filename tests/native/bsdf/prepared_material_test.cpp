// SPDX-License-Identifier: GPL-3.0-or-later
// A prepared material shades as the material that it was made of.
#include "bsdf/prepared_material.h"

#include <gtest/gtest.h>

#include <vector>

namespace basicrt {
namespace {

SurfacePoint tilted_point(Vec2f uv) {
  SurfacePoint point;
  point.geometric_normal = normalize(Vec3f{0.2f, -0.3f, 1});
  point.shading_normal = normalize(Vec3f{0.3f, -0.2f, 1});
  point.uv = uv;
  point.derivatives.emplace().dpdu = {1, 0, 0};
  return point;
}

Material make_material(ShaderNode node) {
  Material material;
  material.surface = material.add(std::move(node));
  return material;
}

Material make_mix(const ShaderNode& first, const ShaderNode& second) {
  Material material;
  material.nodes = {first, second, MixShader{0.25f, 0, 1}};
  material.surface = 2;
  return material;
}

class PreparedMaterialTest : public testing::Test {
 protected:
  Table<Texture> textures_;
  Id<Texture> grey_ = textures_.append(ConstantTexture{Color(0.3f)});
  Id<Texture> checks_ = textures_.append(CheckerboardTexture{.scale = {2, 2}});

  static ColorInput input(Id<Texture> texture) {
    ColorInput result;
    result.texture = texture;
    return result;
  }
};

TEST_F(PreparedMaterialTest, shades_as_the_material_does) {
  const std::vector<Material> materials{
      make_material(DiffuseShader{.color = Color(0.1f, 0.5f, 0.9f)}),
      make_material(DiffuseShader{.color = input(grey_), .is_two_sided = true}),
      make_material(DiffuseShader{.color = input(checks_), .is_two_sided = true}),
      make_material(RefractionShader{.ior = 1.3f, .roughness = 0.4f}),
      make_material(GlassShader{.roughness = 0.4f}),
      make_material(GlossyShader{.roughness = 0.3f}),
      make_material(ConductorShader{.alpha_x = 0.1f, .alpha_y = 0.4f}),
      make_material(PrincipledShader{.roughness = 0.3f}),
      make_mix(EmissionShader{.radiance = Color(2, 1, 3), .is_two_sided = false}, DiffuseShader{}),
      make_mix(TransparentShader{}, GlossyShader{.roughness = 0.5f, .distribution = FacetDistribution::ggx})};
  const Vec3f directions[] = {normalize(Vec3f{0.5f, 0.1f, 0.8f}), normalize(Vec3f{-0.4f, 0.3f, 0.6f}),
                              normalize(Vec3f{0.1f, -0.5f, -0.9f}), normalize(Vec3f{-0.2f, 0.4f, -0.7f})};
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const PreparedMaterial prepared(materials[i], textures_);
    for (const Vec2f uv : {Vec2f{0.1f, 0.1f}, Vec2f{0.1f, 0.6f}}) {
      const SurfacePoint point = tilted_point(uv);
      for (const Vec3f wo : directions) {
        const SurfaceShading expected = shade(materials[i], textures_, point, wo);
        const SurfaceShading shading = shade(prepared, textures_, point, wo, [] { return ShadingContext(); });
        EXPECT_EQ(shading.emission, expected.emission) << i;
        EXPECT_EQ(shading.bsdf.has_only_deltas(), expected.bsdf.has_only_deltas()) << i;
        EXPECT_EQ(shading.bsdf.albedo_estimate(), expected.bsdf.albedo_estimate()) << i;
        for (const Vec3f wi : directions) {
          EXPECT_EQ(shading.bsdf.eval(wo, wi).value, expected.bsdf.eval(wo, wi).value) << i;
          EXPECT_EQ(shading.bsdf.eval(wo, wi).pdf, expected.bsdf.eval(wo, wi).pdf) << i;
        }
        const auto sample = shading.bsdf.sample(wo, 0.3f, {0.2f, 0.7f});
        const auto expected_sample = expected.bsdf.sample(wo, 0.3f, {0.2f, 0.7f});
        ASSERT_EQ(sample.has_value(), expected_sample.has_value()) << i;
        if (!sample) continue;
        EXPECT_EQ(sample->wi, expected_sample->wi) << i;
        EXPECT_EQ(sample->weight, expected_sample->weight) << i;
      }
    }
  }
}

TEST_F(PreparedMaterialTest, a_constant_texture_is_as_uniform_as_a_colour_and_others_are_not) {
  EXPECT_TRUE(PreparedMaterial(make_material(DiffuseShader{.color = Color(0.5f)}), textures_).front);
  EXPECT_TRUE(PreparedMaterial(make_material(DiffuseShader{.color = input(grey_)}), textures_).front);
  EXPECT_FALSE(PreparedMaterial(make_material(DiffuseShader{.color = input(checks_)}), textures_).front);
  // A Fresnel term looks at the angle.
  EXPECT_FALSE(PreparedMaterial(make_material(GlassShader{}), textures_).front);
}

TEST(PreparedMaterial, shadow_rays_run_only_what_makes_it_transparent) {
  Material material;
  const OperationIndex place = material.add(SurfaceOperation{}), color = material.add(NoiseOperation{.vector = place}),
                       alpha = material.add(ComponentOperation{.value = place});
  PrincipledShader leaf;
  leaf.base_color = color;
  leaf.alpha = alpha;
  DiffuseShader opaque;
  opaque.color = color;
  material.surface =
      material.add(MixShader{.factor = 0.25f, .first = material.add(leaf), .second = material.add(opaque)});

  const Table<Texture> textures;
  const PreparedMaterial prepared(material, textures);
  EXPECT_EQ(prepared.material.operations.size(), 3u);
  EXPECT_EQ(prepared.transparent.operations.size(), 2u);
  SurfacePoint point = tilted_point({0, 0});
  point.position = {0.5f, 2, 3};
  const Vec3f wo{0, 0, 1};
  EXPECT_EQ(transparency(prepared.transparent, textures, point, wo), Color(0.375f));
  EXPECT_EQ(transparency(material, textures, point, wo), Color(0.375f));
}

}  // namespace
}  // namespace basicrt
