// SPDX-License-Identifier: GPL-3.0-or-later
// Worker threads render tiles and queue them.
#include "render/session.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/parallel_for.h"
#include "render/sample_plan.h"
#include "render/tile_order.h"
#include "render/tile_render.h"

namespace basicrt {
namespace {

using Clock = std::chrono::steady_clock;

PixelRect picture_rect(const RenderSettings& settings) {
  const PixelRect border{settings.border_x, settings.border_y, settings.border_width, settings.border_height};
  return {border.x, border.y, border.width > 0 ? border.width : settings.width - border.x,
          border.height > 0 ? border.height : settings.height - border.y};
}

// Where sampling is adaptive, tiles begin where blocks of pixels do: the same blocks whatever the size.
int usable_tile_size(const RenderSettings& settings, int tile_size) {
  constexpr int block = NoiseMap::block_size;
  return settings.adaptive_threshold > 0 ? (tile_size + block - 1) / block * block : tile_size;
}

PreparedScene seen_by(const std::optional<Baking>& baking, PreparedScene scene) {
  if (baking) baking->apply_to(scene);
  return scene;
}

// A tile that several threads may work on, one after another.
struct SharedTile {
  std::mutex mutex;
  std::optional<TileRender> render;
};

}  // namespace

struct Session::State {
  PreparedScene scene;
  std::optional<Baking> baking;
  SessionOptions options;
  PixelFilter filter;
  SamplePlan plan;
  PixelRect rect;
  std::vector<PixelRect> tiles;
  std::uint64_t pixel_count;
  std::vector<SharedTile> shared_tiles;  // for a picture with a time limit
  Clock::time_point begin = Clock::now();

  std::atomic<bool> stop = false;
  std::atomic<bool> is_time_up = false;
  std::atomic<std::size_t> next_turn = 0;
  std::atomic<std::uint64_t> samples_done = 0;
  std::atomic<std::uint64_t> samples_spared = 0;  // that adaptive sampling found not to be needed
  std::atomic<int> threads_at_work;

  std::mutex mutex;  // guards what follows
  std::condition_variable changed;
  std::deque<Tile> finished;
  std::size_t tiles_finished = 0, tiles_handed_out = 0;
  std::exception_ptr error;
  Clock::time_point end;  // when the last tile was finished

  std::vector<std::jthread> workers;  // last, so that they end before what they use

  State(PreparedScene scene_, SessionOptions options_, std::optional<Baking> baking_)
      : scene(seen_by(baking_, std::move(scene_))),
        baking(std::move(baking_)),
        options(options_),
        filter(scene.settings.filter),
        plan(plan_samples(scene.settings)),
        rect(picture_rect(scene.settings)),
        tiles(make_tiles(rect, usable_tile_size(scene.settings, options.tile_size))),
        pixel_count(static_cast<std::uint64_t>(rect.width) * rect.height),
        shared_tiles(scene.settings.time_limit > 0 ? tiles.size() : 0),
        threads_at_work(resolve_thread_count(options.threads)) {}

