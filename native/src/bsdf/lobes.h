// SPDX-License-Identifier: GPL-3.0-or-later
// THE list of lobes: a new one is a header and a line here.
#pragma once

#include <variant>

#include "bsdf/dielectric.h"
#include "bsdf/lambert.h"
#include "bsdf/microfacet_reflection.h"
#include "bsdf/transparent.h"

namespace basicrt {

using Lobe = std::variant<Lambert,                                 //
                          MicrofacetReflection<NoFresnel>,         // Glossy
                          MicrofacetReflection<SchlickFresnel>,    // Principled's metal
                          MicrofacetReflection<InterfaceFresnel>,  // Principled's coat of dielectric
                          MicrofacetReflection<ConductorFresnel>,  // measured metals
                          Dielectric,                              // glass, refraction
                          Transparent>;

}  // namespace basicrt
