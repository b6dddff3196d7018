// SPDX-License-Identifier: GPL-3.0-or-later
// Large parts are moved by all threads, each with a chunk and bins of its own.
#include "bvh/splitter.h"

#include <algorithm>
#include <vector>

#include "base/assert.h"
#include "bvh/bvh.h"

namespace basicrt {
namespace {

constexpr std::uint32_t chunk_size = 8192;  // primitives that a thread moves at a time
constexpr std::uint32_t most_chunks = 128;  // each has bins of its own
// What a single thread moves in one go: chunks cost it more, but they can be cancelled.
constexpr std::uint32_t longest_move = 1u << 20;

Binning binning_of(const Part& part, int most_bins) {
  const auto bins = static_cast<int>(8 + part.count() / 16);
  return {part.extents.lowest_center, part.extents.highest_center, std::min(most_bins, bins)};
}

// References cut into pieces for threads, in the same way for any number of threads.
class Chunks {
 public:
  explicit Chunks(std::span<const Reference> references)
      : references_(references),
        size_(std::max<std::size_t>(chunk_size, (references.size() + most_chunks - 1) / most_chunks)) {}
  [[nodiscard]] std::size_t count() const { return (references_.size() + size_ - 1) / size_; }
  [[nodiscard]] std::span<const Reference> operator[](std::size_t i) const {
    return references_.subspan(i * size_, std::min(size_, references_.size() - i * size_));
  }

