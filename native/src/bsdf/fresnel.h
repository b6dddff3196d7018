// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel's equations for unpolarised light: how much a smooth interface reflects.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/color.h"

namespace basicrt {

struct DielectricFresnel {
  float reflectance = 1;  // one: total internal reflection
  float cos_transmitted = 0;
};

// `eta` is the index on the far side over that on the side the light comes from; `cos_incident` in [0, 1].
inline DielectricFresnel fresnel_dielectric(float cos_incident, float eta) {
  const float sin2_transmitted = (1 - cos_incident * cos_incident) / (eta * eta);
  if (sin2_transmitted >= 1) return {};
  const float cos_transmitted = std::sqrt(1 - sin2_transmitted);
  const float parallel = (eta * cos_incident - cos_transmitted) / (eta * cos_incident + cos_transmitted);
  const float perpendicular = (cos_incident - eta * cos_transmitted) / (cos_incident + eta * cos_transmitted);
  return {(parallel * parallel + perpendicular * perpendicular) / 2, cos_transmitted};
}

// The reflectance averaged over the cosine-weighted hemisphere, from outside (eta >= 1): our fit to its quadrature, by
// 2 % at most off up to an index of 5.
inline float mean_fresnel_dielectric(float eta) {
  const float x = eta - 1;
  return x * (0.3275f + 1.559f * x) / (1 + x * (9.21f + 1.449f * x));
}

// A conductor of index `eta` and extinction `k`, both over the index outside. Exact, real arithmetic as in Born and
// Wolf, "Principles of Optics", 14.2.
inline float fresnel_conductor(float cos_incident, float eta, float k) {
  const float cos2 = cos_incident * cos_incident, sin2 = 1 - cos2;
  const float t0 = eta * eta - k * k - sin2;
  const float a2_plus_b2 = std::sqrt(t0 * t0 + 4 * eta * eta * k * k);
  const float a = std::sqrt(std::max((a2_plus_b2 + t0) / 2, 0.0f));
  const float perpendicular = (a2_plus_b2 + cos2 - 2 * a * cos_incident) / (a2_plus_b2 + cos2 + 2 * a * cos_incident);
  const float t1 = cos2 * a2_plus_b2 + sin2 * sin2, t2 = 2 * a * cos_incident * sin2;
  // At grazing incidence onto eta = k = 0 nothing is left to divide by: all is reflected.
  const float parallel = t1 + t2 > 0 ? perpendicular * (t1 - t2) / (t1 + t2) : perpendicular;
  return (perpendicular + parallel) / 2;
}

// Schlick 1994: `f0` at normal incidence, one at grazing.
inline Color fresnel_schlick(float cos_incident, Color f0) {
  const float x = 1 - cos_incident, x2 = x * x;
  return f0 + (Color(1.0f) - f0) * (x2 * x2 * x);
}

// The reflectance of a dielectric at normal incidence, and the index (above one) that has it.
inline float reflectance_from_ior(float ior) {
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}
inline float ior_from_reflectance(float reflectance) {
  const float r = std::sqrt(std::clamp(reflectance, 0.0f, 0.99f));
  return (1 + r) / (1 - r);
}

// How a microfacet reflects: what MicrofacetReflection is made with.
struct NoFresnel {
  [[nodiscard]] Color operator()(float /*cos_incident*/) const { return Color(1.0f); }
};
struct SchlickFresnel {
  Color f0;
  [[nodiscard]] Color operator()(float cos_incident) const { return fresnel_schlick(cos_incident, f0); }
  // Over the cosine-weighted hemisphere: the integral of 2 mu (1 - mu)^5 is 1/21.
  [[nodiscard]] Color mean() const { return f0 + (Color(1.0f) - f0) * (1.0f / 21); }
};
inline Color clamp_to_unit(Color c) { return max(min(c, Color(1.0f)), Color(0.0f)); }

// Schlick's with a dent near grazing incidence, of which the colour there is known: Kutz, Hasan and Edmondson 2021, "Novel
// aspects of the Adobe Standard Material".
struct F82Fresnel {
  Color f0, dent;
  [[nodiscard]] Color operator()(float cos_incident) const {
    const float x = 1 - cos_incident, x2 = x * x, x6 = x2 * x2 * x2;
    return clamp_to_unit(fresnel_schlick(cos_incident, f0) - dent * (cos_incident * x6));
  }
  // The integral of 2 mu^2 (1 - mu)^6 is 1/126. Dents that would reach below zero are cut off, so it may fall short.
  [[nodiscard]] Color mean() const {
    return clamp_to_unit(f0 + (Color(1.0f) - f0) * (1.0f / 21) - dent * (1.0f / 126));
  }
};
// What is reflected at about 82 degrees, where the cosine is 1/7: `share` of Schlick's, or all of `reflectance`.
[[nodiscard]] inline F82Fresnel make_f82_of_reflectance(Color f0, Color reflectance) {
  constexpr float x = 6.0f / 7, x6 = x * x * x * x * x * x;
  return {f0, (fresnel_schlick(1.0f / 7, f0) - reflectance) * (7 / x6)};
}
[[nodiscard]] inline F82Fresnel make_f82(Color f0, Color share) {
  return make_f82_of_reflectance(f0, fresnel_schlick(1.0f / 7, f0) * share);
}

// A dielectric whose reflectance at normal incidence is set to something else; at grazing incidence it stays one.
struct TintedInterfaceFresnel {
  float eta;
  Color f0;
  // How far the reflectance is from normal to grazing incidence's.
  [[nodiscard]] static float share_of_grazing(float reflectance, float f0) {
    return std::clamp((reflectance - f0) / (1 - f0), 0.0f, 1.0f);
  }
  [[nodiscard]] Color operator()(float cos_incident) const {
    return at(share_of_grazing(fresnel_dielectric(cos_incident, eta).reflectance, reflectance_from_ior(eta)));
  }
  [[nodiscard]] Color at(float share) const { return f0 + (Color(1.0f) - f0) * share; }
};
struct InterfaceFresnel {
  float eta;
  [[nodiscard]] Color operator()(float cos_incident) const {
    return Color(fresnel_dielectric(cos_incident, eta).reflectance);
  }
};
struct ConductorFresnel {
  Color eta, k;
  [[nodiscard]] Color operator()(float cos_incident) const {
    return {fresnel_conductor(cos_incident, eta.x, k.x), fresnel_conductor(cos_incident, eta.y, k.y),
            fresnel_conductor(cos_incident, eta.z, k.z)};
  }
  // Over the cosine-weighted hemisphere: that of the F82 model with the same ends, as in Blender.
  [[nodiscard]] Color mean() const { return make_f82_of_reflectance((*this)(1), (*this)(1.0f / 7)).mean(); }
};

}  // namespace basicrt
