// SPDX-License-Identifier: GPL-3.0-or-later
// Images through stb_image.
#include "io/image_file.h"

#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

#include <array>
#include <cstdint>
#include <memory>

#include "base/error.h"
#include "io/file.h"

namespace basicrt {
namespace {

struct StbDeleter {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};
template <class Sample>
using StbPixels = std::unique_ptr<Sample, StbDeleter>;

// stb's rows run downwards, ours upwards.
template <class Sample, class ToLinear>
void copy_pixels(Image& image, const Sample* samples, ToLinear&& to_linear) {
  const std::size_t row = static_cast<std::size_t>(image.width) * image.channels;
  std::vector<float> linear(row * image.height);
  for (int y = 0; y < image.height; ++y)
    for (std::size_t i = 0; i < row; ++i)
      linear[(image.height - 1 - y) * row + i] = to_linear(samples[y * row + i], static_cast<int>(i % image.channels));
  image.pixels = std::move(linear);
}

// Alpha, the last of two or four channels, is not encoded.
template <class Sample>
void copy_encoded(Image& image, const Sample* samples) {
  constexpr std::size_t count = std::size_t{std::numeric_limits<Sample>::max()} + 1;
  std::vector<float> linear(count);
  for (std::size_t i = 0; i < count; ++i) linear[i] = srgb_to_linear(static_cast<float>(i) / float(count - 1));
  const int alpha = image.channels % 2 == 0 ? image.channels - 1 : -1;
  copy_pixels(image, samples, [&](Sample sample, int channel) {
    return channel == alpha ? static_cast<float>(sample) / float(count - 1) : linear[sample];
  });
}

}  // namespace

Image read_image_file(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw SceneError(path.string(), "is too large");
  const int size = static_cast<int>(bytes.size());

  Image image;
  image.path = path.string();
  int* const shape[3] = {&image.width, &image.height, &image.channels};
  const auto check = [&](const void* pixels) {
    if (!pixels) throw SceneError(path.string(), std::string("can't be read as an image: ") + stbi_failure_reason());
  };
  if (stbi_is_hdr_from_memory(data, size)) {
    const StbPixels<float> pixels(stbi_loadf_from_memory(data, size, shape[0], shape[1], shape[2], 0));
    check(pixels.get());
    copy_pixels(image, pixels.get(), [](float sample, int) { return sample; });
  } else if (stbi_is_16_bit_from_memory(data, size)) {
    const StbPixels<std::uint16_t> pixels(stbi_load_16_from_memory(data, size, shape[0], shape[1], shape[2], 0));
    check(pixels.get());
    copy_encoded(image, pixels.get());
  } else {
    const StbPixels<std::uint8_t> pixels(stbi_load_from_memory(data, size, shape[0], shape[1], shape[2], 0));
    check(pixels.get());
    copy_encoded(image, pixels.get());
  }
  return image;
}

}  // namespace basicrt
