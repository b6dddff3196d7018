// SPDX-License-Identifier: GPL-3.0-or-later
// Splits primitives in two, again and again. The pass that moves them to their side of a split also puts them into the
// bins for the next split of that side.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "base/huge_pages.h"
#include "base/progress.h"
#include "base/worker_pool.h"
#include "bvh/references.h"
#include "bvh/split_bins.h"

namespace basicrt {

// Of some primitives: their box, and a range that holds their doubled centres but for roundings.
struct Extents {
  Box box;
  Float4 lowest_center = Float4::all(std::numeric_limits<float>::infinity());
  Float4 highest_center = Float4::all(-std::numeric_limits<float>::infinity());

  void extend(const Extents& other) {
    box.extend(other.box);
    lowest_center = min(lowest_center, other.lowest_center);
    highest_center = max(highest_center, other.highest_center);
  }
};

// Primitives that are to be in one subtree: a part of either of the two buffers.
struct Part {
  std::uint32_t begin = 0, end = 0;
  int buffer = 0;
  Extents extents;
  Split split;  // where there is more than a leaf

  [[nodiscard]] std::uint32_t count() const { return end - begin; }
};

// What all threads share.
struct Workspace {
  std::array<HugeVector<Reference>, 2> buffers;
  std::uint32_t leaf_size;
  int most_bins = 16;
  float scale = 1;  // makes extents about 1
  WorkProgress* progress = nullptr;
  HugeVector<std::uint32_t> primitives;  // of leaves, in the order of the parts

  [[nodiscard]] std::span<Reference> references(const Part& part) {
    return std::span(buffers[part.buffer]).subspan(part.begin, part.count());
  }
  void report_work(std::uint64_t work) const {
    if (progress != nullptr) progress->advance(work);
  }
  // In units of `scale`; 0 where that is no number.
  [[nodiscard]] float half_area(const Box& box) const;
};

// Splits parts in two. What comes out doesn't depend on the number of threads.
class Splitter {
 public:
  Splitter(Workspace& workspace, WorkerPool& pool) : workspace_(workspace), pool_(pool) {}

  // Everything.
  Part root();
  // Into parts that know where to split next.
  std::pair<Part, Part> split(const Part& part);
  // Into two parts of about the same number of primitives, the first of whole leaves.
  std::pair<Part, Part> halve(const Part& part);

 private:
  using BinPair = std::array<SplitBins, 2>;

  // From the primitives themselves.
  void measure(Part& part);
  void find_split(Part& part);

  void move_in_chunks(const Part& part, const std::array<Part, 2>& sides, const std::array<Binning, 2>& binnings);
  [[nodiscard]] Split best_split(const SplitBins& bins, const Binning& binning) const;

  Workspace& workspace_;
  WorkerPool& pool_;
  BinPair bins_;  // of the sides of the last split
};

}  // namespace basicrt
