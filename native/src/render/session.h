// SPDX-License-Identifier: GPL-3.0-or-later
// Renders a prepared scene with worker threads; whoever wants the picture pulls finished tiles.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "film/film.h"
#include "integrator/baking.h"
#include "scene/prepare.h"

namespace basicrt {

struct SessionOptions {
  int threads = 0;  // 0: one for each processor
  int tile_size = 64;
};

struct Progress {
  double fraction = 0;  // of all samples, or of the time there is for them; never falls
  double samples_per_second = 0;
  double elapsed_seconds = 0;
  double remaining_seconds = 0;  // a guess from the rate so far
  double samples_per_pixel = 0;  // the mean of those taken so far
  bool is_time_up = false;       // the time limit ended it before all samples were taken
  bool is_done = false;          // every tile was handed out, or it was stopped
};

// Owns the scene. Threads start at once and end with the session. The same scene gives the same values at any number of threads and
// any tile size, unless a time limit decides how many samples there are.
class Session {
 public:
  explicit Session(PreparedScene scene, SessionOptions options = {});
  // Bakes; `baking` is of this scene.
  Session(PreparedScene scene, SessionOptions options, std::optional<Baking> baking);
  ~Session();  // stops
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // Waits for a finished tile, at most so long. Nothing: not yet, or there are no more (is_done()).
  [[nodiscard]] std::optional<Tile> next_tile(std::chrono::duration<double> timeout);
  [[nodiscard]] bool is_done() const;
  // No further tile is finished; workers end within a batch. Any thread may call it, at any time.
  void stop();
  [[nodiscard]] bool is_stopped() const;
  [[nodiscard]] Progress progress() const;
  [[nodiscard]] PixelRect rect() const;  // the border, or the whole picture
  [[nodiscard]] const PreparedScene& scene() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The whole picture, waited for: what the border leaves out stays at the passes' background.
[[nodiscard]] Film render(PreparedScene scene, SessionOptions options = {});

}  // namespace basicrt
