// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene must fulfil before anything is built from it.
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "base/error.h"
#include "base/validate_fields.h"
#include "bsdf/bsdf.h"
#include "scene/scene.h"
#include "scene/shadow_links.h"

namespace basicrt {
namespace {

// Beyond it, squares and products of lengths leave the range of floats.
constexpr float largest_coordinate = 1e15f;

std::string entry(std::string_view table, std::size_t index) {
  return std::string(table) + "[" + std::to_string(index) + "]";
}

template <class T>
void validate_id(Id<T> id, const Table<T>& table, const std::string& item, const char* things) {
  if (!table.contains(id))
    throw SceneError(item, "id " + (id.is_valid() ? std::to_string(id.index) : std::string("none")) +
                               ", but the scene has " + std::to_string(table.size()) + " " + things);
}

// Relative to the columns' lengths: small is fine, flat is not.
bool is_singular(const Transform& transform) {
  const TransformD m(transform);
  const double size = length(m.column(0)) * length(m.column(1)) * length(m.column(2));
  return !(std::abs(m.determinant()) > 1e-9 * size);
}

void validate_transform(const Transform& transform, const std::string& item) {
  validate_field(transform, Range{}, item, "");
  if (is_singular(transform)) throw SceneError(item, "is singular: it flattens space and has no inverse");
}

// All that is asked of any described struct: its ranges, and that its transforms have inverses.
template <Described Struct>
void validate_described(const Struct& object, const std::string& item) {
  validate_fields(object, item);
  for_each_field<Struct>([&]<class Value>(const Field<Struct, Value>& field) {
    const Value& value = object.*field.member;
    if constexpr (std::same_as<Value, Transform>) validate_transform(value, join_path(item, field.name));
    if constexpr (std::same_as<Value, std::vector<Transform>>)
      for (std::size_t i = 0; i < value.size(); ++i)
        validate_transform(value[i], join_path(item, entry(field.name, i)));
  });
}

void validate_image(const Image& image, const std::string& item) {
  if (image.width < 1 || image.height < 1) throw SceneError(item, "the image has no pixels");
  if (image.channels < 1 || image.channels > 4)
    throw SceneError(item, "an image must have 1 to 4 channels, has " + std::to_string(image.channels));
  const std::size_t expected = image.offset(0, image.height), numbers = image.pixels.size() + image.bytes.size();
  if (numbers != expected || (!image.pixels.empty() && !image.bytes.empty()))
    throw SceneError(item, "width, height and channels make " + std::to_string(expected) + " numbers, but there are " +
                               std::to_string(numbers));
  for (const float number : image.pixels)
    if (!std::isfinite(number)) throw SceneError(item, "a pixel is " + number_text(number));
}

void validate_textures(const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.textures.size(); ++i) {
    const std::string item = entry("textures", i);
    // Not that transforms have inverses: images may be flattened.
    std::visit([&](const auto& texture) { validate_fields(texture, item); }, scene.textures[i]);
    if (const auto* image = std::get_if<ImageTexture>(&scene.textures[i])) validate_image(image->image, item);
  }
}

void validate_environment(const Environment& environment) {
  validate_fields(environment, "environment");
  for (std::size_t i = 0; i < environment.layers.size(); ++i) {
    const EnvironmentLayer& layer = environment.layers[i];
    const std::string item = "environment." + entry("layers", i);
    validate_fields(layer, item);
    if (!layer.image.is_empty()) validate_image(layer.image, item + ".image");
    if (!layer.sky) continue;
    std::visit([&](const auto& sky) { validate_fields(sky, item + ".sky"); }, *layer.sky);
    if (!layer.image.is_empty()) throw SceneError(item + ".sky", "there is an image, too");
  }
}

// `count` operations may be named.
template <class Input>
void validate_input(const Scene& scene, const Input& input, std::size_t count, const std::string& item) {
  if (input.texture.is_valid()) validate_id(input.texture, scene.textures, item, "textures");
  if (input.operation.is_valid() && input.operation.index >= count)
    throw SceneError(item, "operation " + std::to_string(input.operation.index) + ", but there are " +
                               std::to_string(count) + " before this");
}

void validate_table(const TableOperation& node, const std::string& item) {
  if (node.colors.empty() || node.colors.size() % 3 != 0)
    throw SceneError(item + ".colors",
                     "must be three numbers for each of one colour or more, has " + std::to_string(node.colors.size()));
  if (!(node.minimum < node.maximum)) throw SceneError(item + ".maximum", "must be greater than minimum");
}

void validate_ies(const IesOperation& node, const std::string& item) {
  const auto check_angles = [&](const std::vector<float>& angles, const char* name) {
    if (angles.empty()) throw SceneError(item + "." + name, "must have an angle at least");
    if (!std::ranges::is_sorted(angles)) throw SceneError(item + "." + name, "must ascend");
  };
  check_angles(node.horizontal, "horizontal");
  check_angles(node.vertical, "vertical");
  const std::size_t count = node.horizontal.size() * node.vertical.size();
  if (node.values.size() != count)
    throw SceneError(item + ".values", "must be one for each horizontal and vertical angle, " + std::to_string(count) +
                                           ", has " + std::to_string(node.values.size()));
}

// What an operation refers to: textures of the scene, and operations before it.
void validate_operations(const Scene& scene, const Material& material, const std::string& item) {
  for (std::size_t i = 0; i < material.operations.size(); ++i) {
    const std::string operation_item = item + "." + entry("operations", i);
    std::visit(
        [&]<class Kind>(const Kind& node) {
          validate_described(node, operation_item);
          for_each_field<Kind>([&]<class Value>(const Field<Kind, Value>& field) {
            const std::string field_item = join_path(operation_item, field.name);
            if constexpr (IsInput<Value>) validate_input(scene, node.*field.member, i, field_item);
            if constexpr (std::same_as<Value, Id<Texture>>)
              validate_id(node.*field.member, scene.textures, field_item, "textures");
          });
          if constexpr (std::same_as<Kind, TableOperation>) validate_table(node, operation_item);
          if constexpr (std::same_as<Kind, IesOperation>) validate_ies(node, operation_item);
        },
        material.operations[i]);
  }
}

// A volume is the same everywhere.
void validate_volume(const Material& material, NodeIndex index, const std::string& item, std::vector<bool>& is_seen) {
  if (index == no_node || is_seen[index]) return;
  is_seen[index] = true;
  std::visit(
      [&]<class Shader>(const Shader& shader) {
        for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
          if constexpr (IsInput<Value>) {
            if ((shader.*field.member).operation.is_valid())
              throw SceneError(join_path(item + "." + entry("nodes", index), field.name),
                               "is an operation, but nothing in a volume may vary");
          } else if constexpr (std::same_as<Value, NodeIndex>) {
            validate_volume(material, shader.*field.member, item, is_seen);
          }
        });
      },
      material.nodes[index]);
}

