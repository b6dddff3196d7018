// SPDX-License-Identifier: GPL-3.0-or-later
// Makes batches of camera rays pixel by pixel, and adds up what the integrator says of them.
#include "render/tile_render.h"

#include <utility>

#include "base/append_result.h"

namespace basicrt {
namespace {

// Enough rays for the tracer to chew on, few enough to stay in the cache and to stop soon.
constexpr std::uint32_t batch_size = 512;

// Of any camera at any time; it draws what that needs. Nothing where the camera sees nothing.
std::optional<Ray> camera_ray(const PreparedScene& scene, Vec2f place, Sampler& sampler) {
  const Vec2f lens = scene.view.has_aperture() ? sampler.next_2d() : Vec2f{};
  if (!scene.has_motion) return scene.view.ray(place, lens);
  const float time = scene.shutter.sample(sampler.next_1d());
  std::optional<Ray> ray =
      scene.moving_camera.is_moving() ? scene.moving_camera.at(time).ray(place, lens) : scene.view.ray(place, lens);
  if (ray) ray->time = time;
  return ray;
}

}  // namespace

AccumulatorOptions accumulator_options(const PreparedScene& scene, const PixelFilter& filter) {
  return {.negative_mass = filter.negative_mass(),
          .has_shadow_catchers = scene.has_shadow_catchers,
          .samples = scene.settings.samples};
}

Worker::Worker(const PreparedScene& scene) : integrator(make_integrator(scene)), samples(batch_size) {}

TileRender::TileRender(const PreparedScene& scene, const PixelFilter& filter, const SamplePlan& plan, PixelRect rect,
                       const Baking* baking)
    : scene_(scene),
      filter_(filter),
      plan_(plan),
      rect_(rect),
      baking_(baking),
      accumulator_(rect, scene.settings.passes, accumulator_options(scene, filter)) {
  if (scene.settings.adaptive_threshold > 0) noise_.emplace(rect.width, rect.height, scene.settings.adaptive_threshold);
}

bool TileRender::is_done() const { return has_converged_ || next_round_ == plan_.round_ends.size(); }

std::uint64_t TileRender::take_spared() { return std::exchange(spared_, 0); }

// Inlined by force: a call for each sample costs 3 % of a simple picture.
[[gnu::always_inline]] inline void TileRender::add_path(Worker& worker, int x, int y, const Sampler& pixel_sample) {
  Sampler sampler = pixel_sample;
  const Vec2f center{static_cast<float>(rect_.x + x) + 0.5f, static_cast<float>(rect_.y + y) + 0.5f};
  const FilterSample place = filter_.sample(sampler.next_2d());
  if (scene_.view.is_pinhole() && !scene_.has_motion)
    append_result(worker.paths.rays, [&] { return scene_.view.ray(center + place.offset); });
  else if (const std::optional<Ray> ray = camera_ray(scene_, center + place.offset, sampler))
    worker.paths.rays.push_back(*ray);
  else
    return add_unseen(worker, x, y, place.is_negative);
  worker.paths.samplers.push_back(sampler);
  worker.places.push_back({x, y, place.is_negative});
}

void TileRender::add_baked_path(Worker& worker, int x, int y, Sampler sampler, bool is_first) {
  const std::optional<Baking::Start> start = baking_->start(scene_, rect_.x + x, rect_.y + y, sampler, is_first);
  if (!start) return add_unseen(worker, x, y, false);
  worker.paths.add(start->ray, sampler);
  worker.paths.first_hits.push_back(start->hit);
  worker.places.push_back({x, y, false});
}

Sampler TileRender::pixel_sampler(int x, int y) const {
  const Vec2i pixel{rect_.x + x, rect_.y + y};
  return {scene_.settings.sampler, baking_ != nullptr ? baking_->sampler_pixel(pixel.x, pixel.y) : pixel,
          static_cast<std::uint64_t>(scene_.settings.seed)};
}

bool TileRender::render_round(Worker& worker, const std::function<bool(std::uint64_t)>& go_on) {
  const int begin = next_round_ == 0 ? plan_.begin : plan_.round_ends[next_round_ - 1],
            end = plan_.round_ends[next_round_];
  ++next_round_;
  const auto render_batch = [&] {
    const std::uint64_t count = worker.paths.size() + std::exchange(worker.unseen, 0);
    flush(worker);
    return go_on(count);
  };
  for (int y = 0; y < rect_.height; ++y) {
    for (int x = 0; x < rect_.width; ++x) {
      if (noise_ && !noise_->is_open(x, y)) continue;
      const Sampler of_pixel = pixel_sampler(x, y);
      for (int sample = begin; sample < end; ++sample) {
        const Sampler sampler = of_pixel.at_sample(static_cast<std::uint32_t>(sample));
        if (baking_ != nullptr)
          add_baked_path(worker, x, y, sampler, sample == 0);
        else
          add_path(worker, x, y, sampler);
        if (worker.paths.size() == batch_size && !render_batch()) return false;
      }
    }
  }
  if (!render_batch()) return false;
  if (noise_ && end >= plan_.adaptive_min_samples) look_at_noise();
  return true;
}

void TileRender::add_unseen(Worker& worker, int x, int y, bool is_negative) {
  accumulator_.add(x, y, PixelSample{.alpha = 0}, is_negative);
  if (noise_) noise_->add(x, y, Color(0.0f));
  ++worker.unseen;
}

void TileRender::flush(Worker& worker) {
  const std::span batch = std::span(worker.samples).first(worker.paths.size());
  if (baking_ != nullptr) worker.paths.parts = baking_->parts();
  worker.integrator->render(worker.paths, batch);
  const PassValues& values = worker.integrator->passes().values();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Worker::Place& place = worker.places[i];
    batch[i].radiance *= scene_.settings.exposure;
    batch[i].catcher.behind *= scene_.settings.exposure;
    accumulator_.add(place.x, place.y, batch[i], place.is_negative, values.row(i));
    if (noise_) noise_->add(place.x, place.y, batch[i].radiance + batch[i].catcher.lit);
  }
  for (const MatteSample& matte : values.mattes())
    if (const Worker::Place& place = worker.places[matte.sample]; !place.is_negative)
      accumulator_.add_matte(place.x, place.y, matte);
  worker.paths.clear();
  worker.places.clear();
}

Tile TileRender::finish() {
  std::vector<std::uint32_t> sums;
  if (scene_.settings.has_sample_range()) sums = accumulator_.take_words();
  Tile tile = accumulator_.finish();
  tile.sums = std::move(sums);
  return tile;
}

Tile TileRender::look() const {
  TileAccumulator copy = accumulator_;
  return copy.finish();
}

void TileRender::look_at_noise() {
  const int samples = plan_.round_ends[next_round_ - 1], planned = plan_.round_ends.back();
  const int closed = noise_->update(samples);
  spared_ += static_cast<std::uint64_t>(closed) * static_cast<std::uint64_t>(planned - samples);
  has_converged_ = !noise_->has_open();
}

}  // namespace basicrt
