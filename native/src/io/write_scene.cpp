// SPDX-License-Identifier: GPL-3.0-or-later
// A scene as one JSON text with everything in it. Reading it gives the same tables in the same order.
#include <algorithm>
#include <set>
#include <variant>

#include "base/overloaded.h"
#include "io/described_json.h"
#include "io/file.h"
#include "io/ray_kinds.h"
#include "io/scene_json.h"

namespace basicrt {
namespace {

// Keys by which a table's entries are found again, all different.
struct SceneKeys {
  std::vector<std::string> textures, materials, shapes;
};

std::vector<std::string> numbered_keys(std::string_view stem, std::uint32_t count) {
  std::vector<std::string> keys;
  for (std::uint32_t i = 0; i < count; ++i) keys.push_back(std::string(stem) + std::to_string(i));
  return keys;
}

// Their names, as far as they have names of their own.
std::vector<std::string> material_keys(const Table<Material>& materials) {
  std::set<std::string> taken;
  for (std::uint32_t i = 0; i < materials.size(); ++i) taken.insert(materials[i].name);
  taken.insert("");
  std::vector<std::string> keys;
  std::set<std::string> used = {""};
  for (std::uint32_t i = 0; i < materials.size(); ++i) {
    std::string key = materials[i].name;
    if (used.contains(key)) {
      key = "material" + std::to_string(i);
      while (taken.contains(key)) key += "_";
    }
    used.insert(key);
    taken.insert(key);
    keys.push_back(key);
  }
  return keys;
}

Json write_image(const Image& image) {
  Json json = {{"width", image.width}, {"height", image.height}, {"channels", image.channels}};
  if (image.bytes.empty()) {
    json["pixels"] = write_array(image.pixels);
  } else {
    json["bytes"] = write_array(image.bytes);
    json["encoding"] = write(image.encoding);
  }
  return json;
}

// Each image once, however many use it.
class ImageWriter {
 public:
  // The name under which the image is found.
  std::string add(const Image& image) {
    const auto found = std::ranges::find_if(images_, [&](const Image* other) { return other->has_same_pixels(image); });
    const auto index = found - images_.begin();
    if (found == images_.end()) images_.push_back(&image);
    return "image" + std::to_string(index);
  }
  [[nodiscard]] Json write() const {
    Json json = Json::object();
    for (std::size_t i = 0; i < images_.size(); ++i) json["image" + std::to_string(i)] = write_image(*images_[i]);
    return json;
  }

