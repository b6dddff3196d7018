// SPDX-License-Identifier: GPL-3.0-or-later
// One thread directs: it prepares, then renders coarse pictures, then rounds of samples, with a pool of workers. What is
// set meanwhile waits for it, and ends what it is at within a batch of paths.
#include "render/view_session.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "base/thread_priority.h"
#include "base/worker_pool.h"
#include "render/tile_order.h"
#include "render/tile_render.h"

namespace basicrt {
namespace {

using Clock = std::chrono::steady_clock;

// How long the first picture of a view may take, and a round of samples: what is looked at next waits for the one,
// pictures follow each other like the other.
constexpr double first_picture_seconds = 0.03, round_seconds = 0.4;
constexpr int tile_size = 32;
// Each pixel of the first picture stands for so many of the view's in x and y: before it is known how fast the scene
// renders, and at the most.
constexpr int guessed_coarseness = 8, greatest_coarseness = 32;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

PixelRect border_of(const RenderSettings& settings) {
  const bool is_whole = settings.border_width == 0;
  return {settings.border_x, settings.border_y, is_whole ? settings.width - settings.border_x : settings.border_width,
          settings.border_height == 0 ? settings.height - settings.border_y : settings.border_height};
}

// What covers the same with pixels that are `coarseness` times as large.
RenderSettings coarsen(RenderSettings settings, int coarseness) {
  const auto shrink = [&](int size) { return (size + coarseness - 1) / coarseness; };
  const PixelRect border = border_of(settings);
  settings.width = shrink(settings.width);
  settings.height = shrink(settings.height);
  settings.border_x = std::min(border.x / coarseness, settings.width - 1);
  settings.border_y = std::min(border.y / coarseness, settings.height - 1);
  settings.border_width = std::clamp(shrink(border.width), 1, settings.width - settings.border_x);
  settings.border_height = std::clamp(shrink(border.height), 1, settings.height - settings.border_y);
  return settings;
}

// Of a view: without what only makes sense for a whole render.
RenderSettings progressive(const View& view) {
  RenderSettings settings = view.settings;
  settings.samples_from = settings.samples_to = 0;
  settings.samples = std::min(settings.samples, sample_block);
  settings.adaptive_threshold = settings.time_limit = 0;
  settings.passes = {};
  settings.passes.enable(view.pass);
  return settings;
}

// A pass as a colour: one number is a grey, without alpha it is opaque.
void copy_as_rgba(const Tile& tile, Pass pass, ViewPicture& picture) {
  const std::size_t channels = pass_info(pass).channels.size();
  const float* from = tile.values.data() + tile.pass_begin(pass);
  for (int y = 0; y < tile.rect.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(tile.rect.y - picture.rect.y + y) * picture.rect.width;
    float* to = picture.rgba.data() + 4 * (row + (tile.rect.x - picture.rect.x));
    for (int x = 0; x < tile.rect.width; ++x, from += channels, to += 4)
      for (std::size_t i = 0; i < 4; ++i)
        to[i] = i < channels ? from[i] : i == 3 ? 1 : from[channels == 1 ? 0 : i % channels];
  }
}

// A pass as it is.
void copy_pass(const Tile& tile, const PixelRect& rect, ViewPass& pass) {
  const std::size_t channels = pass_info(pass.pass).channels.size();
  const std::size_t row_length = channels * static_cast<std::size_t>(tile.rect.width);
  const float* from = tile.values.data() + tile.pass_begin(pass.pass);
  for (int y = 0; y < tile.rect.height; ++y, from += row_length) {
    const std::size_t row = static_cast<std::size_t>(tile.rect.y - rect.y + y) * rect.width;
    std::copy_n(from, row_length, pass.values.data() + channels * (row + (tile.rect.x - rect.x)));
  }
}

// A view's tiles at one resolution, with what they have been given so far.
struct Rendering {
  PixelFilter filter;
  SamplePlan plan{.adaptive_min_samples = std::numeric_limits<int>::max()};  // grows by a round at a time
  PixelRect rect;
  std::deque<TileRender> tiles;
  std::deque<Worker> workers;  // one for each thread

  Rendering(const PreparedScene& scene, int threads) : filter(scene.settings.filter), rect(border_of(scene.settings)) {
    for (const PixelRect& tile : make_tiles(rect, tile_size)) tiles.emplace_back(scene, filter, plan, tile);
    for (int i = 0; i < threads; ++i) workers.emplace_back(scene);
  }
};

}  // namespace

struct ViewSession::State {
  std::mutex mutex;  // guards what follows
  std::condition_variable changed;
  const Scene* next_scene = nullptr;
  std::optional<View> next_view;
  bool is_paused = false;
  bool is_preparing = false;
  std::optional<ViewPicture> picture;  // the newest that was not taken
  int samples = 0, samples_end = 0;
  std::uint64_t revision = 0;
  bool is_at_work = false;
  Clock::time_point view_begin = Clock::now();
  Report report;
  std::optional<SceneMemory> memory;  // of the scene
  std::exception_ptr error;
  std::unique_ptr<WorkProgress> progress;  // while preparing

