// SPDX-License-Identifier: GPL-3.0-or-later
// Textures: constant, checkerboard, image.
#include <array>

#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

// The assignment's place for scale and delta.
void read_generator(const JsonValue& texture, CheckerboardTexture& out) {
  const auto generator = texture.find("tex_coordinate_generator");
  if (!generator) return;
  generator->check_keys(std::array<std::string_view, 3>{"type", "scale", "delta"});
  if (const auto type = generator->find("type"))
    (void)read_choice(*type, std::array<std::string_view, 1>{"uvmapping2d"}, "type");
  read_optional(*generator, "scale", out.scale);
  read_optional(*generator, "delta", out.delta);
}

Image read_inline_image(const JsonValue& texture) {
  Image image;
  image.width = read_required<int>(texture, "width");
  image.height = read_required<int>(texture, "height");
  image.channels = read_required<int>(texture, "channels");
  const JsonValue pixels = texture.require("pixels");
  read_numbers(pixels, image.pixels);
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4)
    texture.fail("width and height must be at least 1, channels in [1, 4]");
  const double expected = double(image.width) * image.height * image.channels;
  if (double(image.pixels.size()) != expected) pixels.fail_type("an array of width x height x channels numbers");
  return image;
}

struct TextureKindReader {
  SceneReader& reader;

  void operator()(const JsonValue& texture, ConstantTexture& out) const {
    texture.check_keys(known_keys<ConstantTexture>());
    read_fields(texture, out);
  }
  void operator()(const JsonValue& texture, CheckerboardTexture& out) const {
    texture.check_keys(known_keys<CheckerboardTexture>({"tex_coordinate_generator"}));
    read_fields(texture, out);
    read_generator(texture, out);
  }
  void operator()(const JsonValue& texture, ImageTexture& out) const {
    texture.check_keys(known_keys<ImageTexture>({"path", "width", "height", "channels", "pixels"}));
    const auto path = texture.find("path");
    out.image = path ? reader.read_image(reader.resolve_path(*path)) : read_inline_image(texture);
  }
};

}  // namespace

void read_textures(SceneReader& reader, const JsonValue& textures) {
  textures.expect_object();
  for (const auto& [name, json] : textures.json().items()) {
    const JsonValue texture = textures.member(name);
    reader.textures.add(name, reader.scene.textures.append(read_variant<Texture>(texture, TextureKindReader{reader})));
  }
}

}  // namespace basicrt
