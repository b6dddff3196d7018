// SPDX-License-Identifier: GPL-3.0-or-later
// Scene files: the assignment's JSON with our additions (docs/scene_format.md, docs/scene.schema.json).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "base/report.h"
#include "scene/scene.h"

namespace basicrt {

// Reads an image file into scene-linear floats; throws SceneError. The default reads what stb_image reads.
using ImageReader = std::function<Image(const std::filesystem::path&)>;

struct SceneFileOptions {
  std::string override_json;  // merged into the file's JSON before it is read (RFC 7386); empty: nothing
  ImageReader read_image;     // empty: read_image_file
};

// Throws SceneError: for malformed JSON with line and column, for an unknown key or type with the nearest valid name.
[[nodiscard]] Scene load_scene(const std::filesystem::path& path, Report& report, const SceneFileOptions& options = {});
// The same from text; relative paths in it are relative to `folder`. `name` stands for the file in messages.
[[nodiscard]] Scene parse_scene(std::string_view json, const std::filesystem::path& folder, std::string_view name,
                                Report& report, const SceneFileOptions& options = {});

// One file with everything in it, numbers to the last bit: load_scene gives the same picture, byte for byte. Throw SceneError
// for what validate_description() refuses or a file that can't be written.
void save_scene(const Scene& scene, const std::filesystem::path& path);
[[nodiscard]] std::string scene_to_json(const Scene& scene);

}  // namespace basicrt
