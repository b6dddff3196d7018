// SPDX-License-Identifier: GPL-3.0-or-later
// Objects: shapes placed in the world, with materials and, for the assignment's area lights, emission.
#include <array>
#include <span>

#include "io/described_json.h"
#include "io/ray_kinds.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

// "shape", then what every object may have.
constexpr std::array<std::string_view, 25> shape_object_keys = {"shape",
                                                                "name",
                                                                "material_name",
                                                                "materials",
                                                                "transform",
                                                                "translate",
                                                                "motion_transforms",
                                                                "adjacent_transforms",
                                                                "light",
                                                                "visibility",
                                                                "holdout",
                                                                "shadow_catcher",
                                                                "color",
                                                                "alpha",
                                                                "random",
                                                                "properties",
                                                                "shadow_terminator_offset",
                                                                "shadow_terminator_shading_offset",
                                                                "pass_index",
                                                                "light_group",
                                                                "asset_name",
                                                                "receiver_set",
                                                                "blocker_set",
                                                                "lit_sets",
                                                                "blocker_sets"};
constexpr auto object_keys = std::span(shape_object_keys).subspan(1);

Id<Shape> read_object_shape(SceneReader& reader, const JsonValue& object) {
  const auto name = object.find("shape");
  if (!name) return read_shape(reader, object, object_keys);
  object.check_keys(shape_object_keys);
  return reader.shapes.resolve(*name);
}

// p' = transform p + translate, at each time.
void read_placement(const JsonValue& object, Instance& instance) {
  read_optional(object, "transform", instance.object_to_world);
  read_optional(object, "motion_transforms", instance.motion_transforms);
  read_optional(object, "adjacent_transforms", instance.adjacent_transforms);
  Vec3f translate;
  read_optional(object, "translate", translate);
  const auto move = [&](Transform& transform) {
    for (std::size_t axis = 0; axis < 3; ++axis) transform.rows[axis][3] += translate[axis];
  };
  move(instance.object_to_world);
  for (Transform& transform : instance.motion_transforms) move(transform);
  for (Transform& transform : instance.adjacent_transforms) move(transform);
}

std::vector<Id<Material>> read_material_slots(const SceneReader& reader, const JsonValue& object) {
  const auto name = object.find("material_name"), names = object.find("materials");
  if (name && names) name->fail("give this or \"materials\", not both");
  if (name) return {reader.materials.resolve(*name)};
  std::vector<Id<Material>> slots;
  if (names) {
    names->expect_array();
    for (std::size_t i = 0; i < names->size(); ++i) {
      const JsonValue slot = names->item(i);
      slots.push_back(slot.json().is_null() ? Id<Material>{} : reader.materials.resolve(slot));
    }
  }
  return slots;
}

std::uint32_t read_visibility(const JsonValue& names) {
  names.expect_array();
  std::uint32_t kinds = 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    kinds |= 1u << read_choice(names.item(i), ray_kind_names, "kind of ray");
  return kinds;
}

// The object's own copy of a material, shining on the side of the normal as well. Where there was none, it is black.
Id<Material> append_emissive(SceneReader& reader, Id<Material> base, const EmissionShader& emission) {
  Material material;
  NodeIndex reflecting = no_node;
  if (base.is_valid()) {
    material.name = reader.scene.materials[base].name;
    const MaterialRoots roots = append_nodes(material, reader.scene.materials[base]);
    reflecting = roots.surface;
    material.volume = roots.volume;
  }
  const NodeIndex emitting = material.add(emission);
  material.surface =
      reflecting == no_node ? emitting : material.add(AddShader{.first = reflecting, .second = emitting});
  return reader.scene.materials.append(std::move(material));
}

void read_area_light(SceneReader& reader, const JsonValue& light, std::vector<Id<Material>>& slots) {
  light.check_keys(std::array<std::string_view, 2>{"type", "radiance"});
  (void)read_choice(light.require("type"), std::array<std::string_view, 1>{"area"}, "light");
  EmissionShader emission{.is_two_sided = false};
  const JsonValue radiance = light.require("radiance");
  read(radiance, emission.radiance.constant);
  validate_field(emission.radiance, at_least(0), radiance.path(), "");
  if (slots.empty()) slots.emplace_back();
  for (Id<Material>& slot : slots) slot = append_emissive(reader, slot, emission);
}

void read_object(SceneReader& reader, const JsonValue& object) {
  Instance instance;
  instance.shape = read_object_shape(reader, object);
  read_optional(object, "name", instance.name);
  read_placement(object, instance);
  instance.materials = read_material_slots(reader, object);
  if (const auto visibility = object.find("visibility")) instance.visibility = read_visibility(*visibility);
  read_optional(object, "holdout", instance.is_holdout);
  read_optional(object, "color", instance.info.color);
  read_optional(object, "alpha", instance.info.alpha);
  read_optional(object, "random", instance.info.random);
  if (const auto properties = object.find("properties")) {
    properties->expect_object();
    for (const auto& [name, value] : properties->json().items())
      read(properties->member(name), instance.info.properties.emplace_back(ObjectProperty{name, {}}).value);
  }
  read_optional(object, "shadow_catcher", instance.is_shadow_catcher);
  read_optional(object, "shadow_terminator_offset", instance.shadow_terminator_offset);
  read_optional(object, "shadow_terminator_shading_offset", instance.shadow_terminator_shading_offset);
  read_optional(object, "pass_index", instance.pass_index);
  read_optional(object, "light_group", instance.light_group);
  read_optional(object, "asset_name", instance.asset_name);
  read_optional(object, "receiver_set", instance.receiver_set);
  read_optional(object, "blocker_set", instance.blocker_set);
  read_optional(object, "lit_sets", instance.lit_sets);
  read_optional(object, "blocker_sets", instance.blocker_sets);
  if (const auto light = object.find("light")) read_area_light(reader, *light, instance.materials);
  if (is_empty(reader.scene.shapes[instance.shape]))
    object.warn(reader.report, "skipped: the mesh has no triangles");
  else
    reader.scene.instances.append(std::move(instance));
}

}  // namespace

void read_objects(SceneReader& reader, const JsonValue& objects) {
  objects.expect_array();
  for (std::size_t i = 0; i < objects.size(); ++i) read_object(reader, objects.item(i));
}

}  // namespace basicrt
