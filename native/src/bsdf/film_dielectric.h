// SPDX-License-Identifier: GPL-3.0-or-later
// Glass whose reflection at normal incidence is tinted, or that has a thin film on it.
#pragma once

#include <algorithm>

#include "bsdf/lobe.h"
#include "bsdf/microfacets.h"
#include "bsdf/refraction.h"
#include "bsdf/thin_film.h"

namespace basicrt {

// As Dielectric, but the shares of reflected and refracted light have colours of their own.
struct FilmDielectric {
  float eta = 1.5f;  // index beyond the surface over index on the viewer's side
  float alpha = 0;   // of the microfacets
  ThinFilm film;     // relative to the viewer's side
  PackedColor<1> f0_tint, transmit_tint;
  MicrofacetModel model = MicrofacetModel::ggx;
  bool is_reflecting = true, is_transmitting = true;

  [[nodiscard]] bool is_delta() const { return microfacets().is_smooth() || std::abs(eta - 1) < 1e-4f; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (is_delta() || !(wo.z > 0) || wi.z == 0) return {};
    const bool is_reflected = wi.z > 0;
    Vec3f normal = normalize(is_reflected ? wo + wi : wo + wi * eta);
    if (normal.z < 0) normal = -normal;
    const float cos_incident = dot(wo, normal);
    if (!(cos_incident > 0) || (!is_reflected && !(dot(wi, normal) < 0))) return {};
    const Split split = split_light(std::min(cos_incident, 1.0f));
    const float density =
        microfacets().density(normal) * (is_reflected ? 0.25f : refraction_jacobian(wo, wi, normal, eta));
    const Color share = is_reflected ? split.reflected : split.transmitted;
    const float probability = is_reflected ? split.reflect_probability : 1 - split.reflect_probability;
    return {share * (density * microfacets().masking_over_cosine(wo, wi)),
            probability * density / microfacets().projected_area(wo)};
  }

  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float choice, Vec2f u) const {
    if (!(wo.z > 0)) return std::nullopt;
    const bool is_smooth = is_delta();
    const Vec3f normal = is_smooth ? Vec3f{0, 0, 1} : microfacets().sample_visible_normal(wo, u);
    const float cos_incident = std::clamp(dot(wo, normal), 0.0f, 1.0f);
    const Split split = split_light(cos_incident);
    const bool is_reflected = choice < split.reflect_probability;
    const Vec3f wi =
        is_reflected ? normal * (2 * cos_incident) - wo : refract(wo, normal, cos_incident, split.cos_transmitted, eta);
    if (!(is_reflected ? wi.z > 0 : wi.z < 0 && split.cos_transmitted > 0)) return std::nullopt;

    const float probability = is_reflected ? split.reflect_probability : 1 - split.reflect_probability;
    LobeSample sample{wi, (is_reflected ? split.reflected : split.transmitted) / probability, 1, is_smooth,
                      is_reflected ? ScatterKind::glossy : ScatterKind::transmission};
    if (is_smooth) return sample;
    const float area = microfacets().projected_area(wo);
    sample.weight *= area * microfacets().masking_over_cosine(wo, wi);
    sample.pdf = microfacets().density(normal) / area * probability *
                 (is_reflected ? 0.25f : refraction_jacobian(wo, wi, normal, eta));
    return sample;
  }

  // Reflected and refracted share as if smooth.
  [[nodiscard]] Color albedo(float cos_theta) const {
    const Split split = split_light(cos_theta);
    return split.reflected + split.transmitted;
  }

 private:
  struct Split {
    Color reflected, transmitted;
    float cos_transmitted, reflect_probability;
  };
  [[nodiscard]] Split split_light(float cos_incident) const {
    const DielectricFresnel plain = fresnel_dielectric(cos_incident, eta);
    const Color f0 = f0_tint.color() * reflectance_from_ior(eta);
    const Color reflectance = film.is_none() ? TintedInterfaceFresnel{eta, f0}(cos_incident)
                                             : FilmInterfaceFresnel{film, eta, f0}(cos_incident);
    const Color reflected = is_reflecting ? reflectance : Color(0.0f);
    const Color transmitted = is_transmitting && plain.cos_transmitted > 0
                                  ? (Color(1.0f) - reflectance) * transmit_tint.color()
                                  : Color(0.0f);
    const float share = luminance(reflected), total = share + luminance(transmitted);
    return {reflected, transmitted, plain.cos_transmitted, total > 0 ? share / total : 0};
  }
  [[nodiscard]] Microfacets microfacets() const { return {alpha, alpha, model}; }
};

}  // namespace basicrt
