// SPDX-License-Identifier: GPL-3.0-or-later
// The root of a scene file.
#include "io/scene_json.h"

#include <array>

#include "io/file.h"
#include "io/image_file.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

struct RootKey {
  std::string_view name;
  void (*read)(SceneReader&, const JsonValue&);
};

// In the order in which they are read: names before what refers to them, the picture's size before the camera.
constexpr std::array root_keys = {
    RootKey{"integrator", read_integrator},
    RootKey{"film", read_film},
    RootKey{"settings", read_settings},
    RootKey{"camera", read_camera},
    RootKey{"adjacent_cameras", read_adjacent_cameras},
    RootKey{"images", read_images},
    RootKey{"textures", read_textures},
    RootKey{"materials", read_materials},
    RootKey{"world_volume", read_world_volume},
    // What stands in the scene, and what lights it:
    RootKey{"shapes", read_shapes},
    RootKey{"objects", read_objects},
    RootKey{"lights", read_lights},
    RootKey{"environment_map", read_environment_map},
    RootKey{"environment", read_environment},
    RootKey{"$schema", [](SceneReader&, const JsonValue&) {}},
};

Scene read_scene(const Json& json, SceneReader reader) {
  const JsonValue root(json, "");
  std::vector<std::string_view> names;
  for (const RootKey& key : root_keys) names.push_back(key.name);
  root.check_keys(names);
  for (const RootKey& key : root_keys)
    if (const auto value = root.find(key.name)) key.read(reader, *value);
  if (reader.scene.instances.empty()) reader.report.warn("objects: the scene has none");
  return std::move(reader.scene);
}

}  // namespace

std::filesystem::path SceneReader::resolve_path(const JsonValue& value) const {
  std::string path;
  read(value, path);
  return folder / path;
}

Scene parse_scene(std::string_view text, const std::filesystem::path& folder, std::string_view name, Report& report,
                  const SceneFileOptions& options) {
  Json json = parse_json(text, name);
  if (!options.override_json.empty()) json.merge_patch(parse_json(options.override_json, "override"));
  const ImageReader read_image = options.read_image ? options.read_image : read_image_file;
  return read_scene(json, {.folder = folder, .report = report, .read_image = read_image});
}

Scene load_scene(const std::filesystem::path& path, Report& report, const SceneFileOptions& options) {
  return parse_scene(read_file(path), path.parent_path(), path.string(), report, options);
}

}  // namespace basicrt
