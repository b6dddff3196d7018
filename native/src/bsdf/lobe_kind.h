// SPDX-License-Identifier: GPL-3.0-or-later
// In which way a lobe scatters, for those that only do so in one, and how rough its facets are.
#pragma once

#include <cmath>
#include <optional>
#include <type_traits>

#include "base/overloaded.h"
#include "bsdf/lobes.h"

namespace basicrt {

// Lobes that reflect and transmit.
template <class AnyLobe>
constexpr bool is_two_sided = std::is_same_v<AnyLobe, Dielectric> || std::is_same_v<AnyLobe, FilmDielectric>;

template <class AnyLobe>
constexpr ScatterKind reflection_kind_of(const AnyLobe& /*lobe*/) {
  if constexpr (std::is_same_v<AnyLobe, Transparent>)
    return ScatterKind::transparent;
  else if constexpr (std::is_same_v<AnyLobe, Translucent> || std::is_same_v<AnyLobe, HairTransmission>)
    return ScatterKind::transmission;
  else if constexpr (requires { AnyLobe::reflection_kind; })
    return AnyLobe::reflection_kind;
  else
    return ScatterKind::glossy;
}

// The alpha of a lobe of microfacets, 0 for a mirror; nothing where there are none.
inline std::optional<float> facet_alpha(const Lobe& any) {
  using Alpha = std::optional<float>;
  return std::visit(
      Overloaded{[](const Dielectric& lobe) { return Alpha(lobe.alpha); },
                 [](const FilmDielectric& lobe) { return Alpha(lobe.alpha); },
                 []<class Fresnel>(const MicrofacetReflection<Fresnel>& lobe) {
                   return Alpha(std::sqrt(lobe.microfacets.alpha_x * lobe.microfacets.alpha_y));
                 },
                 [](const AshikhminShirley& lobe) { return Alpha(std::sqrt(lobe.alpha_x * lobe.alpha_y)); },
                 [](const auto&) { return Alpha(); }},
      any);
}

}  // namespace basicrt
