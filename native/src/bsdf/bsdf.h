// SPDX-License-Identifier: GPL-3.0-or-later
// The contract of scattering at a surface. Directions point away from the surface and have unit length; densities are
// over solid angle; values include the cosine.
#pragma once

#include <cstdint>
#include <optional>

#include "base/table.h"
#include "bsdf/lobes.h"
#include "geometry/surface_point.h"
#include "math/color.h"
#include "math/frame.h"
#include "shading/material.h"

namespace basicrt {

// How a path was scattered: bounce limits and ray visibility go by it.
enum class ScatterKind : std::uint8_t { diffuse, glossy, transmission, transparent };

struct BsdfSample {
  Vec3f wi;       // world space
  Color weight;   // value times cosine over pdf
  float pdf = 0;  // of the whole Bsdf for wi, over solid angle; where is_delta it is no density and must not be used
  bool is_delta = false;
  ScatterKind kind = ScatterKind::diffuse;
};

struct BsdfValue {
  Color value{0.0f};  // f * |cos|, without delta lobes
  float pdf = 0;      // that sample() gives wi, over solid angle
};

// The lobes of one surface point as seen from one direction, few and of fixed room, so that shading never allocates.
class Bsdf {
 public:
  static constexpr int max_lobes = 8;

  Bsdf() = default;
  // `shading_normal` and `geometric_normal` keep the surface's own side, as in SurfacePoint.
  Bsdf(const Frame& shading_frame, Vec3f geometric_normal)
      : frame_(shading_frame), geometric_normal_(geometric_normal) {}

  // Adds a lobe with a colour weight. Lobes past max_lobes are merged into none: the compiler of materials sees to
  // it that there are never more (validate() refuses such a material).
  void add(const Lobe& lobe, Color weight);

  [[nodiscard]] BsdfValue eval(Vec3f wo, Vec3f wi) const;
  // `choice` picks the lobe, `u` the direction. Nothing where the light is absorbed.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3f wo, float choice, Vec2f u) const;

  [[nodiscard]] bool has_only_deltas() const;  // then eval() is zero everywhere and lights need not be sampled
  [[nodiscard]] bool is_empty() const { return count_ == 0; }
  [[nodiscard]] Color albedo_estimate() const;  // a cheap guess of the reflected share, for Russian roulette and passes

 private:
  struct WeightedLobe {
    Lobe lobe;
    Color weight;
    float selection = 0;  // probability, adds up to one
  };
  Frame frame_;
  Vec3f geometric_normal_{0, 0, 1};
  WeightedLobe lobes_[max_lobes];
  int count_ = 0;
};

// What a material does at a surface point seen from wo: scatters, emits, and lets through unscattered.
struct SurfaceShading {
  Bsdf bsdf;
  Color emission{0.0f};  // radiance towards wo
};

[[nodiscard]] SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point,
                                   Vec3f wo);

// The share of light that passes straight through in direction wo, for shadow rays: black for an opaque material.
[[nodiscard]] Color transparency(const Material& material, const Table<Texture>& textures, const SurfacePoint& point,
                                 Vec3f wo);
[[nodiscard]] bool is_transparent(const Material& material);  // may transparency() be anything but black
[[nodiscard]] bool is_emissive(const Material& material);

}  // namespace basicrt
