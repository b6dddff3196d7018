// SPDX-License-Identifier: GPL-3.0-or-later
// An equirectangular picture that is turned or stretched is sampled cell by cell as it lies, and densities carried over;
// any other way of looking a picture up is first drawn into a smaller one.
#include "light/environment_sampler.h"

#include <cmath>
#include <numbers>

#include "light/solid_angle.h"

namespace basicrt {
namespace {

using LuminanceRow = std::function<void(int, std::span<float>)>;

// The share of a pixel's neighbour in the mean over the pixel, along one axis.
float neighbour_share(ImageInterpolation interpolation) {
  switch (interpolation) {
    case ImageInterpolation::closest:
      return 0;
    case ImageInterpolation::linear:
      return 1.0f / 8;  // the integral of a tent beyond its middle half
    case ImageInterpolation::cubic:
      break;
  }
  return 77.0f / 384;  // of a cubic B-spline, all but its outermost 1/384
}

void luminance_row(const Image& image, int y, std::span<float> out) {
  if (image.channels >= 3 && image.bytes.empty()) {  // most pictures
    const float* p = image.pixels.data() + image.offset(0, y);
    for (float& value : out) {
      value = std::max(luminance({p[0], p[1], p[2]}), 0.0f);
      p += image.channels;
    }
    return;
  }
  for (int x = 0; x < image.width; ++x) out[x] = std::max(luminance(pixel_color(image, x, y)), 0.0f);
}

// The mean of a picture over each pixel, as its lookup has it between its neighbours' values.
EquirectTable make_table(int width, int height, const LuminanceRow& row_of, float share, int threads) {
  return {width, height,
          [&](int row, std::span<float> weights) {
            thread_local std::vector<float> column_sums, line;
            column_sums.assign(weights.size(), 0);
            line.resize(weights.size());
            for (int dy = -1; dy <= 1; ++dy) {
              if (dy != 0 && share == 0) continue;
              row_of((row + dy + height) % height, line);
              const float factor = dy == 0 ? 1 - 2 * share : share;
              for (std::size_t x = 0; x < line.size(); ++x) column_sums[x] += factor * line[x];
            }
            const std::size_t last = line.size() - 1;
            for (std::size_t x = 0; x <= last; ++x) {
              const float left = column_sums[x == 0 ? last : x - 1], right = column_sums[x == last ? 0 : x + 1];
              weights[x] = (1 - 2 * share) * column_sums[x] + share * (left + right);
            }
          },
          threads};
}

// Between few pixels a picture varies too much for one density: then each of them has so many cells along either axis,
// an even number, so that those of a linear lookup have their centre's value as their mean.
int cells_of_pixel(const Image& image, ImageInterpolation interpolation) {
  constexpr int enough_columns = 1024;
  int cells = 1;
  if (interpolation != ImageInterpolation::closest)
    while (image.width * cells < enough_columns) cells *= 2;
  return cells;
}

EquirectTable make_fine_table(const Image& image, ImageInterpolation interpolation, int cells, int threads) {
  const int width = image.width * cells, height = image.height * cells;
  const ImageLookup lookup{.interpolation = interpolation, .extension = ImageExtension::repeat};
  const auto row_of = [&](int y, std::span<float> out) {
    const float v = (float(y) + 0.5f) / float(height);
    for (int x = 0; x < width; ++x)
      out[static_cast<std::size_t>(x)] =
          luminance(max(eval_image(image, lookup, {(float(x) + 0.5f) / float(width), v}).color, Color(0.0f)));
  };
  return make_table(width, height, row_of, 0, threads);
}

EquirectTable make_drawn_table(const EnvironmentLayer& layer, int threads) {
  constexpr int width = 1024, height = 512;
  // Wide, for a pixel may well be larger than what it stands for.
  constexpr float share = 0.25f;
  const auto row_of = [&](int y, std::span<float> out) {
    const float latitude = ((float(y) + 0.5f) / height - 0.5f) * pi;
    for (int x = 0; x < width; ++x) {
      const float longitude = (0.5f - (float(x) + 0.5f) / width) * 2 * pi;
      const Vec3f direction{std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                            std::sin(latitude)};
      out[static_cast<std::size_t>(x)] = luminance(eval_layer(layer, direction));
    }
  };
  return make_table(width, height, row_of, share, threads);
}

Vec3f turned(const TransformD& transform, Vec3d direction) {
  const Vec3d made = transform.vector(direction);
  return Vec3f(made / length(made));
}

// Directions go to directions one to one, and far apart enough to be told.
bool is_one_to_one(const TransformD& transform) {
  const double size = length(transform.column(0)) * length(transform.column(1)) * length(transform.column(2));
  return length_squared(transform.column(3)) == 0 && std::abs(transform.determinant()) > 1e-3 * size;
}

// A sky's own space has the sun over the x axis.
Transform to_sky(const EnvironmentLayer& layer) {
  const float azimuth = sun_azimuth(*layer.sky), c = std::cos(azimuth), s = std::sin(azimuth);
  return Transform({{{c, s, 0, 0}, {-s, c, 0, 0}, {0, 0, 1, 0}}}) * layer.to_image;
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment, int threads) : environment_(environment) {
  draw_skies(threads);
  std::vector<double> powers;
  for (const EnvironmentLayer& layer : environment_.layers) {
    if (layer.seen_by == EnvironmentRays::camera || layer.image.is_empty() || is_black(layer.radiance)) continue;
    Picture picture = make_picture(layer, threads);
    // A table of the layer's own space knows nothing of the layer's colour.
    const double scale = picture.is_in_world ? 1 : luminance(layer.radiance);
    powers.push_back(picture.table.total() * scale);
    pictures_.push_back(std::move(picture));
  }
  for (const Sun& sun : suns_) powers.push_back(sampling_weight(sun));
  choices_ = DiscreteDistribution(std::move(powers));
}

void EnvironmentSampler::draw_skies(int threads) {
  for (EnvironmentLayer& layer : environment_.layers) {
    if (!layer.sky) continue;
    layer.image = draw_sky(*layer.sky, threads);
    layer.projection = EnvironmentProjection::horizon;
    layer.interpolation = ImageInterpolation::linear;
    layer.to_image = to_sky(layer);
    if (const std::optional<SunDisc> sun = find_sun(*layer.sky)) add_sun(*sun, layer);
  }
}

void EnvironmentSampler::add_sun(const SunDisc& disc, const EnvironmentLayer& layer) {
  Sun sun{.disc = disc, .scale = layer.radiance, .seen_by = layer.seen_by, .to_sky = TransformD(layer.to_image)};
  sun.is_sampled = sun.seen_by != EnvironmentRays::camera && is_one_to_one(sun.to_sky);
  if (sun.is_sampled) sun.to_world = inverse(sun.to_sky);
  suns_.push_back(sun);
}

double EnvironmentSampler::sampling_weight(const Sun& sun) {
  return sun.is_sampled ? luminance(sun.scale * sun_disc_irradiance(sun.disc)) : 0;
}

EnvironmentSampler::Picture EnvironmentSampler::make_picture(const EnvironmentLayer& layer, int threads) {
  const TransformD to_image(layer.to_image);
  if (layer.projection != EnvironmentProjection::equirectangular || !is_one_to_one(to_image))
    return {.table = make_drawn_table(layer, threads), .is_in_world = true, .to_image = {}, .to_world = {}};
  const Image& image = layer.image;
  const int cells = cells_of_pixel(image, layer.interpolation);
  const auto row_of = [&](int y, std::span<float> out) { luminance_row(image, y, out); };
  return {.table = cells > 1
                       ? make_fine_table(image, layer.interpolation, cells, threads)
                       : make_table(image.width, image.height, row_of, neighbour_share(layer.interpolation), threads),
          .is_in_world = false,
          .to_image = to_image,
          .to_world = inverse(to_image)};
}

double EnvironmentSampler::power(float scene_radius) const {
  return choices_.total() * std::numbers::pi * double(scene_radius) * scene_radius;
}

Color EnvironmentSampler::eval(Vec3f direction, bool is_camera_ray) const {
  Color sum = eval_environment(environment_, direction, is_camera_ray);
  const EnvironmentRays unseen = is_camera_ray ? EnvironmentRays::scattered : EnvironmentRays::camera;
  for (const Sun& sun : suns_)
    if (sun.seen_by != unseen) sum += sun.scale * eval_sun_disc(sun.disc, sun.in_sky(direction));
  return sum;
}

Vec3f EnvironmentSampler::sample_picture(const Picture& picture, Vec2f u) {
  const Vec3f direction = picture.table.sample(u).direction;
  return picture.is_in_world ? direction : turned(picture.to_world, Vec3d(direction));
}

Vec3f EnvironmentSampler::sample_sun(const Sun& sun, Vec2f u) {
  return turned(sun.to_world, sample_sun_disc(sun.disc, u));
}

std::optional<LightSample> EnvironmentSampler::sample(float choice, Vec2f u) const {
  const std::uint32_t chosen = choices_.choose(choice).index;
  const Vec3f direction = chosen < pictures_.size() ? sample_picture(pictures_[chosen], u)
                                                    : sample_sun(suns_[chosen - pictures_.size()], u);
  const LightSample sample{.wi = direction, .radiance = eval(direction, false), .pdf = pdf(direction)};
  if (!(sample.pdf > 0 && sample.pdf < infinity)) return std::nullopt;
  return sample;
}

float EnvironmentSampler::pdf(Vec3f direction) const {
  double sum = 0;
  for (std::uint32_t i = 0; i < pictures_.size(); ++i) {
    const Picture& picture = pictures_[i];
    const double probability = choices_.probability(i);
    if (picture.is_in_world) {
      sum += probability * picture.table.pdf(direction);
      continue;
    }
    const Vec3d turned = picture.to_image.vector(Vec3d(direction));
    const double ratio = 1 / solid_angle_ratio(picture.to_image, Vec3d(direction));
    sum += probability * picture.table.pdf(Vec3f(turned)) * ratio;
  }
  return static_cast<float>(sum + pdf_suns(direction));
}

double EnvironmentSampler::pdf_suns(Vec3f direction) const {
  double sum = 0;
  for (std::uint32_t i = 0; i < suns_.size(); ++i) {
    const Sun& sun = suns_[i];
    if (!sun.is_sampled) continue;
    const double density = pdf_sun_disc(sun.disc, sun.in_sky(direction));
    if (density == 0) continue;
    const double probability = choices_.probability(static_cast<std::uint32_t>(pictures_.size()) + i);
    sum += probability * density / solid_angle_ratio(sun.to_sky, Vec3d(direction));
  }
  return sum;
}

}  // namespace basicrt
