// SPDX-License-Identifier: GPL-3.0-or-later
// What every lobe has in common. A lobe is made for one viewing direction and works in a local frame where z is the
// shading normal on the viewer's side. It is a small value with
//
//   LobeValue eval(Vec3f wo, Vec3f wi) const;                                 zero for a delta lobe
//   std::optional<LobeSample> sample(Vec3f wo, float choice, Vec2f u) const;  nothing: absorbed
//   bool is_delta() const;
//
// One that scatters in one way alone says so, and so promises that it only reflects:
//
//   static constexpr ScatterKind reflection_kind = ...;
//
// Any other is glossy on the viewer's side and transmits to the far one.
// wo.z may be negative where the shading normal turns away from the viewer, who is still on the front of the surface.
#pragma once

#include <cstdint>
#include <optional>

#include "math/color.h"
#include "math/vec.h"

namespace basicrt {

// How a path was scattered: bounce limits and ray visibility go by it.
// `subsurface` is no scattering yet: the light goes on beneath the surface, and is scattered diffusely where it leaves.
enum class ScatterKind : std::uint8_t { diffuse, glossy, transmission, transparent, volume, subsurface };

struct LobeValue {
  Color value{0.0f};  // f * |cos|
  float pdf = 0;      // over solid angle
};

struct LobeSample {
  Vec3f wi;
  Color weight;   // value over pdf
  float pdf = 0;  // over solid angle; of no meaning where is_delta
  bool is_delta = false;
  ScatterKind kind = ScatterKind::diffuse;
};

}  // namespace basicrt
