// SPDX-License-Identifier: GPL-3.0-or-later
// Combines lobes: one is picked to sample, all of them give the value and the density.
#include "bsdf/bsdf.h"

#include <algorithm>
#include <memory>

#include "base/assert.h"

namespace basicrt {
namespace {

bool is_delta(const Lobe& lobe) {
  return std::visit([](const auto& l) { return l.is_delta(); }, lobe);
}

}  // namespace

void Bsdf::add(const Lobe& lobe, Color weight, Color albedo) {
  const Color share = weight * albedo;
  const float selection = luminance(share);
  if (!(selection > 0)) return;
  BASICRT_ASSERT(count_ < max_lobes);
  std::construct_at(&lobes_[count_++].filled, lobe, weight, selection);
  selection_ += selection;
  albedo_ += share;
}

Bsdf::Side Bsdf::find_side(Vec3f wo) const {
  const float sign = dot(geometric_normal_, wo) < 0 ? -1.0f : 1.0f;
  return {sign, frame_.to_local(wo * sign)};
}

bool Bsdf::leaks(const Side& side, Vec3f world_wi, Vec3f local_wi) const {
  return (dot(geometric_normal_, world_wi) * side.sign > 0) != (local_wi.z > 0);
}

// All lobes, or all but one.
LobeValue Bsdf::eval_lobes(Vec3f wo, Vec3f wi, int except) const {
  LobeValue sum;
  for (int i = 0; i < count_; ++i) {
    if (i == except) continue;
    const WeightedLobe& weighted = lobes_[i].filled;
    const LobeValue lobe = std::visit([&](const auto& l) { return l.eval(wo, wi); }, weighted.lobe);
    sum.value += weighted.weight * lobe.value;
    sum.pdf += weighted.selection / selection_ * lobe.pdf;
  }
  return sum;
}

BsdfValue Bsdf::eval(Vec3f wo, Vec3f wi) const {
  const Side side = find_side(wo);
  const Vec3f local_wi = frame_.to_local(wi * side.sign);
  if (leaks(side, wi, local_wi)) return {};
  const LobeValue sum = eval_lobes(side.wo, local_wi, -1);
  return {sum.value, sum.pdf};
}

std::optional<BsdfSample> Bsdf::sample(Vec3f wo, float choice, Vec2f u) const {
  if (count_ == 0) return std::nullopt;

  // Pick a lobe; what is left of the number picks again inside it.
  int picked = 0;
  float rest = choice * selection_;
  while (picked + 1 < count_ && rest >= lobes_[picked].filled.selection) rest -= lobes_[picked++].filled.selection;
  const WeightedLobe& weighted = lobes_[picked].filled;
  const float probability = weighted.selection / selection_;
  const float inner_choice = std::min(rest / weighted.selection, one_minus_epsilon);

  const Side side = find_side(wo);
  const auto lobe = std::visit([&](const auto& l) { return l.sample(side.wo, inner_choice, u); }, weighted.lobe);
  if (!lobe) return std::nullopt;
  // Straight through means exactly that: no rounding on the way to the local frame and back.
  const bool is_straight = lobe->kind == ScatterKind::transparent;
  const Vec3f wi = is_straight ? -wo : frame_.to_world(lobe->wi) * side.sign;
  if (!is_straight && leaks(side, wi, lobe->wi)) return std::nullopt;

  BsdfSample sample{wi, weighted.weight * lobe->weight, lobe->pdf, lobe->is_delta, lobe->kind};
  if (lobe->is_delta) {
    sample.weight *= 1 / probability;
    sample.pdf = probability;
  } else if (count_ > 1) {
    const LobeValue others = eval_lobes(side.wo, lobe->wi, picked);
    sample.pdf = probability * lobe->pdf + others.pdf;
    sample.weight = (sample.weight * lobe->pdf + others.value) / sample.pdf;
  }
  return is_black(sample.weight) || !(sample.pdf > 0) ? std::nullopt : std::optional(sample);
}

bool Bsdf::has_only_deltas() const {
  return std::all_of(lobes_, lobes_ + count_, [](const Slot& slot) { return is_delta(slot.filled.lobe); });
}

}  // namespace basicrt