  // With the mutex held.
  [[nodiscard]] bool is_done() const { return stop || tiles_handed_out == tiles.size(); }
  [[nodiscard]] double elapsed_seconds() const { return std::chrono::duration<double>(Clock::now() - begin).count(); }
  [[nodiscard]] const Baking* baking_or_none() const { return baking ? &*baking : nullptr; }
  [[nodiscard]] std::uint64_t sample_count() const { return pixel_count * (plan.round_ends.back() - plan.begin); }
  void work();
  void work_tile_by_tile(Worker& worker);
  void work_round_by_round(Worker& worker);
  void hand_out(Tile tile);
};

void Session::State::work() {
  try {
    Worker worker(scene);
    if (scene.settings.time_limit > 0)
      work_round_by_round(worker);
    else
      work_tile_by_tile(worker);
  } catch (...) {
    const std::lock_guard lock(mutex);
    if (!error) error = std::current_exception();
    stop = true;
    changed.notify_all();
  }
}

void Session::State::work_tile_by_tile(Worker& worker) {
  const auto go_on = [&](std::uint64_t samples) {
    samples_done += samples;
    return !stop;
  };
  for (std::size_t i = next_turn++; i < tiles.size() && !stop; i = next_turn++) {
    TileRender tile(scene, filter, plan, tiles[i], baking_or_none());
    while (!tile.is_done()) {
      if (!tile.render_round(worker, go_on)) return;
      samples_spared += tile.take_spared();
    }
    hand_out(tile.finish());
  }
}

// Over the whole picture again and again, so that when the time is up all pixels have about as many samples. The first
// round is always finished: a picture has no holes.
void Session::State::work_round_by_round(Worker& worker) {
  const std::size_t turns = tiles.size() * plan.round_ends.size();
  const auto has_time = [&] {
    if (elapsed_seconds() >= scene.settings.time_limit) is_time_up = true;
    return !is_time_up;
  };
  for (std::size_t turn = next_turn++; turn < turns && !stop; turn = next_turn++) {
    const bool is_first_round = turn < tiles.size();
    if (!is_first_round && !has_time()) break;
    const auto go_on = [&](std::uint64_t samples) {
      samples_done += samples;
      return !stop && (is_first_round || has_time());
    };
    SharedTile& tile = shared_tiles[turn % tiles.size()];
    const std::lock_guard lock(tile.mutex);
    if (!tile.render) tile.render.emplace(scene, filter, plan, tiles[turn % tiles.size()], baking_or_none());
    if (tile.render->is_done()) continue;
    if (!tile.render->render_round(worker, go_on)) break;
    samples_spared += tile.render->take_spared();
  }
  if (--threads_at_work > 0 || stop) return;
  if (samples_done + samples_spared == sample_count()) is_time_up = false;
  for (SharedTile& tile : shared_tiles) hand_out(tile.render->finish());
}

void Session::State::hand_out(Tile tile) {
  const std::lock_guard lock(mutex);
  finished.push_back(std::move(tile));
  ++tiles_finished;
  end = Clock::now();
  changed.notify_all();
}

Session::Session(PreparedScene scene, SessionOptions options) : Session(std::move(scene), options, std::nullopt) {}

Session::Session(PreparedScene scene, SessionOptions options, std::optional<Baking> baking)
    : state_(std::make_unique<State>(std::move(scene), options, std::move(baking))) {
  const int threads = state_->threads_at_work;
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
  const State& state = *state_;
  const std::lock_guard lock(state_->mutex);
  const auto done = static_cast<double>(state.samples_done), spared = static_cast<double>(state.samples_spared);
  const auto count = static_cast<double>(state.sample_count()), limit = double(state.scene.settings.time_limit);
  const bool is_rendered = state.tiles_finished == state.tiles.size();

  Progress progress;
  progress.elapsed_seconds =
      is_rendered ? std::chrono::duration<double>(state.end - state.begin).count() : state.elapsed_seconds();
  progress.fraction = is_rendered ? 1 : (done + spared) / count;
  if (progress.elapsed_seconds > 0) progress.samples_per_second = done / progress.elapsed_seconds;
  if (progress.samples_per_second > 0 && !is_rendered)
    progress.remaining_seconds = (count - done - spared) / progress.samples_per_second;
  if (limit > 0 && !is_rendered) {
    progress.fraction = std::max(progress.fraction, std::min(progress.elapsed_seconds / limit, 1.0));
    progress.remaining_seconds = std::min(progress.remaining_seconds, std::max(limit - progress.elapsed_seconds, 0.0));
  }
  progress.samples_per_pixel = done / static_cast<double>(state.pixel_count);
  progress.is_time_up = state.is_time_up;
  progress.is_done = state.is_done();
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
