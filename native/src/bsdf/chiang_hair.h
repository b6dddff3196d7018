// SPDX-License-Identifier: GPL-3.0-or-later
// The Principled Hair BSDF's lobe: what a fibre of dielectric with tilted scales and pigment does to light.
#pragma once

#include <array>
#include <cstdint>

#include "bsdf/fiber.h"
#include "bsdf/lobe.h"

namespace basicrt {

// What the node says, each in its own range.
struct ChiangHairSettings {
  Color absorption{0.0f};         // per fibre radius
  float roughness = 0.3f;         // along the fibre, 0 to 1
  float radial_roughness = 0.3f;  // around it
  float coat = 0;                 // how much smoother the first reflection is: 0 to 1
  float ior = 1.55f;
  float offset = 0.035f;  // the tilt of the scales, radians
};

// Chiang et al. 2016, "A practical and controllable hair and fur model for production path tracing", of four parts: light
// reflected (R), let through (TT), reflected once inside (TRT), and all else. It needs no other normal than
// the lobe's z: how far from the fibre's middle light comes in follows from that.
class ChiangHair {
 public:
  ChiangHair(const ChiangHairSettings& settings, Vec3f fiber);

  [[nodiscard]] bool is_delta() const { return false; }
  [[nodiscard]] LobeValue eval(Vec3f wo, Vec3f wi) const;
  [[nodiscard]] std::optional<LobeSample> sample(Vec3f wo, float choice, Vec2f u) const;
  // No part of it is narrower than a microfacets' lobe with this alpha.
  void roughen(float least_alpha);
  // Leaves out light that comes back on the side it came from, or on the other.
  void keep_sides(bool is_reflecting, bool is_transmitting);
  // A guess of all that comes back.
  [[nodiscard]] Color albedo() const;

 private:
  struct Scattering;
  [[nodiscard]] Scattering scattering(Vec3f wo) const;

  Color absorption_;
  FiberDirection fiber_;
  float variance_, scale_, ior_;
  // So that a lobe has room for it: the root of what share of the variance the first reflection has, and the tilt from -pi
  // to pi, in steps.
  static constexpr std::uint16_t most_coat = 32767, no_tilt = 16383;
  std::uint16_t coat_ : 15;
  std::uint16_t is_reflecting_ : 1 = 1;
  std::uint16_t tilt_ : 15;
  std::uint16_t is_transmitting_ : 1 = 1;
};

// The absorption that makes hair of this colour, seen from afar.
[[nodiscard]] Color hair_absorption_of_color(Color color, float radial_roughness);
// Of the two pigments of natural hair.
[[nodiscard]] Color hair_absorption_of_melanin(float eumelanin, float pheomelanin);

}  // namespace basicrt
