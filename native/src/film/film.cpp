// SPDX-License-Identifier: GPL-3.0-or-later
// Weighted sums of samples, and the picture put together from tiles.
#include "film/film.h"

#include <algorithm>
#include <array>
#include <bit>

#include "base/assert.h"

namespace basicrt {

namespace {

std::vector<bool> find_first_hit_values(PassLayout recorded) {
  std::vector<bool> is_first;
  for (const PassInfo& info : passes)
    if (recorded.has(info.pass))
      is_first.insert(is_first.end(), static_cast<std::size_t>(recorded_size(info)), info.rule == PassRule::first);
  return is_first;
}

}  // namespace

TileAccumulator::TileAccumulator(PixelRect rect, PassLayout layout, AccumulatorOptions options)
    : rect_(rect),
      layout_(layout),
      recorded_(recorded_passes(layout)),
      options_(options),
      value_count_(static_cast<std::size_t>(recorded_count(recorded_))),
      is_first_(find_first_hit_values(recorded_)),
      pixels_(static_cast<std::size_t>(rect.width) * rect.height),
      negative_(options.negative_mass > 0 ? pixel_count() : 0),
      catchers_(options.has_shadow_catchers ? pixel_count() : 0),
      values_(pixel_count() * value_count_),
      negative_values_(negative_.size() * value_count_),
      mattes_(layout.has(PassRule::matte) ? pixel_count() * matte_kinds : 0) {
  for (const PassInfo& info : passes)
    value_offsets_[static_cast<std::size_t>(info.pass)] =
        static_cast<std::size_t>(recorded_offset(recorded_, info.pass));
  sum_count_ = 0;
  if (!pixels_.empty()) visit_sums(0, [&](float&) { ++sum_count_; });
  if (options.samples > sample_block) exact_.resize(pixel_count() * sum_count_);
}

void TileAccumulator::add(int x, int y, const PixelSample& sample, bool is_negative, std::span<const float> values) {
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
  const bool is_first = sample.has_hit && pixel.depth == pass_info(Pass::depth).background;
  if (!values.empty()) add_values(index, values, is_negative, is_first);
  if (sample.has_hit) {
    sums.normal += sample.normal;
    if (is_first) pixel.depth = sample.depth;
  }
  if (!exact_.empty() && (pixel.positive.count + (negative_.empty() ? 0 : negative_[index].count)) % sample_block == 0)
    fold_block(index);
}

void TileAccumulator::add_values(std::size_t index, std::span<const float> values, bool is_negative, bool is_first) {
  float* kept = values_.data() + index * value_count_;
  float* sums = is_negative ? negative_values_.data() + index * value_count_ : kept;
  for (std::size_t i = 0; i < value_count_; ++i) {
    if (!is_first_[i])
      sums[i] += values[i];
    else if (is_first)
      kept[i] = values[i];
  }
}

void TileAccumulator::add_matte(int x, int y, const MatteSample& matte) {
  const std::size_t index = static_cast<std::size_t>(y) * rect_.width + x;
  for (std::size_t kind = 0; kind < matte_kinds; ++kind) {
    std::vector<Matte>& known = mattes_[index * matte_kinds + kind];
    const auto found = std::ranges::find(known, matte.ids[kind], &Matte::id);
    if (found != known.end())
      found->coverage += matte.coverage;
    else
      known.push_back({matte.ids[kind], matte.coverage});
  }
}

void TileAccumulator::visit_sums(std::size_t index, auto&& visit) {
  const auto visit_color = [&](Vec3f& color) {
    for (int i = 0; i < 3; ++i) visit(color[i]);
  };
  const auto visit_sign = [&](Sums& sums, float* values) {
    visit(sums.alpha);
    visit_color(sums.radiance);
    visit_color(sums.normal);
    for (std::size_t i = 0; i < value_count_; ++i)
      if (!is_first_[i]) visit(values[i]);
  };
  visit_sign(pixels_[index].positive, values_.data() + index * value_count_);
  if (!negative_.empty()) visit_sign(negative_[index], negative_values_.data() + index * value_count_);
  if (catchers_.empty()) return;
  CatcherSample& catcher = catchers_[index];
  visit_color(catcher.lit);
  visit_color(catcher.unlit);
  visit_color(catcher.behind);
  visit(catcher.hole);
}

void TileAccumulator::visit_first(std::size_t index, auto&& visit) {
  visit(pixels_[index].depth);
  for (std::size_t i = 0; i < value_count_; ++i)
    if (is_first_[i]) visit(values_[index * value_count_ + i]);
}

void TileAccumulator::fold_block(std::size_t index) {
  ExactSum* exact = exact_.data() + index * sum_count_;
  visit_sums(index, [&](float& sum) {
    (exact++)->add(sum);
    sum = 0;
  });
}

// Puts all blocks' sums where the last block's are.
void TileAccumulator::sum_blocks() {
  if (exact_.empty()) return;
  for (std::size_t index = 0; index < pixel_count(); ++index) {
    fold_block(index);
    const ExactSum* exact = exact_.data() + index * sum_count_;
    visit_sums(index, [&](float& sum) { sum = (exact++)->to_float(); });
  }
}

std::size_t TileAccumulator::words_per_pixel() const {
  const auto first = static_cast<std::size_t>(std::ranges::count(is_first_, true));
  return (negative_.empty() ? 1 : 2) + 1 + first + sum_count_ * ExactSum::word_count;
}

std::vector<std::uint32_t> TileAccumulator::take_words() {
  BASICRT_ASSERT(!exact_.empty());
  std::vector<std::uint32_t> words;
  words.reserve(pixel_count() * words_per_pixel());
  for (std::size_t index = 0; index < pixel_count(); ++index) {
    fold_block(index);
    words.push_back(static_cast<std::uint32_t>(pixels_[index].positive.count));
    if (!negative_.empty()) words.push_back(static_cast<std::uint32_t>(negative_[index].count));
    visit_first(index, [&](float& value) { words.push_back(std::bit_cast<std::uint32_t>(value)); });
    for (std::size_t i = 0; i < sum_count_; ++i)
      for (const std::uint32_t word : exact_[index * sum_count_ + i].words()) words.push_back(word);
  }
  return words;
}

void TileAccumulator::add_words(std::span<const std::uint32_t> words) {
  BASICRT_ASSERT(!exact_.empty() && words.size() == pixel_count() * words_per_pixel());
  const std::uint32_t* word = words.data();
  for (std::size_t index = 0; index < pixel_count(); ++index) {
    Pixel& pixel = pixels_[index];
    pixel.positive.count += static_cast<int>(*word++);
    if (!negative_.empty()) negative_[index].count += static_cast<int>(*word++);
    const bool has_hit = pixel.depth != pass_info(Pass::depth).background;
    visit_first(index, [&](float& value) {
      if (!has_hit) value = std::bit_cast<float>(*word);
      ++word;
    });
    for (std::size_t i = 0; i < sum_count_; ++i, word += ExactSum::word_count)
      exact_[index * sum_count_ + i].add(ExactSum::from_words(word));
  }
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
  const float mass = options_.negative_mass;
  return {p.radiance + (p.radiance - n.radiance) * mass, p.alpha + (p.alpha - n.alpha) * mass,
          p.normal + (p.normal - n.normal) * mass};
}

// The same of a recorded value.
float TileAccumulator::mean_value(std::size_t index, Pass pass, std::size_t channel) const {
  const std::size_t place = index * value_count_ + value_offsets_[static_cast<std::size_t>(pass)] + channel;
  const auto mean_of = [](float sum, int count) { return count > 0 ? sum / static_cast<float>(count) : 0; };
  const int positive = pixels_[index].positive.count, negative = negative_.empty() ? 0 : negative_[index].count;
  const float p = mean_of(values_[place], positive);
  if (negative == 0) return p;
  const float n = mean_of(negative_values_[place], negative);
  return positive == 0 ? n : p + (p - n) * options_.negative_mass;
}

// Without what a filter's negative lobes see: the mean of few samples would be out of all bounds.
float TileAccumulator::mean_of_some(std::size_t index, const PassInfo& info, std::size_t channel) const {
  const std::size_t place = index * value_count_ + value_offsets_[static_cast<std::size_t>(info.pass)];
  for (const std::vector<float>* values : {&values_, &negative_values_}) {
    if (values->empty()) continue;
    const float count = (*values)[place + info.channels.size()];
    if (count > 0) return (*values)[place + channel] / count;
  }
  return 0;
}

// The share of catchers' light that others leave.
Color TileAccumulator::catcher_share(std::size_t index) const {
  if (catchers_.empty()) return Color(1.0f);
  const CatcherSample& sums = catchers_[index];
  Color share;
  for (int i = 0; i < 3; ++i) share[i] = sums.unlit[i] > 0 ? sums.lit[i] / sums.unlit[i] : 1.0f;
  return share;
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

void TileAccumulator::write_values(const PassInfo& info, std::size_t index, float* out) const {
  for (std::size_t c = 0; c < info.channels.size(); ++c) {
    if (info.rule == PassRule::first) {
      out[c] = values_[index * value_count_ + value_offsets_[static_cast<std::size_t>(info.pass)] + c];
      continue;
    }
    out[c] = info.rule == PassRule::some ? mean_of_some(index, info, c) : mean_value(index, info.pass, c);
    if (!info.color) continue;
    const float color = mean_value(index, *info.color, c);
    out[c] = color != 0 ? out[c] / color : 0;
  }
}

void TileAccumulator::rank_mattes() {
  for (std::vector<Matte>& known : mattes_)
    std::ranges::sort(known, [](const Matte& a, const Matte& b) {
      return a.coverage != b.coverage ? a.coverage > b.coverage : a.id < b.id;
    });
}

// What is left of the ranks stays empty.
void TileAccumulator::write_mattes(const PassInfo& info, std::size_t index, float* out) const {
  const auto number = static_cast<std::size_t>(info.pass) - static_cast<std::size_t>(Pass::crypto_object);
  const std::vector<Matte>& ranked = mattes_[index * matte_kinds + number / matte_passes];
  const float scale = 1 / static_cast<float>(std::max(pixels_[index].positive.count, 1));
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t rank = number % matte_passes * 2 + i;
    if (rank >= ranked.size()) break;
    out[2 * i] = std::bit_cast<float>(ranked[rank].id);
    out[2 * i + 1] = ranked[rank].coverage * scale;
  }
}

Tile TileAccumulator::finish() {
  sum_blocks();
  rank_mattes();
  Tile tile{rect_, layout_, std::vector<float>(pixel_count() * layout_.channel_count())};
  float* out = tile.values.data();
  const auto write_own = [&](Pass pass, std::size_t i) {
    switch (pass) {
      case Pass::combined: {
        Mean m = mean(i);
        if (!catchers_.empty()) add_behind_catchers(m, i);
        std::ranges::copy(std::array{m.radiance.x, m.radiance.y, m.radiance.z, m.alpha}, out);
        break;
      }
      case Pass::depth:
        *out = pixels_[i].depth;
        break;
      case Pass::normal: {
        const Mean m = mean(i);
        std::ranges::copy(std::array{m.normal.x, m.normal.y, m.normal.z}, out);
        break;
      }
      case Pass::mist:  // what was summed is clearness
        *out = 1 - mean_value(i, pass, 0);
        break;
      case Pass::shadow_catcher: {
        const Color share = catcher_share(i);
        std::ranges::copy(std::array{share.x, share.y, share.z}, out);
        break;
      }
      default:  // Debug Sample Count is, as in Cycles, the share of the samples that there may be
        *out = static_cast<float>(pixels_[i].positive.count + (negative_.empty() ? 0 : negative_[i].count)) /
               static_cast<float>(options_.samples);
    }
  };
  for (const PassInfo& info : passes) {
    if (!layout_.has(info.pass)) continue;
    for (std::size_t i = 0; i < pixel_count(); ++i, out += info.channels.size()) {
      if (info.rule == PassRule::own)
        write_own(info.pass, i);
      else if (info.rule == PassRule::matte)
        write_mattes(info, i, out);
      else
        write_values(info, i, out);
    }
  }
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

template <class Value>
void Film::write_rows(const PixelRect& rect, std::size_t row_size, const Value* from, std::vector<Value>& to) const {
  const std::size_t channels = row_size / rect.width;
  for (int y = 0; y < rect.height; ++y)
    std::copy_n(from + y * row_size, row_size,
                to.data() + (static_cast<std::size_t>(rect.y + y) * width_ + rect.x) * channels);
}

void Film::write(const Tile& tile) {
  for (const PassInfo& info : passes) {
    if (!layout_.has(info.pass)) continue;
    const std::size_t row_size = info.channels.size() * tile.rect.width;
    write_rows(tile.rect, row_size, tile.values.data() + tile.pass_begin(info.pass),
               values_[static_cast<std::size_t>(info.pass)]);
  }
  if (tile.sums.empty()) return;
  const std::size_t row_size = tile.sums.size() / tile.rect.height;
  sums_.resize(row_size / tile.rect.width * width_ * height_);
  write_rows(tile.rect, row_size, tile.sums.data(), sums_);
}

}  // namespace basicrt