// What a shader refers to: operations, textures of the scene, and nodes before it.
template <class Shader>
void validate_shader(const Scene& scene, const Shader& shader, const Material& material, NodeIndex index,
                     const std::string& item) {
  validate_described(shader, item);
  for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
    const Value& value = shader.*field.member;
    if constexpr (IsInput<Value>) {
      validate_input(scene, value, material.operations.size(), join_path(item, field.name));
    } else if constexpr (std::same_as<Value, NodeIndex>) {
      if (value != no_node && value >= index)
        throw SceneError(join_path(item, field.name),
                         "node " + std::to_string(value) + " does not come before node " + std::to_string(index));
    }
  });
}

void validate_materials(const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const std::string item = entry("materials", i);
    validate_operations(scene, material, item);
    for (NodeIndex node = 0; node < material.nodes.size(); ++node) {
      const std::string node_item = material.nodes.size() == 1 ? item : item + "." + entry("nodes", node);
      std::visit([&](const auto& shader) { validate_shader(scene, shader, material, node, node_item); },
                 material.nodes[node]);
    }
    if (material.surface != no_node && material.surface >= material.nodes.size())
      throw SceneError(item + ".surface", "node " + std::to_string(material.surface) + ", but the material has " +
                                              std::to_string(material.nodes.size()) + " nodes");
    if (material.volume != no_node && material.volume >= material.nodes.size())
      throw SceneError(item + ".volume", "node " + std::to_string(material.volume) + ", but the material has " +
                                             std::to_string(material.nodes.size()) + " nodes");
    std::vector<bool> is_seen(material.nodes.size());
    validate_volume(material, material.volume, item, is_seen);
    if (const int lobes = lobe_count(material); lobes > Bsdf::max_lobes)
      throw SceneError(item, "combines more shaders than can be rendered: its graph makes " + std::to_string(lobes) +
                                 " lobes, but at most " + std::to_string(Bsdf::max_lobes) + " are allowed");
  }
}

