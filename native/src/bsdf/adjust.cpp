// SPDX-License-Identifier: GPL-3.0-or-later
// Changes to a Bsdf that the path asks for and the material knows nothing of: roughening, and leaving out caustics.
#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/overloaded.h"
#include "bsdf/bsdf.h"
#include "bsdf/lobe_kind.h"

namespace basicrt {

// All lobes again, each after `change`, which may say (by false) that it is left out.
void Bsdf::rebuild(auto&& change) {
  const List<WeightedLobe> old = lobes_;
  lobes_.count = 0;
  selection_ = 0;
  has_only_deltas_ = true;
  for (const WeightedLobe& weighted : old.used()) {
    WeightedLobe changed = weighted;
    if (!std::visit(change, changed.lobe)) continue;
    lobes_.append(changed);
    selection_ += changed.selection;
    has_only_deltas_ = has_only_deltas_ && std::visit([](const auto& lobe) { return lobe.is_delta(); }, changed.lobe);
  }
}

namespace {

// What is neither roughened nor a caustic.
template <class OneLobe>
constexpr bool is_wide =
    std::is_same_v<OneLobe, Lambert> || std::is_same_v<OneLobe, OrenNayar> || std::is_same_v<OneLobe, Translucent> ||
    std::is_same_v<OneLobe, Sheen> || std::is_same_v<OneLobe, Velvet> || std::is_same_v<OneLobe, DiffuseToon> ||
    std::is_same_v<OneLobe, Transparent> || std::is_same_v<OneLobe, Subsurface> ||
    std::is_same_v<OneLobe, HairReflection> || std::is_same_v<OneLobe, HairTransmission>;

}  // namespace

void Bsdf::roughen(float least_alpha) {
  const auto at_least = [&](float& alpha) { alpha = std::max(alpha, least_alpha); };
  const auto roughen_both = [&](auto& facets) {
    at_least(facets.alpha_x);
    at_least(facets.alpha_y);
    return true;
  };
  rebuild(Overloaded{[&](Dielectric& lobe) {
                       at_least(lobe.alpha);
                       return true;
                     },
                     [&](FilmDielectric& lobe) {
                       at_least(lobe.alpha);
                       return true;
                     },
                     [&]<class Fresnel>(MicrofacetReflection<Fresnel>& lobe) { return roughen_both(lobe.microfacets); },
                     [&](AshikhminShirley& lobe) { return roughen_both(lobe); }, [](GlossyToon&) { return true; },
                     [&](ChiangHair& lobe) {
                       lobe.roughen(least_alpha);
                       return true;
                     },
                     []<class OneLobe>(OneLobe&)
                       requires is_wide<OneLobe>
                     { return true; }});
}

void Bsdf::remove_glossy(bool removes_reflection, bool removes_transmission) {
  rebuild(Overloaded{[&](Dielectric& lobe) {
                       if (removes_reflection) lobe.reflect_tint = Color(0.0f);
                       if (removes_transmission) lobe.transmit_tint = Color(0.0f);
                       return !(removes_reflection && removes_transmission);
                     },
                     [&](FilmDielectric& lobe) {
                       lobe.is_reflecting = lobe.is_reflecting && !removes_reflection;
                       lobe.is_transmitting = lobe.is_transmitting && !removes_transmission;
                       return lobe.is_reflecting || lobe.is_transmitting;
                     },
                     [&]<class Fresnel>(MicrofacetReflection<Fresnel>&) { return !removes_reflection; },
                     [&](AshikhminShirley&) { return !removes_reflection; },
                     [&](GlossyToon&) { return !removes_reflection; }, [](ChiangHair&) { return true; },
                     []<class OneLobe>(OneLobe&)
                       requires is_wide<OneLobe>
                     { return true; }});
}

void Bsdf::remove_opaque() {
  rebuild([]<class AnyLobe>(AnyLobe&) { return std::is_same_v<AnyLobe, Transparent>; });
}

void Bsdf::keep_kinds(std::uint32_t kinds) {
  const bool reflects = (kinds & ray_glossy) != 0, transmits = (kinds & ray_transmission) != 0;
  rebuild(Overloaded{[&](Dielectric& lobe) {
                       if (!reflects) lobe.reflect_tint = Color(0.0f);
                       if (!transmits) lobe.transmit_tint = Color(0.0f);
                       return reflects || transmits;
                     },
                     [&](FilmDielectric& lobe) {
                       lobe.is_reflecting = lobe.is_reflecting && reflects;
                       lobe.is_transmitting = lobe.is_transmitting && transmits;
                       return lobe.is_reflecting || lobe.is_transmitting;
                     },
                     [&](ChiangHair& lobe) {
                       lobe.keep_sides(reflects, transmits);
                       return reflects || transmits;
                     },
                     [&]<class AnyLobe>(AnyLobe& lobe)
                       requires(!is_two_sided<AnyLobe>)
                     { return (ray_kind(reflection_kind_of(lobe)) & kinds) != 0; }});
}

float Bsdf::transmission_alpha() const {
  float least = std::numeric_limits<float>::infinity();
  for (const WeightedLobe& weighted : lobes_.used()) {
    if (const auto* lobe = std::get_if<Dielectric>(&weighted.lobe)) least = std::min(least, lobe->alpha);
    if (const auto* lobe = std::get_if<FilmDielectric>(&weighted.lobe)) least = std::min(least, lobe->alpha);
  }
  return least;
}

}  // namespace basicrt
