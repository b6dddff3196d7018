// SPDX-License-Identifier: GPL-3.0-or-later
// Worker threads render tiles and queue them.
#include "render/session.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/append_result.h"
#include "base/parallel_for.h"
#include "integrator/integrator.h"
#include "render/tile_order.h"
#include "sampling/filter.h"
#include "sampling/shutter.h"

namespace basicrt {
namespace {

using Clock = std::chrono::steady_clock;

// Enough rays for the tracer to chew on, few enough to stay in the cache and to stop soon.
constexpr std::uint32_t batch_size = 512;

// Where a sample goes: a pixel of the tile, and the sign of its weight there.
struct Place {
  int x, y;
  bool is_negative;
};

PixelRect picture_rect(const RenderSettings& settings) {
  const PixelRect border{settings.border_x, settings.border_y, settings.border_width, settings.border_height};
  return {border.x, border.y, border.width > 0 ? border.width : settings.width - border.x,
          border.height > 0 ? border.height : settings.height - border.y};
}

}  // namespace

struct Session::State {
  PreparedScene scene;
  SessionOptions options;
  PixelFilter filter;
  Shutter shutter;
  PixelRect rect;
  std::vector<PixelRect> tiles;
  std::uint64_t sample_count;
  Clock::time_point begin = Clock::now();

  std::atomic<bool> stop = false;
  std::atomic<std::size_t> next_tile = 0;
  std::atomic<std::uint64_t> samples_done = 0;

  std::mutex mutex;  // guards what follows
  std::condition_variable changed;
  std::deque<Tile> finished;
  std::size_t tiles_handed_out = 0;
  std::exception_ptr error;
  Clock::time_point end;  // when the last tile was finished

  std::vector<std::jthread> workers;  // last, so that they end before what they use

  State(PreparedScene scene_, SessionOptions options_)
      : scene(std::move(scene_)),
        options(options_),
        filter(scene.settings.filter),
        shutter(scene.settings.shutter_curve),
        rect(picture_rect(scene.settings)),
        tiles(make_tiles(rect, options.tile_size)),
        sample_count(static_cast<std::uint64_t>(rect.width) * rect.height * scene.settings.samples) {}

  // With the mutex held.
  [[nodiscard]] bool is_done() const { return stop || tiles_handed_out == tiles.size(); }
  void work();
  std::optional<Tile> render_tile(const PixelRect& tile, Integrator& integrator);
  [[nodiscard]] std::optional<Ray> camera_ray(Vec2f place, Sampler& sampler) const;
};

// Of any camera at any time; it draws what that needs. Nothing where the camera sees nothing.
std::optional<Ray> Session::State::camera_ray(Vec2f place, Sampler& sampler) const {
  const Vec2f lens = scene.view.has_aperture() ? sampler.next_2d() : Vec2f{};
  if (!scene.has_motion) return scene.view.ray(place, lens);
  const float time = shutter.sample(sampler.next_1d());
  std::optional<Ray> ray =
      scene.moving_camera.is_moving() ? scene.moving_camera.at(time).ray(place, lens) : scene.view.ray(place, lens);
  if (ray) ray->time = time;
  return ray;
}

void Session::State::work() {
  try {
    const std::unique_ptr<Integrator> integrator = make_integrator(scene);
    for (std::size_t i = next_tile++; i < tiles.size() && !stop; i = next_tile++) {
      std::optional<Tile> tile = render_tile(tiles[i], *integrator);
      if (!tile) break;
      const std::lock_guard lock(mutex);
      finished.push_back(std::move(*tile));
      end = Clock::now();
      changed.notify_all();
    }
  } catch (...) {
    const std::lock_guard lock(mutex);
    if (!error) error = std::current_exception();
    stop = true;
    changed.notify_all();
  }
}

// Nothing when it was stopped half-way.
std::optional<Tile> Session::State::render_tile(const PixelRect& tile, Integrator& integrator) {
  const RenderSettings& settings = scene.settings;
  TileAccumulator accumulator(tile, settings.passes, filter.negative_mass());
  CameraPaths paths;
  std::vector<Place> places;
  std::vector<PixelSample> samples(batch_size);
  const bool is_still_pinhole = scene.view.is_pinhole() && !scene.has_motion;
  const PixelSample unseen{.alpha = 0};

  const auto flush = [&] {
    const std::span batch = std::span(samples).first(paths.size());
    integrator.render(paths, batch);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      batch[i].radiance *= settings.exposure;
      accumulator.add(places[i].x, places[i].y, batch[i], places[i].is_negative);
    }
    samples_done += batch.size();
    paths.clear();
    places.clear();
  };

  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      const Vec2i pixel{tile.x + x, tile.y + y};
      const Vec2f center{static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f};
      const Sampler pixel_sampler(settings.sampler, pixel, static_cast<std::uint64_t>(settings.seed));
      for (int sample = 0; sample < settings.samples; ++sample) {
        Sampler sampler = pixel_sampler.at_sample(static_cast<std::uint32_t>(sample));
        const FilterSample place = filter.sample(sampler.next_2d());
        if (is_still_pinhole) {
          append_result(paths.rays, [&] { return scene.view.ray(center + place.offset); });
        } else if (const std::optional<Ray> ray = camera_ray(center + place.offset, sampler)) {
          paths.rays.push_back(*ray);
        } else {
          accumulator.add(x, y, unseen, place.is_negative);
          ++samples_done;
          continue;
        }
        paths.samplers.push_back(sampler);
        places.push_back({x, y, place.is_negative});
        if (paths.size() < batch_size) continue;
        flush();
        if (stop) return std::nullopt;
      }
    }
  }
  flush();
  return accumulator.finish();
}