std::vector<Bounds3f> validate_shapes(const Scene& scene) {
  std::vector<Bounds3f> shape_bounds;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    validate(scene.shapes[i], entry("shapes", i));
    shape_bounds.push_back(bounds(scene.shapes[i]));
  }
  return shape_bounds;
}

void check_adjacent_count(std::size_t count, const std::string& item) {
  if (count != 0 && count != 2)
    throw SceneError(
        item, "must be those of two frames, the one before and the one after, or none, has " + std::to_string(count));
}

void validate_reach(const Bounds3f& world_bounds, const std::string& item) {
  const float reach = std::max(max_component(abs(world_bounds.lower)), max_component(abs(world_bounds.upper)));
  if (!world_bounds.is_empty() && !(reach <= largest_coordinate))
    throw SceneError(item, "reaches out to " + number_text(reach) + " m, but no more than " +
                               number_text(largest_coordinate) + " m can be rendered");
}

void validate_instance(const Scene& scene, std::uint32_t index, const std::vector<Bounds3f>* shape_bounds) {
  const Instance& instance = scene.instances[index];
  const std::string item = entry("instances", index);
  validate_id(instance.shape, scene.shapes, item + ".shape", "shapes");
  for (std::size_t slot = 0; slot < instance.materials.size(); ++slot)
    if (const Id<Material> id = instance.materials[slot]; id.is_valid())
      validate_id(id, scene.materials, item + "." + entry("materials", slot), "materials");
  const Bounds3f local = shape_bounds ? (*shape_bounds)[instance.shape.index] : bounds(scene.shapes[instance.shape]);
  validate_field(instance.light_group, within(0, light_groups), item, "light_group");
  validate_field(instance.receiver_set, within(0, LinkSets::count - 1), item, "receiver_set");
  validate_field(instance.blocker_set, within(0, LinkSets::count - 1), item, "blocker_set");
  validate_field(instance.shadow_terminator_offset, within(0, 1), item, "shadow_terminator_offset");
  validate_field(instance.shadow_terminator_shading_offset, within(0, 1), item, "shadow_terminator_shading_offset");
  for (const ObjectProperty& property : instance.info.properties)
    validate_field(property.value, {}, item + ".properties", property.name);
  validate_transform(instance.object_to_world, item + ".transform");
  validate_reach(transform_bounds(instance.object_to_world, local), item);
  for (std::size_t key = 0; key < instance.motion_transforms.size(); ++key) {
    validate_transform(instance.motion_transforms[key], item + "." + entry("motion_transforms", key));
    validate_reach(transform_bounds(instance.motion_transforms[key], local), item);
  }
  check_adjacent_count(instance.adjacent_transforms.size(), item + ".adjacent_transforms");
  // They may well be flat: nothing is traced there.
  for (std::size_t i = 0; i < instance.adjacent_transforms.size(); ++i)
    validate_field(instance.adjacent_transforms[i], Range{}, item, entry("adjacent_transforms", i));
}

void validate_instances(const Scene& scene) {
  const std::vector<Bounds3f> shape_bounds = validate_shapes(scene);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) validate_instance(scene, i, &shape_bounds);
}

void validate_lights(const Scene& scene) {
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const std::string item = entry("lights", i);
    const auto validate_light = [&](const auto& light) {
      validate_described(light, item);
      if (light.material.is_valid()) validate_id(light.material, scene.materials, item + ".material", "materials");
    };
    std::visit(validate_light, scene.lights[i]);
    const auto* sun = std::get_if<SunLight>(&scene.lights[i]);
    if (sun && length_squared(Vec3d(sun->direction)) == 0) throw SceneError(item + ".direction", "must not be zero");
  }
  validate_environment(scene.environment);
  if (scene.world_volume.is_valid()) validate_id(scene.world_volume, scene.materials, "world_volume", "materials");
}

void validate_camera(const Camera& any, const std::string& item) {
  const auto validate_kind = [&](const auto& camera) {
    validate_described(camera, item);
    if (!(camera.window_min.x < camera.window_max.x && camera.window_min.y < camera.window_max.y))
      throw SceneError(item + ".window_max", "must be greater than window_min, in x and in y");
    if (!(camera.clip_near < camera.clip_far)) throw SceneError(item + ".clip_far", "must be greater than clip_near");
  };
  std::visit(validate_kind, any);
}

