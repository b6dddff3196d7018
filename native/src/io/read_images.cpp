// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures: in a table of their own, or where they are used.
#include <array>
#include <limits>

#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

std::vector<std::uint8_t> read_bytes(const JsonValue& json) {
  std::vector<std::uint32_t> numbers;
  read_numbers(json, numbers);
  for (const std::uint32_t number : numbers)
    if (number > std::numeric_limits<std::uint8_t>::max())
      json.fail("must be in [0, 255], is " + std::to_string(number));
  return {numbers.begin(), numbers.end()};
}

Image read_inline_image(const JsonValue& json) {
  Image image;
  image.width = read_required<int>(json, "width");
  image.height = read_required<int>(json, "height");
  image.channels = read_required<int>(json, "channels");
  const bool has_bytes = json.find("bytes").has_value();
  const JsonValue pixels = json.require(has_bytes ? "bytes" : "pixels");
  if (has_bytes) {
    if (json.find("pixels")) pixels.fail("give this or \"pixels\", not both");
    image.bytes = read_bytes(pixels);
    read_optional(json, "encoding", image.encoding);
  } else {
    std::vector<float> numbers;
    read_numbers(pixels, numbers);
    image.pixels = std::move(numbers);
  }
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4)
    json.fail("width and height must be at least 1, channels in [1, 4]");
  const double expected = double(image.width) * image.height * image.channels;
  if (double(image.pixels.size() + image.bytes.size()) != expected)
    pixels.fail_type("an array of width x height x channels numbers");
  return image;
}

}  // namespace

Image read_image_value(SceneReader& reader, const JsonValue& json) {
  const auto path = json.find("path");
  return path ? reader.read_image(reader.resolve_path(*path)) : read_inline_image(json);
}

Image read_image(SceneReader& reader, const JsonValue& value) {
  if (value.json().is_string()) return reader.image_table[reader.images.resolve(value)];
  value.check_keys(image_keys);
  return read_image_value(reader, value);
}

void read_images(SceneReader& reader, const JsonValue& images) {
  images.expect_object();
  for (const auto& [name, json] : images.json().items()) {
    const JsonValue image = images.member(name);
    image.check_keys(image_keys);
    reader.images.add(name, reader.image_table.append(read_image_value(reader, image)));
  }
}

}  // namespace basicrt
