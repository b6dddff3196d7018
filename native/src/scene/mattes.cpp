// SPDX-License-Identifier: GPL-3.0-or-later
// Names of the objects, materials and assets that a scene has in it.
#include "scene/mattes.h"

#include <set>

#include "film/cryptomatte.h"
#include "film/pass_values.h"

namespace basicrt {
namespace {

std::set<std::string> names_of(const Scene& scene, MatteKind kind) {
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (kind != MatteKind::material)
      names.insert(kind == MatteKind::object ? instance.name : asset_name(instance));
    else
      for (const Id<Material> id : instance.materials)
        if (id.is_valid()) names.insert(scene.materials[id].name);
  }
  return names;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> matte_metadata(const Scene& scene, std::string_view prefix) {
  std::vector<std::pair<std::string, std::string>> entries;
  for (const MatteKind kind : {MatteKind::object, MatteKind::material, MatteKind::asset}) {
    const PassInfo& first = pass_info(first_matte_pass(kind));
    if (!scene.settings.passes.has(first.pass)) continue;
    const std::string layer = std::string(prefix) + std::string(first.name.substr(0, first.name.size() - 2));
    for (auto& entry : matte_metadata(layer, names_of(scene, kind))) entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace basicrt