 private:
  std::span<const Reference> references_;
  std::size_t size_;
};

Extents extents_of(std::span<const Reference> references) {
  Extents extents;
  for (const Reference& reference : references) {
    const Float4 center = reference.box.doubled_center();
    extents.extend({reference.box, center, center});
  }
  return extents;
}

// Centres are within the box and within the parent's range.
Extents inside(const Extents& parent, const Box& box) {
  return {box, max(parent.lowest_center, Float4::all(-2) * box.negated_lower),
          min(parent.highest_center, Float4::all(2) * box.upper)};
}
std::array<Part, 2> sides_of(const Part& part) {
  const Split& split = part.split;
  const std::uint32_t middle = part.begin + split.left_count;
  Part left{.begin = part.begin, .end = middle, .buffer = 1 - part.buffer};
  Part right{.begin = middle, .end = part.end, .buffer = 1 - part.buffer};
  left.extents = inside(part.extents, split.left);
  right.extents = inside(part.extents, split.right);
  return {left, right};
}

// Moves references to the sides of a split, each side in the order it was in, and adds them to the side's bins.
void move_to_sides(std::span<const Reference> source, const Split& split, const std::array<Binning, 2>& binnings,
                   std::array<std::uint32_t, 2> places, std::span<Reference> target, std::array<SplitBins, 2>& bins) {
  // Copies, which can't be changed through the references that are written.
  const Split own_split = split;
  const std::array<Binning, 2> own_binnings = binnings;
  const std::array<SplitBins*, 2> own_bins{&bins[0], &bins[1]};
  std::array<Reference*, 2> ends{&target[places[0]], &target[places[0]] + (places[1] - places[0])};
  for (const Reference& reference : source) {
    const Reference copy = reference;
    const Float4 center = copy.box.doubled_center();
    const std::size_t side = own_split.is_right(center);
    own_bins[side]->add(copy.box, own_binnings[side].bins_of(center));
    *ends[side]++ = copy;
  }
}

}  // namespace

float Workspace::half_area(const Box& box) const {
  const Vec3f extent = box.bounds().extent() * scale;
  const float area = extent.x * (extent.y + extent.z) + extent.y * extent.z;
  return area >= 0 ? area : 0;
}

Part Splitter::root() {
  Part root{.begin = 0, .end = static_cast<std::uint32_t>(workspace_.buffers[0].size())};
  measure(root);
  const Vec3f extent = root.extents.box.bounds().extent();
  workspace_.scale = std::min(1 / std::max({extent.x, extent.y, extent.z}), 0x1p126f);
  find_split(root);
  return root;
}

std::pair<Part, Part> Splitter::split(const Part& part) {
  if (!part.split.is_found()) return halve(part);
  std::array<Part, 2> sides = sides_of(part);
  const std::array<Binning, 2> binnings{binning_of(sides[0], workspace_.most_bins),
                                        binning_of(sides[1], workspace_.most_bins)};
  for (int side = 0; side < 2; ++side) bins_[side].clear(binnings[side].bins());
  if (part.count() > (pool_.thread_count() > 1 ? 2 * chunk_size : longest_move)) {
    move_in_chunks(part, sides, binnings);
  } else {
    if (part.count() >= large_part) workspace_.report_work(part.count());
    move_to_sides(workspace_.references(part), part.split, binnings, {sides[0].begin, sides[1].begin},
                  workspace_.buffers[sides[0].buffer], bins_);
  }
  for (int side = 0; side < 2; ++side) {
    if (sides[side].count() <= workspace_.leaf_size) continue;
    sides[side].split = best_split(bins_[side], binnings[side]);
    if (sides[side].split.is_found()) continue;
    measure(sides[side]);
    find_split(sides[side]);
  }
  return {sides[0], sides[1]};
}

std::pair<Part, Part> Splitter::halve(const Part& part) {
  const std::uint32_t blocks = (part.count() / 2 + workspace_.leaf_size - 1) / workspace_.leaf_size;
  Part left = part, right = part;
  left.end = right.begin = part.begin + blocks * workspace_.leaf_size;
  for (Part* const half : {&left, &right}) {
    measure(*half);
    find_split(*half);
  }
  return {left, right};
}

void Splitter::measure(Part& part) {
  const Chunks chunks(workspace_.references(part));
  std::vector<Extents> extents(chunks.count());
  pool_.for_each(chunks.count(), [&](std::size_t i) {
    workspace_.report_work(0);
    extents[i] = extents_of(chunks[i]);
  });
  for (std::size_t i = 1; i < extents.size(); ++i) extents[0].extend(extents[i]);
  part.extents = extents[0];
}

void Splitter::find_split(Part& part) {
  part.split = Split{};
  if (part.count() <= workspace_.leaf_size) return;
  const Chunks chunks(workspace_.references(part));
  const Binning binning = binning_of(part, workspace_.most_bins);
  std::vector<SplitBins> bins(chunks.count());
  pool_.for_each(chunks.count(), [&](std::size_t i) {
    workspace_.report_work(0);
    bins[i].clear(binning.bins());
    for (const Reference& reference : chunks[i])
      bins[i].add(reference.box, binning.bins_of(reference.box.doubled_center()));
  });
  for (std::size_t i = 1; i < bins.size(); ++i) bins[0].merge(bins[i], binning.bins());
  part.split = best_split(bins[0], binning);
}

void Splitter::move_in_chunks(const Part& part, const std::array<Part, 2>& sides,
                              const std::array<Binning, 2>& binnings) {
  const Chunks chunks(workspace_.references(part));
  const std::size_t count = chunks.count();
  std::vector<std::array<std::uint32_t, 2>> places(count + 1);
  pool_.for_each(count, [&](std::size_t i) {
    std::array<std::uint32_t, 2>& counts = places[i + 1];
    for (const Reference& reference : chunks[i]) ++counts[part.split.is_right(reference.box.doubled_center())];
  });
  places[0] = {sides[0].begin, sides[1].begin};
  for (std::size_t i = 0; i < count; ++i)
    for (int side = 0; side < 2; ++side) places[i + 1][side] += places[i][side];
  BASICRT_ASSERT(places[count][0] == sides[0].end && places[count][1] == sides[1].end);

  std::vector<BinPair> bins(count);
  pool_.for_each(count, [&](std::size_t i) {
    workspace_.report_work(chunks[i].size());
    for (int side = 0; side < 2; ++side) bins[i][side].clear(binnings[side].bins());
    move_to_sides(chunks[i], part.split, binnings, places[i], workspace_.buffers[sides[0].buffer], bins[i]);
  });
  for (const BinPair& pair : bins)
    for (int side = 0; side < 2; ++side) bins_[side].merge(pair[side], binnings[side].bins());
}

Split Splitter::best_split(const SplitBins& bins, const Binning& binning) const {
  if (workspace_.leaf_size == 2) return bins.best_split<1>(binning, workspace_.scale);
  return workspace_.leaf_size == 1 ? bins.best_split<0>(binning, workspace_.scale)
                                   : bins.best_split<2>(binning, workspace_.scale);
}

}  // namespace basicrt
