// SPDX-License-Identifier: GPL-3.0-or-later
// Weighted sums of samples, and the picture put together from tiles.
#include "film/film.h"

#include <algorithm>

#include "base/assert.h"

namespace basicrt {

TileAccumulator::TileAccumulator(PixelRect rect, PassLayout layout)
    : rect_(rect), layout_(layout), pixels_(static_cast<std::size_t>(rect.width) * rect.height) {}

void TileAccumulator::add(int x, int y, const PixelSample& sample, float weight) {
  Pixel& pixel = pixels_[static_cast<std::size_t>(y) * rect_.width + x];
  pixel.weight += weight;
  pixel.radiance += sample.radiance * weight;
  pixel.alpha += sample.alpha * weight;
  if (!sample.has_hit) return;
  pixel.normal += sample.normal * weight;
  if (!pixel.has_hit) pixel.depth = sample.depth;
  pixel.has_hit = true;
}

Tile TileAccumulator::finish() const {
  Tile tile{rect_, layout_, std::vector<float>(pixels_.size() * layout_.channel_count())};
  float* out = tile.values.data();
  const auto write = [&](Pass pass, auto&& values_of) {
    if (!layout_.has(pass)) return;
    for (const Pixel& pixel : pixels_)
      for (const float value : values_of(pixel, pixel.weight != 0 ? 1 / pixel.weight : 0.0f)) *out++ = value;
  };
  // In the order of the table.
  write(Pass::combined, [](const Pixel& p, float scale) {
    return std::array{p.radiance.x * scale, p.radiance.y * scale, p.radiance.z * scale, p.alpha * scale};
  });
  write(Pass::depth,
        [](const Pixel& p, float) { return std::array{p.has_hit ? p.depth : pass_info(Pass::depth).background}; });
  write(Pass::normal, [](const Pixel& p, float scale) {
    return std::array{p.normal.x * scale, p.normal.y * scale, p.normal.z * scale};
  });
  BASICRT_ASSERT(out == tile.values.data() + tile.values.size());
  return tile;
}

Film::Film(int width, int height, PassLayout layout) : width_(width), height_(height), layout_(layout) {
  for (const PassInfo& info : passes) {
    const std::size_t count =
        layout.has(info.pass) ? static_cast<std::size_t>(width) * height * info.channels.size() : 0;
    values_.emplace_back(count, info.background);
  }
}

void Film::write(const Tile& tile) {
  for (const PassInfo& info : passes) {
    if (!layout_.has(info.pass)) continue;
    const std::size_t channels = info.channels.size(), row_size = tile.rect.width * channels;
    const float* from = tile.values.data() + tile.pass_begin(info.pass);
    float* to = values_[static_cast<std::size_t>(info.pass)].data();
    for (int y = 0; y < tile.rect.height; ++y)
      std::copy_n(from + y * row_size, row_size,
                  to + (static_cast<std::size_t>(tile.rect.y + y) * width_ + tile.rect.x) * channels);
  }
}

}  // namespace basicrt
