// SPDX-License-Identifier: GPL-3.0-or-later
// In which way a lobe scatters, for those that only do so in one.
#pragma once

#include <type_traits>

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

}  // namespace basicrt
