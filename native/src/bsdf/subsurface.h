// SPDX-License-Identifier: GPL-3.0-or-later
// Light that enters a surface, goes about beneath it and leaves elsewhere. As a lobe it only says how light enters:
// integrator/subsurface_walk.h follows it until it is out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "bsdf/microfacets.h"
#include "bsdf/refraction.h"
#include "math/warp.h"
#include "shading/material.h"

namespace basicrt {

class Subsurface {
 public:
  // Below this radius, in metres, light comes out where it went in.
  static constexpr float least_radius = 1e-8f;

  // `radius` is the length in metres that light of each colour goes by what the model makes of it; `alpha` that of the
  // microfacets through which light is refracted on entering.
  Subsurface(SubsurfaceModel model, Color color, Color radius, float ior, float alpha, float anisotropy)
      : color_(clamp_to_unit(color)),
        radius_(radius),
        ior_(std::clamp(ior, 1.01f, 3.8f)),
        packed_alpha_(static_cast<std::uint16_t>(std::clamp(alpha, 0.0f, 1.0f) * alpha_steps + 0.5f)),
        packed_anisotropy_(static_cast<std::int16_t>(
            std::clamp(anisotropy, -0.99f, model == SubsurfaceModel::van_de_hulst ? 0.99f : 0.9f) * anisotropy_steps)),
        model_(model) {}

  // For what this is to the eye: light comes back diffusely.
  static constexpr ScatterKind reflection_kind = ScatterKind::diffuse;
  // No light is reflected at the place itself.
  [[nodiscard]] bool is_delta() const { return true; }
  [[nodiscard]] LobeValue eval(Vec3f /*wo*/, Vec3f /*wi*/) const { return {}; }

  // The direction under the surface. That of a refraction by microfacets keeps all light: what the interface reflects is
  // another lobe's, and what is lost between facets would only darken the body. Half of the light that enters skin does
  // so diffusely.
  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float choice, Vec2f u) const {
    if (model_ == SubsurfaceModel::skin && choice < 0.5f) return entering(-sample_cosine_hemisphere(u));
    if (!(wo.z > 0)) return std::nullopt;
    const float width = model_ == SubsurfaceModel::skin ? 1.0f : alpha();
    const Microfacets facets{width, width};
    const Vec3f normal = facets.is_smooth() ? Vec3f{0, 0, 1} : facets.sample_visible_normal(wo, u);
    const float cos_incident = std::clamp(dot(wo, normal), 0.0f, 1.0f);
    const float sin_transmitted2 = (1 - cos_incident * cos_incident) / (ior_ * ior_);
    const Vec3f wi = refract(wo, normal, cos_incident, std::sqrt(1 - sin_transmitted2), ior_);
    return wi.z < 0 ? std::optional(entering(wi)) : std::nullopt;
  }

  [[nodiscard]] SubsurfaceModel model() const { return model_; }
  [[nodiscard]] Color color() const { return color_; }
  [[nodiscard]] Color radius() const { return radius_; }
  [[nodiscard]] float ior() const { return ior_; }
  [[nodiscard]] float anisotropy() const { return static_cast<float>(packed_anisotropy_) / anisotropy_steps; }

 private:
  static constexpr float alpha_steps = 65535, anisotropy_steps = 32767;

  static LobeSample entering(Vec3f wi) { return {wi, Color(1.0f), 1, true, ScatterKind::subsurface}; }
  [[nodiscard]] float alpha() const { return static_cast<float>(packed_alpha_) / alpha_steps; }

  Color color_, radius_;
  float ior_;
  std::uint16_t packed_alpha_;
  std::int16_t packed_anisotropy_;
  SubsurfaceModel model_;
};

}  // namespace basicrt
