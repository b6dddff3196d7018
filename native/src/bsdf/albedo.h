// SPDX-License-Identifier: GPL-3.0-or-later
// Directional albedos of microfacets, and the light that bounces between microfacets put back: a single scattering is
// scaled up to what all of them together return (Turquin 2019, "Practical multiple scattering compensation for
// microfacet models"), as Blender's Multiscatter GGX does.
#pragma once

#include "math/color.h"

namespace basicrt {

// What a GGX reflection is multiplied by. `mean_fresnel` is the facets' reflectance averaged over the cosine-weighted
// hemisphere; light that bounces more often meets it more often.
[[nodiscard]] Color multiple_scattering(float roughness, float cos_theta, Color mean_fresnel);

// The same for both parts of rough glass; `eta` as in Dielectric. Light that bounces more often is taken to meet `tint`,
// the refracted light's, as Cycles' measured albedos have it.
[[nodiscard]] Color glass_multiple_scattering(float roughness, float eta, float cos_theta, Color tint);

// A rough dielectric as a layer on something else, seen from outside.
struct DielectricLayer {
  float scale;   // of its single scattering
  float albedo;  // after scaling: what is kept from the layer below
};
[[nodiscard]] DielectricLayer dielectric_layer(float roughness, float ior, float cos_theta);

}  // namespace basicrt
