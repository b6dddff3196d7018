// SPDX-License-Identifier: GPL-3.0-or-later
// Combines lobes: one is picked to sample, all of them give the value and the density.
#include "bsdf/bsdf.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace basicrt {

namespace {

template <class OneLobe>
constexpr bool is_diffuse = std::is_same_v<OneLobe, Lambert> || std::is_same_v<OneLobe, OrenNayar> ||
                            std::is_same_v<OneLobe, Translucent> || std::is_same_v<OneLobe, DiffuseToon>;

}  // namespace

void Bsdf::use_normal(Vec3f normal) {
  is_turned_ = is_turned_ || normal != smooth_normal_;
  if (lobes_.count == 0 || frame_.normal == normal) {
    if (frame_.normal != normal) frame_ = make_frame(normal);
    current_frame_ = 0;
    return;
  }
  const std::span<const Frame> others = other_frames_.used();
  const auto found = std::ranges::find(others, normal, &Frame::normal);
  current_frame_ = static_cast<std::uint8_t>(found - others.begin() + 1);
  if (found == others.end()) other_frames_.append(make_frame(normal));
}

// Diffuse light fades towards the terminator of the smooth surface as if the bumps were microfacets (Estevez, Lecocq and
// Stein 2019, "A microfacet-based shadowing function to solve the bump terminator problem").
float Bsdf::bump_shadowing(const WeightedLobe& lobe, const Frame& frame, Vec3f wi) const {
  const bool is_soft = std::visit([]<class OneLobe>(const OneLobe&) { return is_diffuse<OneLobe>; }, lobe.lobe);
  if (!is_soft || frame.normal == smooth_normal_) return 1;
  const float cos_bump = std::abs(dot(smooth_normal_, frame.normal)), cos_wi = std::abs(dot(smooth_normal_, wi));
  if (cos_bump >= 1 || cos_wi >= 1) return 1;
  if (cos_wi < 1e-6f) return 0;
  const auto squared_tangent = [](float cosine) { return 1 / (cosine * cosine) - 1; };
  const float squared_alpha = std::min(squared_tangent(cos_bump) / 8, 1.0f);
  return 2 / (1 + std::sqrt(1 + squared_alpha * squared_tangent(cos_wi)));
}

LobeValue Bsdf::eval_turned(Vec3f wo, Vec3f wi, const WeightedLobe* except, bool may_leak) const {
  LobeValue sum;
  for (const WeightedLobe& weighted : lobes_.used()) {
    if (&weighted == except) continue;
    const Frame& frame = frame_of(weighted);
    const Side side = find_side(frame, wo);
    const Vec3f local_wi = frame.to_local(wi * side.sign);
    const bool is_leak = leaks(side, wi, local_wi);
    if (is_leak && !(may_leak && local_wi.z > 0)) continue;
    const LobeValue lobe = std::visit([&](const auto& l) { return l.eval(side.wo, local_wi); }, weighted.lobe);
    sum.value += weighted.weight * lobe.value * bump_shadowing(weighted, frame, wi);
    if (!is_leak) sum.pdf += weighted.selection / selection_ * lobe.pdf;
  }
  return sum;
}

BsdfValue Bsdf::eval_kinds(Vec3f wo, Vec3f wi, std::uint32_t kinds) const {
  BsdfValue sum{.pdf = eval(wo, wi).pdf};
  for (const WeightedLobe& weighted : lobes_.used()) {
    const Frame& frame = frame_of(weighted);
    const Side side = find_side(frame, wo);
    const Vec3f local_wi = frame.to_local(wi * side.sign);
    if (leaks(side, wi, local_wi)) continue;
    const Color weight = weighted.weight * bump_shadowing(weighted, frame, wi);
    std::visit(
        [&]<class OneLobe>(const OneLobe& lobe) {
          ScatterKind kind = local_wi.z > 0 ? ScatterKind::glossy : ScatterKind::transmission;
          if constexpr (is_reflection<OneLobe>) kind = OneLobe::reflection_kind;
          if ((ray_kind(kind) & kinds) != 0) sum.value += weight * lobe.eval(side.wo, local_wi).value;
        },
        weighted.lobe);
  }
  return sum;
}

bool Bsdf::has_subsurface() const {
  return std::ranges::any_of(
      lobes_.used(), [](const WeightedLobe& weighted) { return std::holds_alternative<Subsurface>(weighted.lobe); });
}

Vec3f Bsdf::subsurface_normal() const {
  Vec3f sum(0.0f);
  for (const WeightedLobe& weighted : lobes_.used())
    if (std::holds_alternative<Subsurface>(weighted.lobe)) sum += frame_of(weighted).normal * average(weighted.weight);
  return length_squared(sum) > 0 ? normalize(sum) : smooth_normal_;
}

std::optional<BsdfSample> Bsdf::sample(Vec3f wo, float choice, Vec2f u) const {
  const std::span<const WeightedLobe> lobes = lobes_.used();
  if (lobes.empty()) return std::nullopt;

  // Pick a lobe; what is left of the number picks again inside it.
  std::size_t picked = 0;
  float rest = choice * selection_;
  while (picked + 1 < lobes.size() && rest >= lobes[picked].selection) rest -= lobes[picked++].selection;
  const WeightedLobe& weighted = lobes[picked];
  const float probability = weighted.selection / selection_;
  const float inner_choice = std::min(rest / weighted.selection, one_minus_epsilon);

  const Frame& frame = frame_of(weighted);
  const Side side = find_side(frame, wo);
  const auto lobe = std::visit([&](const auto& l) { return l.sample(side.wo, inner_choice, u); }, weighted.lobe);
  if (!lobe) return std::nullopt;
  // Straight through means exactly that: no rounding on the way to the local frame and back.
  const bool is_straight = lobe->kind == ScatterKind::transparent;
  const Vec3f wi = is_straight ? -wo : frame.to_world(lobe->wi) * side.sign;
  if (!is_straight && leaks(side, wi, lobe->wi)) return std::nullopt;
  const float shadowing = is_turned_ ? bump_shadowing(weighted, frame, wi) : 1;

  BsdfSample sample{wi,         weighted.weight * lobe->weight * shadowing,        lobe->pdf, lobe->is_delta,
                    lobe->kind, std::holds_alternative<Translucent>(weighted.lobe)};
  if (lobe->kind == ScatterKind::subsurface) {
    sample.subsurface = std::get_if<Subsurface>(&weighted.lobe);
    sample.normal = frame.normal * side.sign;
  }
  if (lobe->is_delta) {
    sample.weight *= 1 / probability;
    sample.pdf = probability;
  } else if (lobes.size() > 1) {
    const LobeValue others =
        is_turned_ ? eval_turned(wo, wi, &weighted, false) : eval_lobes(side.wo, lobe->wi, &weighted);
    sample.pdf = probability * lobe->pdf + others.pdf;
    sample.weight = (sample.weight * lobe->pdf + others.value) / sample.pdf;
  }
  return is_black(sample.weight) || !(sample.pdf > 0) ? std::nullopt : std::optional(sample);
}

}  // namespace basicrt