 private:
  std::vector<const Image*> images_;
};

Json write_texture(const Texture& texture, ImageWriter& images) {
  Json json = std::visit([](const auto& kind) { return write_fields(kind); }, texture);
  if (const auto* image_texture = std::get_if<ImageTexture>(&texture)) json["image"] = images.add(image_texture->image);
  return json;
}

Json write_environment(const Environment& environment, ImageWriter& images) {
  Json json = write_fields(environment);
  if (environment.layers.empty()) return json;
  json["layers"] = Json::array();
  for (const EnvironmentLayer& layer : environment.layers) {
    Json& written = json["layers"].emplace_back(write_fields(layer));
    if (!layer.image.is_empty()) written["image"] = images.add(layer.image);
    if (layer.sky) written["sky"] = std::visit([](const auto& sky) { return write_fields(sky); }, *layer.sky);
  }
  return json;
}

template <class Input>
Json write_varying(const Input& input, const SceneKeys& keys) {
  if (input.operation.is_valid()) return Json{{"operation", input.operation.index}};
  if (!input.texture.is_valid()) return write(input.constant);
  const std::string& texture = keys.textures.at(input.texture.index);
  if constexpr (std::same_as<Input, NumberInput>)
    if (input.is_alpha) return Json{{"texture", texture}, {"alpha", true}};
  return texture;
}

// A shader or an operation.
template <class Variant>
Json write_node(const Variant& node, const SceneKeys& keys) {
  const auto write_value = [&]<class Value>(const Value& value) -> Json {
    if constexpr (IsInput<Value>)
      return write_varying(value, keys);
    else if constexpr (std::same_as<Value, NodeIndex>)
      return value == no_node ? Json(nullptr) : Json(value);
    else if constexpr (std::same_as<Value, Id<Texture>>)
      return keys.textures.at(value.index);
    else if constexpr (std::same_as<Value, std::string>)
      return value;
    else
      return write(value);
  };
  return std::visit([&](const auto& kind) { return write_fields(kind, write_value); }, node);
}

Json write_material(const Material& material, const std::string& key, const SceneKeys& keys) {
  if (material.nodes.size() == 1 && material.surface == 0 && material.volume == no_node && material.name == key &&
      material.operations.empty() && material.pass_index == 0)
    return write_node(material.nodes[0], keys);
  Json json = Json::object();
  if (material.name != key) json["name"] = material.name;
  if (!material.operations.empty()) json["operations"] = Json::array();
  for (const Operation& operation : material.operations) json["operations"].push_back(write_node(operation, keys));
  json["nodes"] = Json::array();
  for (const ShaderNode& node : material.nodes) json["nodes"].push_back(write_node(node, keys));
  if (material.surface != no_node) json["surface"] = material.surface;
  if (material.volume != no_node) json["volume"] = material.volume;
  if (material.pass_index != 0) json["pass_index"] = material.pass_index;
  return json;
}

void write_attributes(const std::vector<MeshAttribute>& attributes, Json& json) {
  for (const MeshAttribute& attribute : attributes)
    json["attributes"].push_back(
        {{"name", attribute.name}, {"domain", write(attribute.domain)}, {"values", write_array(attribute.values)}});
}

Json write_mesh(const Mesh& mesh) {
  Json json = {{"type", "mesh"}};
  json["positions"] = write_array(mesh.positions);
  json["triangles"] = write_array(mesh.triangles);
  if (!mesh.corner_normals.empty()) json["corner_normals"] = write_array(mesh.corner_normals);
  if (!mesh.uvs.empty()) json["uvs"] = write_array(mesh.uvs);
  if (!mesh.material_slots.empty()) json["material_slots"] = write_array(mesh.material_slots);
  for (const std::vector<Vec3f>& positions : mesh.motion_positions)
    json["motion_positions"].push_back(write_array(positions));
  for (const std::vector<Vec3f>& normals : mesh.motion_corner_normals)
    json["motion_corner_normals"].push_back(write_array(normals));
  for (const std::vector<Vec3f>& positions : mesh.adjacent_positions)
    json["adjacent_positions"].push_back(write_array(positions));
  write_attributes(mesh.attributes, json);
  if (mesh.texture_space_min != Vec3f(0.0f) || mesh.texture_space_size != Vec3f(1.0f)) {
    json["texture_space_min"] = write(mesh.texture_space_min);
    json["texture_space_size"] = write(mesh.texture_space_size);
  }
  return json;
}

Json write_point_cloud(const PointCloud& cloud) {
  Json json = {{"type", PointCloud::kind}};
  json["positions"] = write_array(cloud.positions);
  json["radii"] = write_array(cloud.radii);
  if (!cloud.randoms.empty()) json["randoms"] = write_array(cloud.randoms);
  write_attributes(cloud.attributes, json);
  return json;
}

Json write_curves(const Curves& curves) {
  Json json = {{"type", Curves::kind}};
  json["points"] = write_array(curves.points);
  json["radii"] = write_array(curves.radii);
  json["firsts"] = write_array(curves.firsts);
  if (curves.form != CurveForm::round) json["form"] = write(curves.form);
  if (!curves.intercepts.empty()) json["intercepts"] = write_array(curves.intercepts);
  if (!curves.randoms.empty()) json["randoms"] = write_array(curves.randoms);
  if (!curves.uvs.empty()) json["uvs"] = write_array(curves.uvs);
  write_attributes(curves.attributes, json);
  return json;
}

Json write_shape(const Shape& shape) {
  return std::visit(Overloaded{[](const Mesh& mesh) { return write_mesh(mesh); },
                               [](const Sphere& sphere) { return Json(write_fields(sphere)); },
                               [](const PointCloud& cloud) { return write_point_cloud(cloud); },
                               [](const Curves& curves) { return write_curves(curves); }},
                    shape);
}

Json write_instance(const Instance& instance, const SceneKeys& keys) {
  Json json = Json::object();
  if (!instance.name.empty()) json["name"] = instance.name;
  json["shape"] = keys.shapes.at(instance.shape.index);
  json["transform"] = write(instance.object_to_world);
  if (!instance.motion_transforms.empty()) json["motion_transforms"] = write(instance.motion_transforms);
  if (!instance.adjacent_transforms.empty()) json["adjacent_transforms"] = write(instance.adjacent_transforms);
  if (!instance.materials.empty()) json["materials"] = Json::array();
  for (const Id<Material> id : instance.materials)
    json["materials"].push_back(id.is_valid() ? Json(keys.materials.at(id.index)) : Json(nullptr));
  if (instance.visibility != ray_all) {
    json["visibility"] = Json::array();
    for (std::size_t bit = 0; bit < ray_kind_names.size(); ++bit)
      if ((instance.visibility >> bit) & 1u) json["visibility"].push_back(ray_kind_names[bit]);
  }
  if (instance.is_holdout) json["holdout"] = true;
  if (instance.info.color != Color(1.0f)) json["color"] = write(instance.info.color);
  if (instance.info.alpha != 1) json["alpha"] = write(instance.info.alpha);
  if (instance.info.random != 0) json["random"] = write(instance.info.random);
  for (const ObjectProperty& property : instance.info.properties)
    json["properties"][property.name] = write(property.value);
  if (instance.is_shadow_catcher) json["shadow_catcher"] = true;
  if (instance.shadow_terminator_offset != 0)
    json["shadow_terminator_offset"] = write(instance.shadow_terminator_offset);
  if (instance.shadow_terminator_shading_offset != 0)
    json["shadow_terminator_shading_offset"] = write(instance.shadow_terminator_shading_offset);
  if (instance.pass_index != 0) json["pass_index"] = instance.pass_index;
  if (instance.light_group != 0) json["light_group"] = instance.light_group;
  if (!instance.asset_name.empty()) json["asset_name"] = instance.asset_name;
  if (instance.receiver_set != 0) json["receiver_set"] = instance.receiver_set;
  if (instance.blocker_set != 0) json["blocker_set"] = instance.blocker_set;
  if (!instance.lit_sets.is_all()) json["lit_sets"] = write(instance.lit_sets);
  if (!instance.blocker_sets.is_all()) json["blocker_sets"] = write(instance.blocker_sets);
  return json;
}

Json write_settings(const RenderSettings& settings) {
  Json json = write_fields(settings);
  json["filter"] = write_fields(settings.filter);
  json["passes"] = Json::array();
  for (const PassInfo& info : passes)
    if (settings.passes.has(info.pass)) json["passes"].push_back(info.name);
  return json;
}

Json write_light(const Light& light, const SceneKeys& keys) {
  const auto write_value = [&]<class Value>(const Value& value) -> Json {
    if constexpr (std::same_as<Value, Id<Material>>)
      return value.is_valid() ? Json(keys.materials.at(value.index)) : Json(nullptr);
    else
      return write(value);
  };
  return std::visit([&](const auto& kind) { return write_fields(kind, write_value); }, light);
}

}  // namespace

std::string scene_to_json(const Scene& scene) {
  validate_description(scene);
  const SceneKeys keys{.textures = numbered_keys("texture", scene.textures.size()),
                       .materials = material_keys(scene.materials),
                       .shapes = numbered_keys("shape", scene.shapes.size())};
  const auto write_kind = [](const auto& kind) { return write_fields(kind); };

  Json json = {{"settings", write_settings(scene.settings)}};
  if (scene.camera) json["camera"] = std::visit(write_kind, *scene.camera);
  for (const Camera& camera : scene.adjacent_cameras)
    json["adjacent_cameras"].push_back(std::visit(write_kind, camera));
  ImageWriter images;
  json["environment"] = write_environment(scene.environment, images);
  json["textures"] = Json::object();
  for (std::uint32_t i = 0; i < scene.textures.size(); ++i)
    json["textures"][keys.textures[i]] = write_texture(scene.textures[i], images);
  json["materials"] = Json::object();
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i)
    json["materials"][keys.materials[i]] = write_material(scene.materials[i], keys.materials[i], keys);
  if (scene.world_volume.is_valid()) json["world_volume"] = keys.materials.at(scene.world_volume.index);
  json["shapes"] = Json::object();
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) json["shapes"][keys.shapes[i]] = write_shape(scene.shapes[i]);
  json["objects"] = Json::array();
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
    json["objects"].push_back(write_instance(scene.instances[i], keys));
  json["lights"] = Json::array();
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) json["lights"].push_back(write_light(scene.lights[i], keys));
  if (Json written = images.write(); !written.empty()) json["images"] = std::move(written);
  return to_text(json);
}

void save_scene(const Scene& scene, const std::filesystem::path& path) {
  const std::string text = scene_to_json(scene);
  NewFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace basicrt
