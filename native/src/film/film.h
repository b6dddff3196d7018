// SPDX-License-Identifier: GPL-3.0-or-later
// The picture being made: weighted sums of samples, a tile at a time, and the finished values.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "film/channels.h"
#include "film/exact_sum.h"
#include "film/pass_values.h"
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
  // Of a range of the samples, TileAccumulator's words, for the same pixels.
  std::vector<std::uint32_t> sums = {};

  // Where a pass begins in `values`.
  [[nodiscard]] std::size_t pass_begin(Pass pass) const {
    return static_cast<std::size_t>(layout.offset(pass)) * rect.width * rect.height;
  }
};

// How many of a pixel's samples are added up as floats; sums of blocks are added up exactly.
inline constexpr int sample_block = 64;

struct AccumulatorOptions {
  float negative_mass = 0;  // PixelFilter's
  bool has_shadow_catchers = false;
  int samples = 1;  // the most that a pixel is to have; of more than a block, blocks' sums are added up exactly
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
  TileAccumulator(PixelRect rect, PassLayout layout, AccumulatorOptions options = {});

  // `x`, `y` within the rectangle; `values` is the sample's row of PassValues.
  void add(int x, int y, const PixelSample& sample, bool is_negative = false, std::span<const float> values = {});
  // Of a positive sample; ids that no pass asks for are ignored.
  void add_matte(int x, int y, const MatteSample& matte);
  // Nothing can be added after it.
  [[nodiscard]] Tile finish();

  // The sums as whole numbers, pixel by pixel, row 0 at the bottom. Those of disjoint ranges of a pixel's samples add up
  // to the sums of all of them, exactly where ranges begin and end at multiples of sample_block; mattes are left out.
  // Needs more samples than a block.
  [[nodiscard]] std::vector<std::uint32_t> take_words();
  [[nodiscard]] std::size_t words_per_pixel() const;
  // What another accumulator of the same kind took, of samples behind those that this one has.
  void add_words(std::span<const std::uint32_t> words);

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
  struct Matte {
    std::uint32_t id;
    float coverage;
  };

  [[nodiscard]] std::size_t pixel_count() const { return pixels_.size(); }
  [[nodiscard]] Mean mean(std::size_t index) const;
  void add_values(std::size_t index, std::span<const float> values, bool is_negative, bool is_first);
  void add_behind_catchers(Mean& mean, std::size_t index) const;
  [[nodiscard]] Color catcher_share(std::size_t index) const;
  // Calls visit(float&) for each of a pixel's sums, and for what its first hit said.
  void visit_sums(std::size_t index, auto&& visit);
  void visit_first(std::size_t index, auto&& visit);
  void fold_block(std::size_t index);
  void sum_blocks();
  [[nodiscard]] float mean_value(std::size_t index, Pass pass, std::size_t channel) const;
  [[nodiscard]] float mean_of_some(std::size_t index, const PassInfo& info, std::size_t channel) const;
  void write_values(const PassInfo& info, std::size_t index, float* out) const;
  void rank_mattes();  // by coverage, then by id
  void write_mattes(const PassInfo& info, std::size_t index, float* out) const;

  PixelRect rect_;
  PassLayout layout_, recorded_;
  AccumulatorOptions options_;
  std::size_t value_count_;                                 // in a sample's row
  std::array<std::size_t, passes.size()> value_offsets_{};  // of recorded passes, in that row
  std::vector<bool> is_first_;                              // of each of those: the first hit's is kept
  std::vector<Pixel> pixels_;
  std::vector<Sums> negative_;           // empty where the filter has no negative lobes
  std::vector<CatcherSample> catchers_;  // sums of positive samples; empty without shadow catchers
  std::vector<float> values_, negative_values_;
  std::size_t sum_count_;                   // of each pixel
  std::vector<ExactSum> exact_;             // of finished blocks
  std::vector<std::vector<Matte>> mattes_;  // by pixel, then kind; empty where no pass is of them
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
  // Of a range of the samples: height x width x so many words; 0 outside the border.
  [[nodiscard]] const std::vector<std::uint32_t>& sums() const { return sums_; }
  [[nodiscard]] std::size_t sums_per_pixel() const {
    return sums_.size() / (static_cast<std::size_t>(width_) * height_);
  }

 private:
  template <class Value>
  void write_rows(const PixelRect& rect, std::size_t row_size, const Value* from, std::vector<Value>& to) const;

  int width_, height_;
  PassLayout layout_;
  std::vector<std::vector<float>> values_;
  std::vector<std::uint32_t> sums_;
};

}  // namespace basicrt
