// SPDX-License-Identifier: GPL-3.0-or-later
// The interface to a transparent medium, smooth or rough: reflection and refraction with Fresnel's shares (glass), or
// refraction of all that total internal reflection leaves (perfect refraction).
#pragma once

#include <algorithm>

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacets.h"
#include "bsdf/refraction.h"

namespace basicrt {

enum class ReflectedLight : std::uint8_t {
  by_fresnel,
  only_past_critical_angle,  // the assignment's
  none,                      // Blender's Refraction node: total internal reflection is black
};

// Walter et al. 2007, "Microfacet models for refraction through rough surfaces", with visible normals. As in Blender,
// refraction does not scale radiance by eta^2: what a closed body takes off on entry it would give back on exit.
struct Dielectric {
  float eta = 1.5f;  // index beyond the surface over index on the viewer's side
  float alpha = 0;   // of the microfacets
  MicrofacetModel model = MicrofacetModel::ggx;
  ReflectedLight reflected = ReflectedLight::by_fresnel;
  Color reflect_tint{1.0f}, transmit_tint{1.0f};

  // Media of the same index bend nothing, however rough the surface between them.
  [[nodiscard]] bool is_delta() const { return microfacets().is_smooth() || std::abs(eta - 1) < 1e-4f; }

  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const {
    if (is_delta() || !(wo.z > 0) || wi.z == 0) return {};
    return wi.z > 0 ? eval_reflection(wo, wi) : eval_refraction(wo, wi);
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
    if (!(is_reflected ? wi.z > 0 : wi.z < 0 && split.transmittance > 0)) return std::nullopt;

    LobeSample sample{wi,
                      is_reflected ? reflect_tint * (split.reflectance / split.reflect_probability)
                                   : transmit_tint * (split.transmittance / (1 - split.reflect_probability)),
                      1, is_smooth, is_reflected ? ScatterKind::glossy : ScatterKind::transmission};
    if (is_smooth) return sample;
    const float area = microfacets().projected_area(wo);
    sample.weight *= area * microfacets().masking_over_cosine(wo, wi);
    sample.pdf = microfacets().density(normal) / area *
                 (is_reflected ? split.reflect_probability / 4
                               : (1 - split.reflect_probability) * refraction_jacobian(wo, wi, normal, eta));
    return sample;
  }

  // Reflected and refracted share as if smooth.
  [[nodiscard]] Color albedo(float cos_theta) const {
    const Split split = split_light(cos_theta);
    return reflect_tint * split.reflectance + transmit_tint * split.transmittance;
  }

 private:
  // How light that meets a microfacet is divided, and how samples are.
  struct Split {
    float reflectance, transmittance, cos_transmitted, reflect_probability;
  };
  [[nodiscard]] Split split_light(float cos_incident) const {
    const DielectricFresnel fresnel = fresnel_dielectric(cos_incident, eta);
    const bool is_total = fresnel.reflectance >= 1;
    const float transmittance = reflected == ReflectedLight::by_fresnel ? 1 - fresnel.reflectance
                                : is_total                              ? 0.0f
                                                                        : 1.0f;
    const float reflectance = reflected == ReflectedLight::none ? 0 : 1 - transmittance;
    const float reflected_share = reflectance * luminance(reflect_tint);
    const float total = reflected_share + transmittance * luminance(transmit_tint);
    return {reflectance, transmittance, fresnel.cos_transmitted, total > 0 ? reflected_share / total : 0};
  }

  [[nodiscard]] Microfacets microfacets() const { return {alpha, alpha, model}; }

  [[nodiscard]] LobeValue eval_reflection(Vec3f wo, Vec3f wi) const {
    const Vec3f normal = normalize(wo + wi);
    const Split split = split_light(std::min(dot(wo, normal), 1.0f));
    const float density = microfacets().density(normal) / 4;
    return {reflect_tint * (split.reflectance * density * microfacets().masking_over_cosine(wo, wi)),
            split.reflect_probability * density / microfacets().projected_area(wo)};
  }

  [[nodiscard]] LobeValue eval_refraction(Vec3f wo, Vec3f wi) const {
    Vec3f normal = normalize(wo + wi * eta);
    if (normal.z < 0) normal = -normal;
    const float cos_incident = dot(wo, normal);
    if (!(cos_incident > 0) || !(dot(wi, normal) < 0)) return {};
    const Split split = split_light(std::min(cos_incident, 1.0f));
    const float density = microfacets().density(normal) * refraction_jacobian(wo, wi, normal, eta);
    return {transmit_tint * (split.transmittance * density * microfacets().masking_over_cosine(wo, wi)),
            (1 - split.reflect_probability) * density / microfacets().projected_area(wo)};
  }
};

}  // namespace basicrt