Session::Session(PreparedScene scene, SessionOptions options)
    : state_(std::make_unique<State>(std::move(scene), options)) {
  const int threads = resolve_thread_count(options.threads);
  for (int i = 0; i < threads; ++i) state_->workers.emplace_back([state = state_.get()] { state->work(); });
}

Session::~Session() { stop(); }

std::optional<Tile> Session::next_tile(std::chrono::duration<double> timeout) {
  std::unique_lock lock(state_->mutex);
  const auto is_ready = [&] { return state_->is_done() || !state_->finished.empty(); };
  state_->changed.wait_for(lock, timeout, is_ready);
  if (state_->error) std::rethrow_exception(state_->error);
  if (state_->stop || state_->finished.empty()) return std::nullopt;

  Tile tile = std::move(state_->finished.front());
  state_->finished.pop_front();
  ++state_->tiles_handed_out;
  return tile;
}

bool Session::is_done() const {
  const std::lock_guard lock(state_->mutex);
  return state_->is_done();
}

void Session::stop() {
  const std::lock_guard lock(state_->mutex);
  state_->stop = true;
  state_->changed.notify_all();
}

bool Session::is_stopped() const { return state_->stop; }

Progress Session::progress() const {
  const std::lock_guard lock(state_->mutex);
  const std::uint64_t done = state_->samples_done;
  const bool is_rendered = done == state_->sample_count;
  const std::chrono::duration<double> elapsed = (is_rendered ? state_->end : Clock::now()) - state_->begin;

  Progress progress;
  progress.fraction = state_->sample_count ? static_cast<double>(done) / static_cast<double>(state_->sample_count) : 1;
  progress.elapsed_seconds = std::max(elapsed.count(), 0.0);
  if (progress.elapsed_seconds > 0) progress.samples_per_second = static_cast<double>(done) / progress.elapsed_seconds;
  if (progress.samples_per_second > 0)
    progress.remaining_seconds = static_cast<double>(state_->sample_count - done) / progress.samples_per_second;
  progress.is_done = state_->is_done();
  return progress;
}

PixelRect Session::rect() const { return state_->rect; }

const PreparedScene& Session::scene() const { return state_->scene; }

Film render(PreparedScene scene, SessionOptions options) {
  Film film(scene.settings.width, scene.settings.height, scene.settings.passes);
  Session session(std::move(scene), options);
  while (!session.is_done())
    if (const std::optional<Tile> tile = session.next_tile(std::chrono::seconds(1))) film.write(*tile);
  return film;
}

}  // namespace basicrt
