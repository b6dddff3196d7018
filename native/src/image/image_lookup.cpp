// SPDX-License-Identifier: GPL-3.0-or-later
// Weighs the pixels around a place: one, two or four along each axis.
#include "image/image_lookup.h"

#include <algorithm>
#include <cmath>

namespace basicrt {
namespace {

// What all pixels of a picture are read as before they are decoded.
struct Sum {
  float r = 0, g = 0, b = 0, a = 0;

  template <class Sample>
  void add(const Sample* p, int channels, float weight) {
    const auto value = [&](int channel) { return weight * static_cast<float>(p[channel]); };
    if (channels >= 3) {
      r += value(0), g += value(1), b += value(2);
      if (channels == 4) a += value(3);
    } else {
      r += value(0);
      if (channels == 2) a += value(1);
    }
  }
};

// The pixels along one axis that have a share in a place; an index of -1 is beyond the edge and nothing.
struct Taps {
  int count = 0;
  std::array<int, 4> index{};
  std::array<float, 4> weight{};
};

// A coordinate that differs from the given one by what the extension makes no difference of: near the picture, so
// that it fits into an integer. NaN becomes an edge.
float reduce(float coordinate, ImageExtension extension) {
  switch (extension) {
    case ImageExtension::repeat:
      coordinate -= std::floor(coordinate);
      break;
    case ImageExtension::mirror:
      coordinate -= 2 * std::floor(coordinate / 2);
      break;
    case ImageExtension::extend:
    case ImageExtension::clip:
      break;
  }
  // Two pictures away is beyond the reach of any tap, but of those of tiny pictures: they reach two pixels.
  constexpr float far = 4;
  return coordinate > -far ? std::min(coordinate, far) : -far;
}

int wrap(int index, int size, ImageExtension extension) {
  if (index >= 0 && index < size) return index;
  switch (extension) {
    case ImageExtension::repeat:
      return (index % size + size) % size;
    case ImageExtension::extend:
      return index < 0 ? 0 : size - 1;
    case ImageExtension::mirror: {
      const int period = 2 * size, place = (index % period + period) % period;
      return place < size ? place : period - 1 - place;
    }
    case ImageExtension::clip:
      break;
  }
  return -1;
}

Taps find_taps(float coordinate, int size, const ImageLookup& lookup) {
  const float place = reduce(coordinate, lookup.extension) * static_cast<float>(size);
  Taps taps;
  const auto add = [&](int index, float weight) {
    taps.index[taps.count] = wrap(index, size, lookup.extension);
    taps.weight[taps.count++] = weight;
  };
  if (lookup.interpolation == ImageInterpolation::closest) {
    add(static_cast<int>(std::floor(place)), 1);
    return taps;
  }
  const float first = std::floor(place - 0.5f), t = place - 0.5f - first;
  const int index = static_cast<int>(first);
  if (lookup.interpolation == ImageInterpolation::linear) {
    add(index, 1 - t);
    add(index + 1, t);
    return taps;
  }
  const float s = 1 - t;
  add(index - 1, s * s * s / 6);
  add(index, (4 + t * t * (3 * t - 6)) / 6);
  add(index + 1, (4 + s * s * (3 * s - 6)) / 6);
  add(index + 2, t * t * t / 6);
  return taps;
}

template <class Sample>
Sum sum_taps(const Image& image, const Sample* samples, const Taps& x, const Taps& y) {
  Sum sum;
  for (int j = 0; j < y.count; ++j) {
    if (y.index[j] < 0) continue;
    for (int i = 0; i < x.count; ++i)
      if (x.index[i] >= 0)
        sum.add(samples + image.offset(x.index[i], y.index[j]), image.channels, x.weight[i] * y.weight[j]);
  }
  return sum;
}

// How much of the lookup lies within the picture: its alpha, where that has none of its own.
float coverage(const Taps& taps) {
  float sum = 0;
  for (int i = 0; i < taps.count; ++i) sum += taps.index[i] >= 0 ? taps.weight[i] : 0;
  return sum;
}

// Straight lines between exact values of the curve are within 3e-7 of it, and spare three powers for each lookup.
class SrgbTable {
 public:
  SrgbTable() {
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] = srgb_to_linear(static_cast<float>(i) / steps);
  }
  [[nodiscard]] float decode(float encoded) const {
    if (!(encoded > 0 && encoded < 1)) return srgb_to_linear(encoded);
    const float place = encoded * steps;
    const auto index = static_cast<std::size_t>(place);
    return lerp(values_[index], values_[index + 1], place - static_cast<float>(index));
  }

 private:
  static constexpr int steps = 255 * 5;  // so that no byte lies between two values
  std::array<float, steps + 1> values_;
};

const SrgbTable srgb_table;

}  // namespace

Rgba eval_image(const Image& image, const ImageLookup& lookup, Vec2f uv) {
  const Taps x = find_taps(uv.x, image.width, lookup), y = find_taps(uv.y, image.height, lookup);
  const bool is_bytes = !image.bytes.empty();
  Sum sum = is_bytes ? sum_taps(image, image.bytes.data(), x, y) : sum_taps(image, image.pixels.data(), x, y);
  if (image.channels < 3) sum.g = sum.b = sum.r;

  Rgba result{.color = {sum.r, sum.g, sum.b}, .alpha = sum.a};
  if (is_bytes) {
    result.color *= 1.0f / 255;
    result.alpha *= 1.0f / 255;
  }
  if (!image.has_alpha()) result.alpha = lookup.extension == ImageExtension::clip ? coverage(x) * coverage(y) : 1;
  if (lookup.is_divided_by_alpha && result.alpha != 0 && result.alpha != 1) result.color *= 1 / result.alpha;
  if (is_bytes && image.encoding == ByteEncoding::srgb)
    result.color = {srgb_table.decode(result.color.x), srgb_table.decode(result.color.y),
                    srgb_table.decode(result.color.z)};
  return result;
}

}  // namespace basicrt
