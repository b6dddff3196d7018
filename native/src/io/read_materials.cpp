// SPDX-License-Identifier: GPL-3.0-or-later
// Materials: one shader, or shaders mixed and added.
#include <array>
#include <map>
#include <variant>

#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

template <class Shader>
constexpr int count_color_inputs() {
  int count = 0;
  for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>&) { count += std::same_as<Value, ColorInput>; });
  return count;
}

// Appends the nodes of one material, each after those that it refers to.
class MaterialReader {
 public:
  MaterialReader(const SceneReader& reader, Material& material) : reader_(reader), material_(material) {}

  void read_material(const JsonValue& json) {
    if (json.find("nodes") || json.find("surface") || json.find("volume")) return read_nodes(json);
    const NodeIndex shader = read_shader(json);
    const bool is_volume = std::holds_alternative<VolumeShader>(material_.nodes[shader]);
    (is_volume ? material_.volume : material_.surface) = shader;
  }

 private:
  void read_nodes(const JsonValue& json) {
    json.check_keys(std::array<std::string_view, 5>{"nodes", "surface", "volume", "name", "pass_index"});
    read_optional(json, "name", material_.name);
    read_optional(json, "pass_index", material_.pass_index);
    if (const auto nodes = json.find("nodes")) {
      nodes->expect_array();
      for (std::size_t i = 0; i < nodes->size(); ++i) entries_.push_back(read_shader(nodes->item(i)));
    }
    if (const auto surface = json.find("surface")) read_input(*surface, material_.surface);
    reads_volume_ = true;
    if (const auto volume = json.find("volume")) read_input(*volume, material_.volume);
  }

  NodeIndex read_shader(const JsonValue& json) {
    return material_.add(read_variant<ShaderNode>(json, [&]<class Shader>(const JsonValue& object, Shader& shader) {
      constexpr bool has_one_color = count_color_inputs<Shader>() == 1;
      object.check_keys(has_one_color ? known_keys<Shader>({"texture_name"}) : known_keys<Shader>());
      read_fields(object, shader, [&]<class Value>(const JsonValue& value, Value& out) {
        if constexpr (std::same_as<Value, ColorInput>)
          read_color(value, out);
        else if constexpr (std::same_as<Value, ShareInput>)
          read_share(value, out);
        else if constexpr (std::same_as<Value, NodeIndex>)
          read_input(value, out);
        else
          read(value, out);
      });
      if constexpr (has_one_color) read_texture_name(object, shader);
    }));
  }

  // A colour, or a texture's name.
  void read_color(const JsonValue& value, ColorInput& out) const {
    if (value.json().is_string())
      out.texture = reader_.textures.resolve(value);
    else
      read(value, out.constant);
  }

  // A number, a texture's name, or {"texture": name, "alpha": true}.
  void read_share(const JsonValue& value, ShareInput& out) const {
    if (value.json().is_string()) {
      out.texture = reader_.textures.resolve(value);
    } else if (value.json().is_object()) {
      value.check_keys(std::array<std::string_view, 2>{"texture", "alpha"});
      out.texture = reader_.textures.resolve(value.require("texture"));
      read_optional(value, "alpha", out.is_alpha);
    } else {
      read(value, out.constant);
    }
  }

  // The assignment's key for the texture of a shader's only colour.
  template <class Shader>
  void read_texture_name(const JsonValue& object, Shader& shader) const {
    const auto texture_name = object.find("texture_name");
    if (!texture_name) return;
    for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
      if constexpr (std::same_as<Value, ColorInput>) {
        if (object.find(field.name)) texture_name->fail("give this or \"" + std::string(field.name) + "\", not both");
        (shader.*field.member).texture = reader_.textures.resolve(*texture_name);
      }
    });
  }

  // What Mix, Add, the surface and the volume refer to: a shader, an earlier material's name, an earlier entry of "nodes",
  // or null.
  void read_input(const JsonValue& value, NodeIndex& out) {
    if (value.json().is_null())
      out = no_node;
    else if (value.json().is_string())
      out = copy_material(reader_.materials.resolve(value));
    else if (value.json().is_number())
      out = find_entry(value);
    else
      out = read_shader(value);
  }

  [[nodiscard]] NodeIndex find_entry(const JsonValue& value) const {
    std::uint32_t entry = 0;
    read(value, entry);
    if (entry >= entries_.size()) value.fail("no node " + std::to_string(entry) + " comes before this");
    return entries_[entry];
  }

  // Materials share no nodes, so each that is referred to is copied, once. Its volume where that is asked for, or where it
  // has nothing else.
  NodeIndex copy_material(Id<Material> id) {
    const auto [copy, is_new] = copies_.try_emplace(id.index);
    if (is_new) copy->second = append_nodes(material_, reader_.scene.materials[id]);
    return reads_volume_ || copy->second.surface == no_node ? copy->second.volume : copy->second.surface;
  }

  const SceneReader& reader_;
  Material& material_;
  bool reads_volume_ = false;
  std::vector<NodeIndex> entries_;                 // the nodes that the entries of "nodes" became
  std::map<std::uint32_t, MaterialRoots> copies_;  // by the other material's index
};

}  // namespace

MaterialRoots append_nodes(Material& material, const Material& other) {
  const auto offset = static_cast<NodeIndex>(material.nodes.size());
  const auto move_index = [&](NodeIndex& index) {
    if (index != no_node) index += offset;
  };
  for (ShaderNode node : other.nodes) {
    std::visit(
        [&]<class Shader>(Shader& shader) {
          for_each_field<Shader>([&]<class Value>(const Field<Shader, Value>& field) {
            if constexpr (std::same_as<Value, NodeIndex>) move_index(shader.*field.member);
          });
        },
        node);
    material.add(node);
  }
  MaterialRoots roots{other.surface, other.volume};
  move_index(roots.surface);
  move_index(roots.volume);
  return roots;
}

void read_materials(SceneReader& reader, const JsonValue& materials) {
  materials.expect_object();
  for (const auto& [name, json] : materials.json().items()) {
    Material material{.name = name, .nodes = {}};
    MaterialReader(reader, material).read_material(materials.member(name));
    reader.materials.add(name, reader.scene.materials.append(std::move(material)));
  }
}

void read_world_volume(SceneReader& reader, const JsonValue& name) {
  reader.scene.world_volume = reader.materials.resolve(name);
}

}  // namespace basicrt
