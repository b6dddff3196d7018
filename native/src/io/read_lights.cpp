// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps and the environment.
#include <array>
#include <cmath>
#include <concepts>
#include <variant>

#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

EnvironmentLayer read_layer(SceneReader& reader, const JsonValue& json) {
  EnvironmentLayer layer;
  json.check_keys(known_keys<EnvironmentLayer>({"image", "sky"}));
  read_fields(json, layer);
  if (const auto image = json.find("image")) layer.image = read_image(reader, *image);
  if (const auto sky = json.find("sky")) layer.sky = read_plain_variant<Sky>(*sky);
  return layer;
}

// A number for all channels, or one for each.
Color read_scale(const JsonValue& map) {
  Color scale(1.0f);
  const auto value = map.find("scale");
  if (!value) return scale;
  if (value->json().is_number()) {
    float number = 0;
    read(*value, number);
    return Color(number);
  }
  read(*value, scale);
  return scale;
}

}  // namespace

void read_lights(SceneReader& reader, const JsonValue& lights) {
  lights.expect_array();
  const auto read_light = [&]<class Kind>(const JsonValue& object, Kind& light) {
    object.check_keys(known_keys<Kind>());
    read_fields(object, light, [&]<class Value>(const JsonValue& value, Value& out) {
      if constexpr (std::same_as<Value, Id<Material>>)
        out = reader.materials.resolve(value);
      else
        read(value, out);
    });
  };
  for (std::size_t i = 0; i < lights.size(); ++i)
    reader.scene.lights.append(read_variant<Light>(lights.item(i), read_light));
}

void read_environment(SceneReader& reader, const JsonValue& json) {
  Environment& environment = reader.scene.environment;
  json.check_keys(known_keys<Environment>({"layers"}));
  read_fields(json, environment);
  const auto layers = json.find("layers");
  if (!layers) return;
  layers->expect_array();
  environment.layers.clear();
  for (std::size_t i = 0; i < layers->size(); ++i) environment.layers.push_back(read_layer(reader, layers->item(i)));
}

// The assignment's environment: its y axis points up and its image's middle is seen along -z. A checkerboard has no
// place on the sky, and is replaced by its average.
void read_environment_map(SceneReader& reader, const JsonValue& map) {
  map.check_keys(std::array<std::string_view, 3>{"texture_name", "scale", "transform"});
  const JsonValue name = map.require("texture_name");
  const Texture& texture = reader.scene.textures[reader.textures.resolve(name)];
  const Color scale = read_scale(map);
  Transform to_world;
  read_optional(map, "transform", to_world);

  Environment& environment = reader.scene.environment;
  if (const auto* image = std::get_if<ImageTexture>(&texture)) {
    if (std::abs(to_world.determinant()) == 0) map.require("transform").fail("is singular: it has no inverse");
    // To x ahead and z up.
    const Transform from_assignment({{{0, 0, -1, 0}, {-1, 0, 0, 0}, {0, 1, 0, 0}}});
    for (auto& row : to_world.rows) row[3] = 0;  // a sky has no place
    environment.layers = {{.radiance = scale,
                           .image = image->image,
                           .interpolation = image->interpolation,
                           .to_image = from_assignment * inverse(to_world)}};
    validate_fields(environment.layers[0], map.path());
    return;
  }
  if (const auto* board = std::get_if<CheckerboardTexture>(&texture)) {
    name.warn(reader.report, "only an image can surround the scene: the checkerboard's average is used");
    environment.radiance = scale * 0.5f * (board->color0 + board->color1);
  } else {
    environment.radiance = scale * std::get<ConstantTexture>(texture).color;
  }
  validate_fields(environment, map.path());
}

}  // namespace basicrt
