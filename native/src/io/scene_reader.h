// SPDX-License-Identifier: GPL-3.0-or-later
// What the readers of a scene file's parts share: the scene that is being made, and where its names lead.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/report.h"
#include "io/json_value.h"
#include "io/scene_json.h"
#include "scene/scene.h"

namespace basicrt {

// The names that a file gives to a table's entries.
template <class T>
class Names {
 public:
  // "material", for messages.
  explicit Names(std::string_view what) : what_(what) {}

  void add(const std::string& name, Id<T> id) { ids_.emplace(name, id); }
  // Of the entry whose name `value` is.
  [[nodiscard]] Id<T> resolve(const JsonValue& value) const {
    std::string name;
    read(value, name);
    if (const auto found = ids_.find(name); found != ids_.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [known_name, id] : ids_) known.push_back(known_name);
    value.fail("no " + what_ + " is named \"" + name + "\"; " + suggest(name, known));
  }

 private:
  std::string what_;
  std::map<std::string, Id<T>> ids_;
};

struct SceneReader {
  std::filesystem::path folder;  // relative paths start here
  Report& report;
  ImageReader read_image;

  Scene scene{};
  Table<Image> image_table{};  // which textures and the environment share
  Names<Image> images{"image"};
  Names<Texture> textures{"texture"};
  Names<Material> materials{"material"};
  Names<Shape> shapes{"shape"};
  std::map<std::filesystem::path, Id<Shape>> obj_shapes{};  // each file is read once

  [[nodiscard]] std::filesystem::path resolve_path(const JsonValue& value) const;
};

// The keys of an image where it is given.
inline constexpr std::array<std::string_view, 7> image_keys = {"path",   "width", "height",  "channels",
                                                               "pixels", "bytes", "encoding"};
// From an object with these keys, and perhaps others.
[[nodiscard]] Image read_image_value(SceneReader& reader, const JsonValue& json);
// From such an object and no other keys, or by its name.
[[nodiscard]] Image read_image(SceneReader& reader, const JsonValue& value);

// Where a material's graphs end.
struct MaterialRoots {
  NodeIndex surface = no_node, volume = no_node;
};
// Appends copies of the nodes of `other`; returns where its roots are now.
MaterialRoots append_nodes(Material& material, const Material& other);

// An object with a "type": its shape is appended (or found, for an OBJ file that was read before). `extra_keys` are
// known to the caller.
Id<Shape> read_shape(SceneReader& reader, const JsonValue& object, std::span<const std::string_view> extra_keys);

// One function for each key of the root, given that key's value.
void read_images(SceneReader& reader, const JsonValue& images);
void read_textures(SceneReader& reader, const JsonValue& textures);
void read_materials(SceneReader& reader, const JsonValue& materials);
void read_world_volume(SceneReader& reader, const JsonValue& name);
void read_shapes(SceneReader& reader, const JsonValue& shapes);
void read_objects(SceneReader& reader, const JsonValue& objects);
void read_lights(SceneReader& reader, const JsonValue& lights);
void read_environment(SceneReader& reader, const JsonValue& environment);
void read_environment_map(SceneReader& reader, const JsonValue& environment_map);
void read_integrator(SceneReader& reader, const JsonValue& integrator);
void read_film(SceneReader& reader, const JsonValue& film);
void read_settings(SceneReader& reader, const JsonValue& settings);
void read_camera(SceneReader& reader, const JsonValue& camera);
void read_adjacent_cameras(SceneReader& reader, const JsonValue& cameras);

}  // namespace basicrt
