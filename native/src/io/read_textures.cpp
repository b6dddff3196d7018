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
    std::vector<std::string_view> keys = known_keys<ImageTexture>({"image"});
    keys.insert(keys.end(), image_keys.begin(), image_keys.end());
    texture.check_keys(keys);
    read_fields(texture, out);
    const auto image = texture.find("image");
    if (!image) {
      out.image = read_image_value(reader, texture);
      return;
    }
    for (const std::string_view key : image_keys)
      if (const auto other = texture.find(key)) other->fail("give this or \"image\", not both");
    out.image = read_image(reader, *image);
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
