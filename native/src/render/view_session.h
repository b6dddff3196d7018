// SPDX-License-Identifier: GPL-3.0-or-later
// Shows a scene that is being worked on: pictures of the whole view, coarse ones at once and better ones as time passes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/report.h"
#include "scene/memory.h"

namespace basicrt {

// From where a scene is looked at, and what of the picture is shown. Of the settings, the number of samples is where
// refinement ends; neither adaptive sampling nor a time limit nor a range of samples counts.
struct View {
  Camera camera;
  RenderSettings settings;
  Pass pass = Pass::combined;
  std::vector<Pass> further_passes;  // pictures of the view's own pixels bring their values along
};

// One number after the other for each pixel, as many as the pass has channels; row 0 at the bottom.
struct ViewPass {
  Pass pass = Pass::combined;
  std::vector<float> values;
};

struct ViewPicture {
  int film_width = 0, film_height = 0;  // of all that the view could show, in this picture's pixels
  PixelRect rect;                       // the border, or all of it, among those
  int samples = 0;                      // of each pixel; 0: of pixels larger than the view's
  std::vector<float> rgba;              // the rectangle's, row 0 at the bottom; alpha is associated
  std::vector<ViewPass> further;        // of the view's further passes; none of larger pixels
  std::uint64_t revision = 0;           // of the session when this was begun
};

struct ViewStatus {
  bool is_preparing = false;  // the scene that was set last is being read
  double prepared_fraction = 0;
  int samples = 0;             // of each pixel of the newest picture
  int samples_end = 0;         // where refinement ends
  double elapsed_seconds = 0;  // since the view was set
  bool is_done = false;        // nothing more comes until something is set
};

// Works on threads of its own; no call waits for it. One thread makes the calls. A picture of n samples has the values
// that render() gives with n samples for each pixel, up to a block of them; beyond, its sums are not exact.
class ViewSession {
 public:
  explicit ViewSession(int threads = 0);  // 0: one for each processor
  ~ViewSession();                         // stops
  ViewSession(const ViewSession&) = delete;
  ViewSession& operator=(const ViewSession&) = delete;

  // Shows this scene; where it is the same object as before, what has not changed in it is not prepared again. It must stay
  // as it is until is_preparing is false, and this may only be called then.
  void set_scene(const Scene& scene);
  // Looks at the scene otherwise. Throws SceneError for a view that can't be rendered.
  void set_view(View view);
  // Takes no more samples once the round it is in is done; goes on when that is revoked.
  void set_paused(bool is_paused);

  // The newest picture; none where it was taken already.
  [[nodiscard]] std::optional<ViewPicture> take_picture();
  [[nodiscard]] bool has_picture() const;
  // How often scenes and views were set. A picture of another revision shows what was to be seen before.
  [[nodiscard]] std::uint64_t revision() const;
  // Throws, once, what ended the work on the scene or the view that was set last.
  [[nodiscard]] ViewStatus status();
  // Of the scene that was prepared last; nothing until one was.
  [[nodiscard]] std::optional<SceneMemory> memory() const;
  // What preparing the scene had to say.
  [[nodiscard]] Report take_warnings();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace basicrt
