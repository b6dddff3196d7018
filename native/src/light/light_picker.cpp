// SPDX-License-Identifier: GPL-3.0-or-later
// Shares the choice by importance, but not all of it.
#include "light/light_picker.h"

#include <algorithm>

#include "base/assert.h"

namespace basicrt {
namespace {

// The share that does not go by importance: what seems strong may be in shadow, and must not starve the others.
constexpr float even_share = 0.25f;

}  // namespace

void LightPicker::add_source(std::uint32_t primitives) {
  firsts_.push_back(places_.size());
  places_.resize(places_.size() + primitives, no_light);
}

void LightPicker::add(LightRef light, const LightBounds& bounds) {
  if (!(bounds.intensity > 0)) return;
  place_of(light) = static_cast<std::uint32_t>(near_.size());
  near_.push_back(light);
  bounds_.push_back(bounds);
}

void LightPicker::add_distant(LightRef light, const DistantBounds& bounds) {
  if (!(bounds.irradiance > 0)) return;
  place_of(light) = static_cast<std::uint32_t>(distant_.size()) | distant_bit;
  distant_.push_back({light, bounds});
  distant_.back().bounds.irradiance = std::min(bounds.irradiance, 1e36f);  // so that sums stay finite
}

void LightPicker::build() {
  if (size() > 1 && !bounds_.empty()) tree_ = LightTree(std::move(bounds_));
  bounds_ = {};
}

LightPicker::Shares LightPicker::share(const LitPoint& point) const {
  Shares shares;
  const auto add = [&](float importance) {
    shares.total += importance;
    shares.shining += importance > 0;
  };
  if (!tree_.is_empty()) {
    shares.at_root = tree_.weigh_root(point);
    add(shares.at_root.is_guess ? 0 : shares.at_root.total);
  }
  for (const Distant& distant : distant_) add(importance(distant.bounds, point));
  if (shares.shining == 0) shares.shining = int(distant_.size()) + !tree_.is_empty();
  return shares;
}

float LightPicker::Shares::probability(float importance) const {
  const float even = 1 / static_cast<float>(shining);
  if (!(total > 0)) return even;
  if (!(importance > 0)) return 0;
  return shining == 1 ? 1 : (1 - even_share) * importance / total + even_share * even;
}

LightPicker::Pick LightPicker::pick(const LitPoint& point, float u) const {
  BASICRT_ASSERT(size() > 0);
  if (size() == 1) return {near_.empty() ? distant_.front().light : near_.front(), 1};
  if (distant_.empty()) {
    const LightTree::Choice choice = tree_.choose(point, u);
    return {near_[choice.light], choice.probability};
  }

  const Shares shares = share(point);
  Pick last{};  // takes what rounding leaves over
  for (const Distant& distant : distant_) {
    const float probability = shares.probability(importance(distant.bounds, point));
    if (!(probability > 0)) continue;
    last = {distant.light, probability};
    if (u < probability) return last;
    u -= probability;
  }
  if (tree_.is_empty()) return last;
  const float probability = shares.probability(shares.at_root.is_guess ? 0 : shares.at_root.total);
  if (!(probability > 0)) return last;
  const LightTree::Choice choice =
      tree_.choose(point, std::clamp(u / probability, 0.0f, one_minus_epsilon), shares.at_root);
  return {near_[choice.light], probability * choice.probability};
}

float LightPicker::probability(LightRef light, const LitPoint& point) const {
  const std::uint32_t place = places_[firsts_[light.source] + light.primitive];
  if (place == no_light) return 0;
  if (size() == 1) return 1;
  if (distant_.empty()) return tree_.probability(place, point);
  const Shares shares = share(point);
  if ((place & distant_bit) != 0) return shares.probability(importance(distant_[place & ~distant_bit].bounds, point));
  const float of_tree = shares.probability(shares.at_root.is_guess ? 0 : shares.at_root.total);
  return of_tree > 0 ? of_tree * tree_.probability(place, point) : 0;
}

std::size_t LightPicker::bytes() const {
  return tree_.bytes() + near_.size() * sizeof(LightRef) + places_.size() * sizeof(std::uint32_t);
}

}  // namespace basicrt
