// SPDX-License-Identifier: GPL-3.0-or-later
// The picture being made: weighted sums of samples, a tile at a time, and the finished values.
#pragma once

#include <vector>

#include "film/channels.h"
#include "math/color.h"
#include "math/vec.h"

namespace basicrt {

// What a camera sample sees by way of shadow catchers.
struct CatcherSample {
  Color lit{0.0f}, unlit{0.0f};  // what they reflect, and what they would without the objects that are none
  Color behind{0.0f};            // what is seen through them
  float hole = 0;                // how much of that is a hole in the film
};

// What the integrator says of one camera sample.
struct PixelSample {
  Color radiance{0.0f};
  float alpha = 1;
  bool has_hit = false;  // the passes below mean something
  float depth = 0;       // along the camera's axis, metres
  Vec3f normal;          // world space, unit length, towards the camera
  CatcherSample catcher;
};

// A rectangle of pixels in film coordinates: x right, y up, (0, 0) the lower left pixel.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  constexpr bool operator==(const PixelRect&) const = default;
};

// Finished values of a rectangle: for each chosen pass, in the order of the table, height x width x channels floats,
// row 0 at the bottom.
struct Tile {
  PixelRect rect;
  PassLayout layout;
  std::vector<float> values;

  // Where a pass begins in `values`.
  [[nodiscard]] std::size_t pass_begin(Pass pass) const {
    return static_cast<std::size_t>(layout.offset(pass)) * rect.width * rect.height;
  }
};

// The sums of one rectangle's samples. Each pixel's samples must be added in order: float sums depend on it.
//
// Where the pixel filter has negative lobes, a pixel is (1 + negative_mass) P - negative_mass N, with P and N the means
// of its positive and its negative samples. With the sums weighted alike and divided by the sum of weights, a pixel of
// few samples would divide by almost nothing; divided by their number, a flat colour would be noisy. This way it is
// exact, no pixel is further out than 1 + 2 negative_mass times its samples, and in the limit it is the filter's
// integral. A pixel with no samples of one sign is the mean of the others.
class TileAccumulator {
 public:
  // `negative_mass` is PixelFilter's.
  TileAccumulator(PixelRect rect, PassLayout layout, float negative_mass = 0, bool has_shadow_catchers = false);

  // `x`, `y` within the rectangle.
  void add(int x, int y, const PixelSample& sample, bool is_negative = false);
  [[nodiscard]] Tile finish() const;

 private:
  // Of the samples of one sign.
  struct Sums {
    int count = 0;
    float alpha = 0;
    Color radiance{0.0f};
    Vec3f normal{0.0f};
  };
  struct Pixel {
    Sums positive;
    float depth = pass_info(Pass::depth).background;
  };
  struct Mean {
    Color radiance;
    float alpha;
    Vec3f normal;
  };
  [[nodiscard]] Mean mean(std::size_t index) const;
  void add_behind_catchers(Mean& mean, std::size_t index) const;

  PixelRect rect_;
  PassLayout layout_;
  float negative_mass_;
  std::vector<Pixel> pixels_;
  std::vector<Sums> negative_;           // empty where the filter has no negative lobes
  std::vector<CatcherSample> catchers_;  // sums of positive samples; empty without shadow catchers
};

// A whole picture put together from tiles.
class Film {
 public:
  Film(int width, int height, PassLayout layout);

  void write(const Tile& tile);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const PassLayout& layout() const { return layout_; }
  // height x width x channels, row 0 at the bottom.
  [[nodiscard]] const std::vector<float>& values(Pass pass) const { return values_[static_cast<std::size_t>(pass)]; }

 private:
  int width_, height_;
  PassLayout layout_;
  std::vector<std::vector<float>> values_;
};

}  // namespace basicrt
