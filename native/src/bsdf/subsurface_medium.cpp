// SPDX-License-Identifier: GPL-3.0-or-later
// From the colour of a thick body to how its particles scatter.
#include "bsdf/subsurface_medium.h"

#include <span>

namespace basicrt {
namespace {

// Numerically a body that absorbs nothing is never left.
constexpr float most_albedo = 0.999999f;
// Bodies darker than this scatter as little light as it says, and get less light instead: nearly none would be found.
constexpr float least_albedo = 0.2f;

float polynomial(float x, std::span<const float> coefficients) {
  float sum = 0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) sum = sum * x + *c;
  return sum;
}

// The fit of Wrenninge, Villemin and Hery 2017, "Path Traced Subsurface Scattering using Anisotropic Phase Functions and
// Non-Exponential Free Flights", after Chiang, Kutz and Burley 2016, "Practical and Controllable Subsurface Scattering
// for Production Path Tracing": two arcs, one for dark and one for bright bodies.
float albedo_of_fit(float color, float g) {
  constexpr float a[] = {1.8260523782f,   -1.28451056436f, -1.79904629312f, 9.19393289202f,
                         -22.8215585862f, 32.0234874259f,  -23.6264803333f, 7.21067002658f};
  constexpr float b[] = {0,
                         31.1491581433f,
                         -201.847017512f,
                         841.576016723f,
                         -2018.09288505f,
                         2731.71560286f,
                         -1935.41424244f,
                         559.009054474f};
  constexpr float c[] = {1.09686102424f, -0.394704063468f, 1.05258115941f, -8.83963712726f,
                         28.8643230661f, -46.8802913581f,  38.5402837518f, -12.7181042538f};
  constexpr float d[] = {0.496310210422f, 0.360146581622f, -2.15139309747f, 17.8896899217f,
                         -55.2984010333f, 82.065982243f,   -58.5106008578f, 15.8478295021f};
  constexpr float e[] = {0,
                         76.7316253952f,
                         -594.356773233f,
                         2448.8834203f,
                         -5576.68528998f,
                         7116.60171912f,
                         -4763.54467887f,
                         1303.5318055f};
  constexpr float f[] = {2.40602999408f, -2.51814844609f, 9.18494908356f, -79.2191708682f,
                         259.082868209f, -403.613804597f, 302.85712436f,  -87.4370473567f};
  const float slope = 4.98511194385f + 0.127355959438f * std::exp(polynomial(g, b));
  const float bright_slope = 4.23190299701f + 0.00310603949088f * std::exp(polynomial(g, e));
  const float bright = std::sqrt(std::sqrt(color));
  return (1 - bright) * polynomial(g, a) * std::pow(std::atan(slope * color), polynomial(g, c)) +
         bright * polynomial(g, d) * std::pow(std::atan(bright_slope * color), polynomial(g, f));
}

// Van de Hulst's similarity, inverted as in d'Eon 2016, "A Hitchhiker's Guide to Multiple Scattering", equation 53.7.
float albedo_of_van_de_hulst(float color, float g) {
  const float s = 4.09712f + 4.20863f * color - std::sqrt(9.59217f + 41.6808f * color + 17.7126f * color * color);
  return (1 - s * s) / (1 - g * s * s);
}

// By the dipole's diffuse reflectance (Jensen et al. 2001, "A practical model for subsurface light transport"): the
// reduced albedo of a body of this colour.
float dipole_albedo(float color, float ior) {
  if (color < 1e-4f) return 0;
  if (color >= 0.995f) return most_albedo;
  const float mean_reflectance = -1.440f / (ior * ior) + 0.710f / ior + 0.668f + 0.0636f * ior;
  const float boundary = 4.0f / 3.0f * (1 + mean_reflectance) / (1 - mean_reflectance);
  float lower = 0, upper = 1;
  for (int i = 0; i < 16; ++i) {
    const float middle = (lower + upper) / 2, s = std::sqrt(3 * (1 - middle));
    const float reflectance = middle / 2 * (1 + std::exp(-boundary * s)) * std::exp(-s);
    (reflectance < color ? lower : upper) = middle;
  }
  return (lower + upper) / 2;
}

// The mean free path that the model makes of its radius.
float mean_free_path(const Subsurface& subsurface, std::size_t channel) {
  const float radius = subsurface.radius()[channel];
  switch (subsurface.model()) {
    case SubsurfaceModel::van_de_hulst:
      return radius;
    case SubsurfaceModel::chiang:
      return radius / (4 * pi);  // about as far as older models, by which the parameter was named
    case SubsurfaceModel::skin:
      return radius * std::sqrt(3 * (1 - dipole_albedo(subsurface.color()[channel], subsurface.ior())));
  }
  return radius;
}

}  // namespace

SubsurfaceMedium make_medium(const Subsurface& subsurface) {
  const float g = subsurface.anisotropy();
  // The fit is of forward scattering alone.
  const bool is_fitted = subsurface.model() != SubsurfaceModel::van_de_hulst && g >= 0;
  SubsurfaceMedium medium{.extinction = {}, .albedo = {}, .anisotropy = g, .weight = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const float color = subsurface.color()[i], length = std::max(mean_free_path(subsurface, i), 1e-16f);
    const float albedo = is_fitted ? albedo_of_fit(color, g) : albedo_of_van_de_hulst(color, g);
    const float bounded = std::clamp(albedo, 0.0f, most_albedo);
    medium.extinction[i] = is_fitted ? 1 / (length * (1 - g)) : 1 / length;
    medium.albedo[i] = std::max(bounded, least_albedo);
    medium.weight[i] = bounded / medium.albedo[i];
  }
  return medium;
}

}  // namespace basicrt
