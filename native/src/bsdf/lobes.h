// SPDX-License-Identifier: GPL-3.0-or-later
// THE list of lobes: a new one is a header and a line here.
#pragma once

#include <variant>

#include "bsdf/ashikhmin_shirley.h"
#include "bsdf/chiang_hair.h"
#include "bsdf/dielectric.h"
#include "bsdf/film_dielectric.h"
#include "bsdf/lambert.h"
#include "bsdf/microfacet_reflection.h"
#include "bsdf/oren_nayar.h"
#include "bsdf/sheen.h"
#include "bsdf/simple_hair.h"
#include "bsdf/subsurface.h"
#include "bsdf/thin_film.h"
#include "bsdf/toon.h"
#include "bsdf/translucent.h"
#include "bsdf/transparent.h"
#include "bsdf/velvet.h"

namespace basicrt {

using DiffuseToon = Toon<ScatterKind::diffuse>;
using GlossyToon = Toon<ScatterKind::glossy>;

using Lobe = std::variant<Lambert,                                       //
                          MicrofacetReflection<NoFresnel>,               // Glossy
                          MicrofacetReflection<SchlickFresnel>,          // Principled's metal
                          MicrofacetReflection<InterfaceFresnel>,        // Principled's dielectric reflection, coat
                          MicrofacetReflection<ConductorFresnel>,        // measured metals
                          Dielectric,                                    // glass, refraction
                          Transparent,                                   //
                          OrenNayar,                                     // rough diffuse
                          Translucent,                                   //
                          Sheen,                                         // microfibres
                          Velvet,                                        //
                          DiffuseToon, GlossyToon,                       //
                          AshikhminShirley,                              //
                          MicrofacetReflection<F82Fresnel>,              // metal with an edge tint
                          MicrofacetReflection<TintedInterfaceFresnel>,  // Principled's tinted reflection
                          MicrofacetReflection<FilmInterfaceFresnel>,    //
                          MicrofacetReflection<FilmConductorFresnel>,    //
                          FilmDielectric,                                //
                          Subsurface,                                    //
                          ChiangHair, HairReflection, HairTransmission>;

// All sixteen of a Bsdf's are copied with it: a lobe has no more room than the first of them needed.
static_assert(sizeof(Lobe) <= 40);

}  // namespace basicrt
