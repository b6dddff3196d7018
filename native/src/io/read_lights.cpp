// SPDX-License-Identifier: GPL-3.0-or-later
// Lamps and the environment.
#include <array>
#include <variant>

#include "base/overloaded.h"
#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

Color average_color(const Image& image) {
  Vec3d sum(0.0);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* pixel = image.pixel(x, y);
      sum += image.channels < 3 ? Vec3d(pixel[0]) : Vec3d(pixel[0], pixel[1], pixel[2]);
    }
  }
  return Color(sum * (1.0 / (double(image.width) * image.height)));
}

Color average_color(const Texture& texture) {
  return std::visit(Overloaded{[](const ConstantTexture& constant) { return constant.color; },
                               [](const CheckerboardTexture& board) { return 0.5f * (board.color0 + board.color1); },
                               [](const ImageTexture& image) { return average_color(image.image); }},
                    texture);
}

}  // namespace

void read_lights(SceneReader& reader, const JsonValue& lights) {
  lights.expect_array();
  for (std::size_t i = 0; i < lights.size(); ++i) reader.scene.lights.append(read_plain_variant<Light>(lights.item(i)));
}

void read_environment(SceneReader& reader, const JsonValue& environment) {
  environment.check_keys(known_keys<Environment>());
  read_fields(environment, reader.scene.environment);
}

// The assignment's environment. Only constant ones can be rendered yet.
void read_environment_map(SceneReader& reader, const JsonValue& map) {
  map.check_keys(std::array<std::string_view, 3>{"texture_name", "scale", "transform"});
  const JsonValue name = map.require("texture_name");
  const Texture& texture = reader.scene.textures[reader.textures.resolve(name)];
  if (!std::holds_alternative<ConstantTexture>(texture))
    name.warn(reader.report, "an environment that varies can't be rendered yet: its average is used");

  Color scale(1.0f);
  if (const auto value = map.find("scale")) {
    if (value->json().is_number()) {
      float number = 0;
      read(*value, number);
      scale = Color(number);
    } else {
      read(*value, scale);
    }
  }
  Transform ignored;  // turns what is the same in every direction
  read_optional(map, "transform", ignored);
  reader.scene.environment.radiance = scale * average_color(texture);
  validate_fields(reader.scene.environment, map.path());
}

}  // namespace basicrt
