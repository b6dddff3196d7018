// SPDX-License-Identifier: GPL-3.0-or-later
// What a batch of camera samples says of the passes beside Combined, Depth and Normal. Empty where none is asked for.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "film/channels.h"
#include "math/color.h"
#include "math/vec.h"

namespace basicrt {

enum class MatteKind : std::uint8_t { object, material, asset };
inline constexpr int matte_kinds = 3;
[[nodiscard]] constexpr Pass first_matte_pass(MatteKind kind) {
  return static_cast<Pass>(static_cast<int>(Pass::crypto_object) + matte_passes * static_cast<int>(kind));
}

// Something that a sample sees, and how much of the sample it fills.
struct MatteSample {
  std::uint32_t sample;
  std::array<std::uint32_t, matte_kinds> ids;  // by MatteKind
  float coverage;
};

// A row of floats for each sample, with room for the recorded passes.
class PassValues {
 public:
  PassValues() { offsets_.fill(-1); }
  explicit PassValues(PassLayout chosen) : width_(recorded_count(recorded_passes(chosen))) {
    const PassLayout recorded = recorded_passes(chosen);
    for (const PassInfo& info : passes)
      offsets_[static_cast<std::size_t>(info.pass)] =
          recorded.has(info.pass) ? recorded_offset(recorded, info.pass) : -1;
  }

  void begin(std::size_t samples) {
    values_.assign(samples * static_cast<std::size_t>(width_), 0.0f);
    mattes_.clear();
  }
  [[nodiscard]] bool has(Pass pass) const { return offsets_[static_cast<std::size_t>(pass)] >= 0; }
  [[nodiscard]] std::span<const float> row(std::size_t sample) const {
    return {values_.data() + sample * static_cast<std::size_t>(width_), static_cast<std::size_t>(width_)};
  }
  [[nodiscard]] const std::vector<MatteSample>& mattes() const { return mattes_; }

  // Nothing happens where the pass is not recorded.
  void add(std::uint32_t sample, Pass pass, float value) {
    if (has(pass)) *at(sample, pass) += value;
  }
  void add(std::uint32_t sample, Pass pass, Vec3f value) {
    if (!has(pass)) return;
    float* to = at(sample, pass);
    for (int i = 0; i < 3; ++i) to[i] += value[i];
  }
  void add(std::uint32_t sample, Pass pass, Vec3f value, float alpha) {
    add(sample, pass, value);
    if (has(pass)) at(sample, pass)[3] += alpha;
  }
  // Of a pass whose mean is that of the samples that say something: this is one.
  void add_one_of_some(std::uint32_t sample, Pass pass, std::array<float, 4> values) {
    if (!has(pass)) return;
    float* to = at(sample, pass);
    for (std::size_t i = 0; i < values.size(); ++i) to[i] += values[i];
    to[values.size()] += 1;
  }
  void add(const MatteSample& matte) { mattes_.push_back(matte); }

 private:
  [[nodiscard]] float* at(std::uint32_t sample, Pass pass) {
    return values_.data() + sample * static_cast<std::size_t>(width_) + offsets_[static_cast<std::size_t>(pass)];
  }
  int width_ = 0;
  std::array<int, passes.size()> offsets_;
  std::vector<float> values_;
  std::vector<MatteSample> mattes_;
};

}  // namespace basicrt
