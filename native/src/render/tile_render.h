// SPDX-License-Identifier: GPL-3.0-or-later
// A tile while it is rendered: its sums, and which of its pixels still want samples.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "film/film.h"
#include "film/noise_map.h"
#include "integrator/baking.h"
#include "integrator/integrator.h"
#include "render/sample_plan.h"
#include "sampling/filter.h"

namespace basicrt {

// What one thread needs to render, with memory that it uses again.
struct Worker {
  // Where a sample goes: a pixel of the tile, and the sign of its weight there.
  struct Place {
    int x, y;
    bool is_negative;
  };

  std::unique_ptr<Integrator> integrator;
  CameraPaths paths;
  std::vector<Place> places;
  std::vector<PixelSample> samples;
  std::uint64_t unseen = 0;  // samples of the batch that made no path

  explicit Worker(const PreparedScene& scene);
};

// What a film must know of a scene.
[[nodiscard]] AccumulatorOptions accumulator_options(const PreparedScene& scene, const PixelFilter& filter);

class TileRender {
 public:
  // All of them must outlive it. With a baking the picture is its target's.
  TileRender(const PreparedScene& scene, const PixelFilter& filter, const SamplePlan& plan, PixelRect rect,
             const Baking* baking = nullptr);

  [[nodiscard]] bool is_done() const;
  // Takes the samples of the next round. After each batch of them calls go_on(how many); where that returns false the
  // round ends there and then, and so does this, with false.
  bool render_round(Worker& worker, const std::function<bool(std::uint64_t)>& go_on);
  // The samples of the plan that turned out not to be needed, since this was last asked.
  [[nodiscard]] std::uint64_t take_spared();
  [[nodiscard]] Tile finish();
  // What finish() would return now; more samples may follow.
  [[nodiscard]] Tile look() const;

 private:
  void add_path(Worker& worker, int x, int y, const Sampler& pixel_sample);
  void add_baked_path(Worker& worker, int x, int y, Sampler sampler, bool is_first);
  [[nodiscard]] Sampler pixel_sampler(int x, int y) const;
  void add_unseen(Worker& worker, int x, int y, bool is_negative);
  void flush(Worker& worker);
  void look_at_noise();

  const PreparedScene& scene_;
  const PixelFilter& filter_;
  const SamplePlan& plan_;
  PixelRect rect_;
  const Baking* baking_;
  TileAccumulator accumulator_;
  std::optional<NoiseMap> noise_;  // where sampling is adaptive
  std::size_t next_round_ = 0;
  bool has_converged_ = false;
  std::uint64_t spared_ = 0;
};

}  // namespace basicrt
