// SPDX-License-Identifier: GPL-3.0-or-later
// Weighted sums of samples, and the picture put together from tiles.
#include "film/film.h"

#include <algorithm>

#include "base/assert.h"

namespace basicrt {

TileAccumulator::TileAccumulator(PixelRect rect, PassLayout layout, float negative_mass, bool has_shadow_catchers)
    : rect_(rect),
      layout_(layout),
      negative_mass_(negative_mass),
      pixels_(static_cast<std::size_t>(rect.width) * rect.height),
      negative_(negative_mass > 0 ? pixels_.size() : 0),
      catchers_(has_shadow_catchers ? pixels_.size() : 0) {}

void TileAccumulator::add(int x, int y, const PixelSample& sample, bool is_negative) {
  const std::size_t index = static_cast<std::size_t>(y) * rect_.width + x;
  Pixel& pixel = pixels_[index];
  Sums& sums = is_negative ? negative_[index] : pixel.positive;
  ++sums.count;
  sums.radiance += sample.radiance;
  sums.alpha += sample.alpha;
  if (!catchers_.empty() && !is_negative) {
    CatcherSample& catcher = catchers_[index];
    catcher.lit += sample.catcher.lit;
    catcher.unlit += sample.catcher.unlit;
    catcher.behind += sample.catcher.behind;
    catcher.hole += sample.catcher.hole;
  }
  if (!sample.has_hit) return;
  sums.normal += sample.normal;
  if (pixel.depth == pass_info(Pass::depth).background) pixel.depth = sample.depth;
}

TileAccumulator::Mean TileAccumulator::mean(std::size_t index) const {
  const auto mean_of = [](const Sums& sums) {
    const float scale = sums.count > 0 ? 1 / static_cast<float>(sums.count) : 0;
    return Mean{sums.radiance * scale, sums.alpha * scale, sums.normal * scale};
  };
  const Sums& positive = pixels_[index].positive;
  if (negative_.empty() || negative_[index].count == 0) return mean_of(positive);
  const Mean n = mean_of(negative_[index]);
  if (positive.count == 0) return n;
  const Mean p = mean_of(positive);
  return {p.radiance + (p.radiance - n.radiance) * negative_mass_, p.alpha + (p.alpha - n.alpha) * negative_mass_,
          p.normal + (p.normal - n.normal) * negative_mass_};
}

// What is behind catchers is darkened by the share of their light that is left, in the mean of the channels: what one of
// them gains from coloured objects makes up for what another loses.
void TileAccumulator::add_behind_catchers(Mean& mean, std::size_t index) const {
  const CatcherSample& sums = catchers_[index];
  float share = 0;
  for (int i = 0; i < 3; ++i) share += sums.unlit[i] > 0 ? sums.lit[i] / sums.unlit[i] / 3 : 1.0f / 3;
  const float scale = std::min(share, 1.0f) / static_cast<float>(std::max(pixels_[index].positive.count, 1));
  mean.radiance += sums.behind * scale;
  mean.alpha -= sums.hole * scale;
}

Tile TileAccumulator::finish() const {
  Tile tile{rect_, layout_, std::vector<float>(pixels_.size() * layout_.channel_count())};
  float* out = tile.values.data();
  const auto write = [&](Pass pass, auto&& values_of) {
    if (!layout_.has(pass)) return;
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      for (const float value : values_of(i)) *out++ = value;
  };
  // In the order of the table.
  write(Pass::combined, [&](std::size_t i) {
    Mean m = mean(i);
    if (!catchers_.empty()) add_behind_catchers(m, i);
    return std::array{m.radiance.x, m.radiance.y, m.radiance.z, m.alpha};
  });
  write(Pass::depth, [&](std::size_t i) { return std::array{pixels_[i].depth}; });
  write(Pass::normal, [&](std::size_t i) {
    const Mean m = mean(i);
    return std::array{m.normal.x, m.normal.y, m.normal.z};
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