  std::atomic<bool> is_over = false;
  std::atomic<bool> is_outdated = false;  // something was set that the director has not taken

  // The director's own.
  PreparedScene scene;
  const Scene* described_by = nullptr;
  bool has_scene = false;
  std::optional<View> view;
  std::uint64_t view_revision = 0;     // what the scene and the view are of
  std::optional<Rendering> rendering;  // at full resolution
  double samples_per_second = 0;       // 0: unknown
  WorkerPool pool;

  std::jthread director;  // last, so that it ends before what it uses

  explicit State(int threads) : pool(threads) {}

  [[nodiscard]] bool can_refine() const {
    return has_scene && view && !is_paused && samples < samples_end && rendering.has_value();
  }
  void direct();
  void take_orders(std::unique_lock<std::mutex>& lock);
  void prepare_scene(const Scene& next, std::unique_lock<std::mutex>& lock);
  void begin_view();
  void refine();
  // Whether the round was finished; then its picture is the newest.
  bool render_round(Rendering& work, int samples_to, int samples_shown, const std::function<bool()>& go_on);
  [[nodiscard]] int choose_coarseness() const;
};

void ViewSession::State::direct() {
  lower_thread_priority();
  std::unique_lock lock(mutex);
  while (true) {
    const auto has_work = [&] { return is_over || next_scene != nullptr || next_view || can_refine(); };
    if (!has_work()) {
      is_at_work = false;
      changed.wait(lock, has_work);
    }
    if (is_over) return;
    is_at_work = true;
    try {
      if (next_scene != nullptr || next_view) {
        take_orders(lock);
      } else {
        lock.unlock();
        refine();
        lock.lock();
      }
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      error = std::current_exception();
      is_preparing = false;
      rendering.reset();
    }
  }
}

// With the lock held, which it lets go while it works.
void ViewSession::State::take_orders(std::unique_lock<std::mutex>& lock) {
  is_outdated = false;
  rendering.reset();
  if (next_view) view = std::move(*std::exchange(next_view, std::nullopt));
  if (const Scene* const next = std::exchange(next_scene, nullptr)) prepare_scene(*next, lock);
  if (!has_scene || !view || is_over || next_scene != nullptr) return;
  if (next_view) view = std::move(*std::exchange(next_view, std::nullopt));
  is_outdated = false;
  view_revision = revision;
  samples = 0;
  samples_end = view->settings.samples;
  lock.unlock();
  begin_view();
  lock.lock();
}

void ViewSession::State::prepare_scene(const Scene& next, std::unique_lock<std::mutex>& lock) {
  progress = std::make_unique<WorkProgress>();
  lock.unlock();
  Report said;
  has_scene = false;
  if (described_by != &next) scene = {};  // revisions of another scene mean nothing
  described_by = &next;
  std::exception_ptr failure;
  std::optional<SceneMemory> used;
  try {
    scene = prepare(next, said, std::move(scene),
                    {.threads = pool.thread_count(), .is_live = true, .progress = progress.get()});
    has_scene = true;
    used = memory_of(scene);
  } catch (const Cancelled&) {  // it is over
  } catch (...) {
    scene = {};
    failure = std::current_exception();
  }
  lock.lock();
  progress.reset();
  is_preparing = false;
  memory = used;
  for (const std::string& warning : said.warnings()) report.warn(warning);
  if (failure) std::rethrow_exception(failure);
}

// So coarse that the first picture is there in time.
int ViewSession::State::choose_coarseness() const {
  if (samples_per_second == 0) return guessed_coarseness;
  const PixelRect rect = border_of(view->settings);
  const double pixels = static_cast<double>(rect.width) * rect.height;
  int coarseness = 1;
  while (coarseness < greatest_coarseness &&
         pixels / (coarseness * coarseness) > samples_per_second * first_picture_seconds)
    coarseness *= 2;
  return coarseness;
}

// The first picture is made whatever is set meanwhile: else nothing were seen as long as a view turns.
void ViewSession::State::begin_view() {
  RenderSettings settings = progressive(*view);
  const auto go_on_always = [&] { return !is_over.load(); };
  const auto go_on_unless_outdated = [&] { return !is_over && !is_outdated; };
  bool is_first = true;
  for (int coarseness = choose_coarseness(); coarseness > 1; coarseness /= 2, is_first = false) {
    apply_view(scene, view->camera, coarsen(settings, coarseness));
    Rendering coarse(scene, pool.thread_count());
    const bool is_finished =
        is_first ? render_round(coarse, 1, 0, go_on_always) : render_round(coarse, 1, 0, go_on_unless_outdated);
    if (!is_finished || is_outdated) return;
  }
  for (const Pass pass : view->further_passes) settings.passes.enable(pass);
  apply_view(scene, view->camera, settings);
  rendering.emplace(scene, pool.thread_count());
  if (is_first && !render_round(*rendering, 1, 1, go_on_always)) rendering.reset();
}

// Rounds double, but none takes longer than a moment.
void ViewSession::State::refine() {
  const double pixels = static_cast<double>(rendering->rect.width) * rendering->rect.height;
  const double affordable = std::min(samples_per_second * round_seconds / pixels, 1e6);
  const int more = std::clamp(samples, 1, std::max(static_cast<int>(affordable), 1));
  const int end = std::min(samples + more, samples_end);
  if (!render_round(*rendering, end, end, [&] { return !is_over && !is_outdated; })) rendering.reset();
}

bool ViewSession::State::render_round(Rendering& work, int samples_to, int samples_shown,
                                      const std::function<bool()>& go_on) {
  const Clock::time_point begin = Clock::now();
  const int samples_from = work.plan.round_ends.empty() ? 0 : work.plan.round_ends.back();
  work.plan.round_ends.push_back(samples_to);
  ViewPicture made{.film_width = scene.settings.width, .film_height = scene.settings.height, .rect = work.rect};
  made.samples = samples_shown;
  const double pixels = static_cast<double>(work.rect.width) * work.rect.height;
  const std::size_t size = static_cast<std::size_t>(work.rect.width) * work.rect.height;
  made.rgba.resize(size * 4);
  made.revision = view_revision;
  if (samples_shown > 0)
    for (const Pass pass : view->further_passes)
      made.further.push_back({pass, std::vector<float>(size * pass_info(pass).channels.size())});

  std::atomic<std::size_t> next_tile = 0;
  std::atomic<bool> is_finished = true;
  pool.for_each(work.workers.size(), [&](std::size_t lane) {
    lower_thread_priority();
    for (std::size_t i = next_tile++; i < work.tiles.size() && is_finished; i = next_tile++) {
      if (!work.tiles[i].render_round(work.workers[lane], [&](std::uint64_t) { return go_on(); })) {
        is_finished = false;
        return;
      }
      const Tile tile = work.tiles[i].look();
      copy_as_rgba(tile, view->pass, made);
      for (ViewPass& pass : made.further) copy_pass(tile, made.rect, pass);
    }
  });
  if (!is_finished) return false;
  samples_per_second = pixels * (samples_to - samples_from) / std::max(seconds_since(begin), 1e-6);
  const std::lock_guard lock(mutex);
  picture = std::move(made);
  samples = samples_shown;
  return true;
}

ViewSession::ViewSession(int threads) : state_(std::make_unique<State>(threads)) {
  state_->director = std::jthread([state = state_.get()] { state->direct(); });
}

ViewSession::~ViewSession() {
  const std::lock_guard lock(state_->mutex);
  state_->is_over = true;
  if (state_->progress) state_->progress->cancel();
  state_->changed.notify_all();
}

void ViewSession::set_scene(const Scene& scene) {
  const std::lock_guard lock(state_->mutex);
  state_->next_scene = &scene;
  ++state_->revision;
  state_->is_preparing = state_->is_outdated = true;
  state_->error = nullptr;
  state_->view_begin = Clock::now();
  state_->changed.notify_all();
}

void ViewSession::set_view(View view) {
  validate_view(view.camera, view.settings);
  const std::lock_guard lock(state_->mutex);
  state_->next_view = std::move(view);
  ++state_->revision;
  state_->is_outdated = true;
  state_->error = nullptr;
  state_->view_begin = Clock::now();
  state_->changed.notify_all();
}

void ViewSession::set_paused(bool is_paused) {
  const std::lock_guard lock(state_->mutex);
  state_->is_paused = is_paused;
  state_->changed.notify_all();
}

bool ViewSession::has_picture() const {
  const std::lock_guard lock(state_->mutex);
  return state_->picture.has_value();
}

std::uint64_t ViewSession::revision() const {
  const std::lock_guard lock(state_->mutex);
  return state_->revision;
}

std::optional<SceneMemory> ViewSession::memory() const {
  const std::lock_guard lock(state_->mutex);
  return state_->memory;
}

std::optional<ViewPicture> ViewSession::take_picture() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->picture, std::nullopt);
}

ViewStatus ViewSession::status() {
  const std::lock_guard lock(state_->mutex);
  if (state_->error) std::rethrow_exception(std::exchange(state_->error, nullptr));
  return {.is_preparing = state_->is_preparing,
          .prepared_fraction = state_->progress ? state_->progress->fraction() : 1,
          .samples = state_->samples,
          .samples_end = state_->samples_end,
          .elapsed_seconds = seconds_since(state_->view_begin),
          .is_done = !state_->is_at_work && state_->next_scene == nullptr && !state_->next_view};
}

Report ViewSession::take_warnings() {
  const std::lock_guard lock(state_->mutex);
  return std::exchange(state_->report, {});
}

}  // namespace basicrt