void validate_cameras(const Scene& scene) {
  if (scene.camera) validate_camera(*scene.camera, "camera");
  check_adjacent_count(scene.adjacent_cameras.size(), "adjacent_cameras");
  for (std::size_t i = 0; i < scene.adjacent_cameras.size(); ++i)
    validate_camera(scene.adjacent_cameras[i], entry("adjacent_cameras", i));
}

void validate_border(const RenderSettings& settings) {
  const auto check = [](const char* name, std::int64_t begin, std::int64_t size, std::int64_t whole) {
    const std::int64_t end = begin + std::max<std::int64_t>(size, 1);
    if (end > whole)
      throw SceneError(
          std::string("settings.") + name,
          "the border ends at " + std::to_string(end) + ", but the picture has " + std::to_string(whole) + " pixels");
  };
  check("border_width", settings.border_x, settings.border_width, settings.width);
  check("border_height", settings.border_y, settings.border_height, settings.height);
}

void validate_shutter_curve(const std::vector<float>& curve) {
  if (curve.size() == 1) throw SceneError("settings.shutter_curve", "must have at least two numbers or none, has 1");
  const auto is_zero = [](float open) { return open == 0; };
  if (!curve.empty() && std::ranges::all_of(curve, is_zero))
    throw SceneError("settings.shutter_curve", "must not be 0 throughout: the shutter would never open");
}

// Only whole blocks of samples add up to the same sums.
void validate_sample_range(const RenderSettings& settings) {
  if (!settings.has_sample_range()) return;
  const std::string rule = " of a range of the samples";
  const auto check = [&](bool is_good, const char* item, const std::string& problem) {
    if (!is_good) throw SceneError(std::string("settings.") + item, problem);
  };
  const int from = settings.samples_from, to = settings.samples_end();
  const std::string multiple = "must be a multiple of " + std::to_string(sample_block) + ", is ";
  check(settings.samples > sample_block, "samples",
        "a range needs more than " + std::to_string(sample_block) + " of them, there are " +
            std::to_string(settings.samples));
  check(from % sample_block == 0, "samples_from", multiple + std::to_string(from));
  check(to % sample_block == 0 || to == settings.samples, "samples_to",
        multiple + std::to_string(to) + ", or all " + std::to_string(settings.samples));
  check(from < to && to <= settings.samples, "samples_to",
        "must be above samples_from and at most " + std::to_string(settings.samples) + ", is " + std::to_string(to));
  check(settings.adaptive_threshold == 0, "adaptive_threshold", "must be 0: sampling can't be adaptive" + rule);
  check(settings.time_limit == 0, "time_limit", "must be 0: there is no time limit" + rule);
  check(!settings.passes.has(PassRule::matte), "passes", "there is no Cryptomatte" + rule);
}

void validate_settings(const RenderSettings& settings) {
  validate_described(settings, "settings");
  validate_described(settings.filter, "settings.filter");
  validate_border(settings);
  validate_shutter_curve(settings.shutter_curve);
  validate_sample_range(settings);
  if (!settings.passes.has(Pass::combined)) throw SceneError("settings.passes", "Combined must be among them");
}

}  // namespace

void validate_description(const Scene& scene) {
  validate_settings(scene.settings);
  validate_cameras(scene);
  validate_textures(scene);
  validate_materials(scene);
  validate_instances(scene);
  validate_lights(scene);
  if (const std::size_t links = find_shadow_links(scene).size(); links > most_shadow_links)
    throw SceneError("blocker_sets", "there may be " + std::to_string(most_shadow_links) +
                                         " different choices of them in a scene, there are " + std::to_string(links));
}

void validate_instance(const Scene& scene, Id<Instance> id) { validate_instance(scene, id.index, nullptr); }

void validate_view(const Camera& camera, const RenderSettings& settings) {
  validate_settings(settings);
  validate_camera(camera, "camera");
}

void validate_views(const Scene& scene) {
  validate_settings(scene.settings);
  validate_cameras(scene);
}

void validate(const Scene& scene) {
  validate_description(scene);
  if (!scene.camera) throw SceneError("camera", "the scene has none");
}

}  // namespace basicrt
