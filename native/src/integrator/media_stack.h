// SPDX-License-Identifier: GPL-3.0-or-later
// The volumes that a path is in at some point. Where several overlap their coefficients add up.
#pragma once

#include <array>
#include <cstdint>

#include "bsdf/medium.h"

namespace basicrt {

// What a ray meets inside the volumes of a stack together.
struct MediaSum {
  Color extinction{0.0f}, scattering{0.0f}, emission{0.0f};
};

// Each instance is in it once: a path is in its volume from the first time that it enters until it leaves. Leaving what
// isn't there does nothing, and neither does entering where there is no more room.
class MediaStack {
 public:
  static constexpr std::uint32_t capacity = 8;
  static constexpr std::uint32_t world = ~0u;  // stands for an instance: the volume that fills all space

  // The medium must outlive the stack.
  void enter(std::uint32_t instance, const Medium& medium) {
    for (std::uint32_t i = 0; i < count_; ++i)
      if (entries_[i].instance == instance) return;
    if (count_ < capacity) entries_[count_++] = {&medium, instance};
  }
  void leave(std::uint32_t instance) {
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < count_; ++i)
      if (entries_[i].instance != instance) entries_[kept++] = entries_[i];
    count_ = kept;
  }
  [[nodiscard]] bool is_empty() const { return count_ == 0; }
  // What was entered last of what it is in; `world` where there is none.
  [[nodiscard]] std::uint32_t innermost() const { return count_ == 0 ? world : entries_[count_ - 1].instance; }

  [[nodiscard]] MediaSum sum() const {
    MediaSum sum;
    for (std::uint32_t i = 0; i < count_; ++i) {
      sum.extinction += entries_[i].medium->extinction;
      sum.scattering += entries_[i].medium->scattering;
      sum.emission += entries_[i].medium->emission;
    }
    return sum;
  }
  // Calls visit(Scatterer).
  template <class Visitor>
  void for_each_scatterer(Visitor&& visit) const {
    for (std::uint32_t i = 0; i < count_; ++i)
      for (const Scatterer& scatterer : entries_[i].medium->scatterers) visit(scatterer);
  }

 private:
  struct Entry {
    const Medium* medium;
    std::uint32_t instance;
  };
  std::array<Entry, capacity> entries_;
  std::uint32_t count_ = 0;
};

}  // namespace basicrt
