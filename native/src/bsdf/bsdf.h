// SPDX-License-Identifier: GPL-3.0-or-later
// The contract of scattering at a surface. Directions point away from the surface and have unit length; densities are
// over solid angle; values include the cosine.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "base/assert.h"
#include "base/table.h"
#include "bsdf/lobe.h"
#include "bsdf/lobes.h"
#include "geometry/surface_point.h"
#include "math/color.h"
#include "math/frame.h"
#include "math/ray.h"
#include "shading/evaluator.h"
#include "shading/material.h"

namespace basicrt {

// The RayKind of a ray that was scattered so; 0 for one that passed straight through and keeps its own.
[[nodiscard]] inline std::uint32_t ray_kind(ScatterKind kind) {
  switch (kind) {
    case ScatterKind::diffuse:
      return ray_diffuse;
    case ScatterKind::glossy:
      return ray_glossy;
    case ScatterKind::transmission:
      return ray_transmission;
    case ScatterKind::volume:
      return ray_volume;
    case ScatterKind::transparent:
    case ScatterKind::subsurface:
      break;
  }
  return 0;
}

struct BsdfSample {
  Vec3f wi;       // world space
  Color weight;   // value times cosine over pdf
  float pdf = 0;  // of the whole Bsdf for wi, over solid angle; where is_delta it is no density and must not be used
  bool is_delta = false;
  ScatterKind kind = ScatterKind::diffuse;
  bool is_translucent = false;  // transmitted and spread evenly
  // Of kind subsurface: the lobe, which is the Bsdf's, and the normal of the surface as it sees it, on wo's side.
  const Subsurface* subsurface = nullptr;
  Vec3f normal{};
};

// How much of a surface is like a mirror, as the denoisers of Blender 5.2 ask.
struct Specularity {
  Color albedo{0.0f};   // what its smooth lobes return; from an alpha of 0.15 on they are not smooth at all
  float roughness = 0;  // the mean by what each lobe returns, the root of microfacets' alpha; all others count as 1
};

struct BsdfValue {
  Color value{0.0f};  // f * |cos|, without delta lobes
  float pdf = 0;      // that sample() gives wi, over solid angle
};

// The lobes of one surface point as seen from one direction, few and of fixed room, so that shading never allocates.
// Lobes may have normals of their own, which bumps give them. Light that the shading normal would let leak through the
// geometric surface is cut off: wi must lie on the same side of both.
class Bsdf {
 public:
  static constexpr int max_lobes = 16;

  Bsdf() = default;
  // The normals keep the surface's own side, as in SurfacePoint.
  Bsdf(const Frame& shading_frame, Vec3f geometric_normal)
      : frame_(shading_frame), geometric_normal_(geometric_normal), smooth_normal_(shading_frame.normal) {}
  // The lobes of another surface point.
  Bsdf(const Frame& shading_frame, Vec3f geometric_normal, const Bsdf& other)
      : frame_(shading_frame),
        geometric_normal_(geometric_normal),
        smooth_normal_(shading_frame.normal),
        albedo_(other.albedo_),
        selection_(other.selection_),
        has_only_deltas_(other.has_only_deltas_),
        only_reflects_(other.only_reflects_),
        lobes_(other.lobes_) {}

  // Adds a lobe with a colour weight; black ones are left out. `albedo` is a guess of the share that the lobe itself
  // reflects or transmits: lobes are picked in proportion. Never more than max_lobes: validate() has refused such a
  // material.
  template <class OneLobe>
  void add(const OneLobe& lobe, Color weight, Color albedo = Color(1.0f)) {
    const Color share = weight * albedo;
    const float selection = luminance(share);
    if (!(selection > 0)) return;
    lobes_.append({lobe, weight, selection, current_frame_});
    selection_ += selection;
    albedo_ += share;
    has_only_deltas_ = has_only_deltas_ && lobe.is_delta();
    only_reflects_ = only_reflects_ && (is_reflection<OneLobe> || lobe.is_delta());
  }

  // wo is the direction that the lobes were made for.
  [[nodiscard]] BsdfValue eval(Vec3f wo, Vec3f wi) const;
  // The same for a light that meets the smooth surface which the shading normal stands for: it may stand behind the
  // facet that stands in for it. sample() gives no such direction, so its density is 0.
  [[nodiscard]] BsdfValue eval_smooth(Vec3f wo, Vec3f wi) const;
  // The value of those scatterings only that rays of the given kinds (RayKind bits) follow; the density of all.
  [[nodiscard]] BsdfValue eval_kinds(Vec3f wo, Vec3f wi, std::uint32_t kinds) const;
  // `choice` picks the lobe, `u` the direction. Nothing where the light is absorbed.
  [[nodiscard]] std::optional<BsdfSample> sample(Vec3f wo, float choice, Vec2f u) const;

  // Then eval() is zero everywhere and lights need not be sampled: of mirrors, panes and bodies that scatter beneath.
  [[nodiscard]] bool has_only_deltas() const { return has_only_deltas_; }
  [[nodiscard]] bool is_empty() const { return lobes_.count == 0; }
  // Where all light must come from that eval() is to see: the side of a surface with this normal, of unit length. Zero
  // where it may come from anywhere.
  [[nodiscard]] Vec3f lit_side(Vec3f wo) const {
    return only_reflects_ && other_frames_.count == 0 ? frame_.normal * (dot(geometric_normal_, wo) < 0 ? -1.0f : 1.0f)
                                                      : Vec3f(0.0f);
  }
  // A cheap guess of the reflected and transmitted share, for Russian roulette and passes.
  [[nodiscard]] Color albedo_estimate() const { return albedo_; }
  // A better one, of what is scattered in one way: see pass_albedo.cpp.
  [[nodiscard]] Color albedo(Vec3f wo, ScatterKind kind) const;
  // Of all but what passes straight through.
  [[nodiscard]] Specularity specularity(Vec3f wo) const;

  // The mean of the lobes' normals on the surface's own side, or of those that scatter in one way; the smooth one where
  // there are none. See pass_surface.cpp for this and the next.
  [[nodiscard]] Vec3f mean_normal(std::optional<ScatterKind> kind = {}) const;
  // The mean of those lobes that have one, as nodes have it, the root of microfacets' alpha; 1 where none does.
  [[nodiscard]] float mean_roughness() const;

  [[nodiscard]] bool has_subsurface() const;
  // Of subsurface lobes: their mean where they have normals of their own, else the surface's own.
  [[nodiscard]] Vec3f subsurface_normal() const;
  // Whether bumps have turned some lobe.
  [[nodiscard]] bool is_turned() const { return is_turned_; }

  // The normal of the lobes that are added from now on.
  void use_normal(Vec3f normal);

  // Makes microfacets' alpha at least so much, mirrors rough. See adjust.cpp for this and the next.
  void roughen(float least_alpha);
  // Leaves out reflection by microfacets and mirrors, transmission by them, or both.
  void remove_glossy(bool removes_reflection, bool removes_transmission);
  void remove_opaque();  // all but what passes straight through
  // Leaves out all that scatters otherwise than rays of these kinds (RayKind bits) do, and what passes straight through.
  void keep_kinds(std::uint32_t kinds);
  // The alpha of the smoothest interface that light is transmitted through; infinite where there is none.
  [[nodiscard]] float transmission_alpha() const;

 private:
  template <class OneLobe>
  static constexpr bool is_reflection = requires { OneLobe::reflection_kind; };

  struct WeightedLobe {
    Lobe lobe;
    Color weight;
    float selection;     // in proportion to the probability of being picked; all of them add up to selection_
    std::uint8_t frame;  // 0 is frame_, others are those of other_frames_
  };
  // Only the items in use are made and copied: all sixteen lobes would cost more than shading does.
  template <class Item>
  struct List {
    int count = 0;
    union {
      Item items[max_lobes];
    };

    List() {}  // NOLINT: nothing yet
    List(const List& other) { *this = other; }
    List& operator=(const List& other) {
      count = other.count;
      for (int i = 0; i < count; ++i) std::construct_at(&items[i], other.items[i]);
      return *this;
    }
    void append(const Item& item) {
      BASICRT_ASSERT(count < max_lobes);
      std::construct_at(&items[count++], item);
    }
    [[nodiscard]] std::span<const Item> used() const { return {items, static_cast<std::size_t>(count)}; }
  };

  // The directions as the lobes want them: z is the shading normal on wo's side of the surface.
  struct Side {
    float sign;  // -1: wo is at the back of the surface
    Vec3f wo;
  };
  [[nodiscard]] Side find_side(const Frame& frame, Vec3f wo) const {
    const float sign = dot(geometric_normal_, wo) < 0 ? -1.0f : 1.0f;
    return {sign, frame.to_local(wo * sign)};
  }
  // Of what a lobe scatters there.
  [[nodiscard]] float bump_shadowing(const WeightedLobe& lobe, const Frame& frame, Vec3f wi) const;
  [[nodiscard]] const Frame& frame_of(const WeightedLobe& lobe) const {
    return lobe.frame == 0 ? frame_ : other_frames_.items[lobe.frame - 1];
  }
  [[nodiscard]] bool leaks(const Side& side, Vec3f world_wi, Vec3f local_wi) const {
    return (dot(geometric_normal_, world_wi) * side.sign > 0) != (local_wi.z > 0);
  }
  [[nodiscard]] LobeValue eval_lobes(Vec3f wo, Vec3f wi, const WeightedLobe* except) const;
  // The same of directions in world space, each lobe in its own frame. Those that leak may still count, without a
  // density.
  [[nodiscard]] LobeValue eval_turned(Vec3f wo, Vec3f wi, const WeightedLobe* except, bool may_leak) const;
  void rebuild(auto&& change);

  Frame frame_;
  Vec3f geometric_normal_{0, 0, 1}, smooth_normal_{0, 0, 1};
  Color albedo_{0.0f};
  float selection_ = 0;
  bool has_only_deltas_ = true, only_reflects_ = true;
  bool is_turned_ = false;  // some lobes may have another normal than the surface
  List<WeightedLobe> lobes_;
  List<Frame> other_frames_;
  std::uint8_t current_frame_ = 0;
};

// All lobes, or all but one.
inline LobeValue Bsdf::eval_lobes(Vec3f wo, Vec3f wi, const WeightedLobe* except) const {
  LobeValue sum;
  for (const WeightedLobe& weighted : lobes_.used()) {
    if (&weighted == except) continue;
    // The lobe of most surfaces is spared the call, which costs more than it does.
    const auto* lambert = std::get_if<Lambert>(&weighted.lobe);
    const LobeValue lobe =
        lambert ? lambert->eval(wo, wi) : std::visit([&](const auto& l) { return l.eval(wo, wi); }, weighted.lobe);
    sum.value += weighted.weight * lobe.value;
    sum.pdf += weighted.selection / selection_ * lobe.pdf;
  }
  return sum;
}

inline BsdfValue Bsdf::eval(Vec3f wo, Vec3f wi) const {
  if (is_turned_) {
    const LobeValue sum = eval_turned(wo, wi, nullptr, false);
    return {sum.value, sum.pdf};
  }
  const Side side = find_side(frame_, wo);
  const Vec3f local_wi = frame_.to_local(wi * side.sign);
  if (leaks(side, wi, local_wi)) return {};
  const LobeValue sum = eval_lobes(side.wo, local_wi, nullptr);
  return {sum.value, sum.pdf};
}

inline BsdfValue Bsdf::eval_smooth(Vec3f wo, Vec3f wi) const {
  if (is_turned_) {
    const LobeValue sum = eval_turned(wo, wi, nullptr, true);
    return {sum.value, sum.pdf};
  }
  const Side side = find_side(frame_, wo);
  const Vec3f local_wi = frame_.to_local(wi * side.sign);
  const bool is_leak = leaks(side, wi, local_wi);
  if (is_leak && !(local_wi.z > 0)) return {};
  const LobeValue sum = eval_lobes(side.wo, local_wi, nullptr);
  return {sum.value, is_leak ? 0 : sum.pdf};
}

// What a material does at a surface point seen from wo: scatters, emits, and lets through unscattered.
struct SurfaceShading {
  Bsdf bsdf;
  Color emission{0.0f};  // radiance towards wo
  float holdout = 0;     // the share that is a hole
  // It is the same, but for the frame, at every point and for every wo on this side of the surface.
  bool is_uniform = true;
};

[[nodiscard]] SurfaceShading shade(const Material& material, const Table<Texture>& textures, const SurfacePoint& point,
                                   Vec3f wo, const ShadingContext& context = {});

// The share of light that passes straight through in direction wo, for shadow rays: black for an opaque material.
[[nodiscard]] Color transparency(const Material& material, const Table<Texture>& textures, const SurfacePoint& point,
                                 Vec3f wo, const ShadingContext& context = {});
[[nodiscard]] bool is_transparent(const Material& material);  // may transparency() be anything but black
// The same material with only what transparency() looks at.
[[nodiscard]] Material transparent_part(Material material);

// Whether shade() looks at the point's dpdu and so on: add_derivatives() first.
[[nodiscard]] bool needs_derivatives(const Material& material);

// What the front (where the normal points) or the back of a surface emits, in every direction alike. Black where it is
// not the same at every point.
enum class SurfaceSide : std::uint8_t { front, back };
[[nodiscard]] Color emitted_radiance(const Material& material, SurfaceSide side);
// Whether a side shines, but not the same everywhere and in every direction: emitted_radiance() doesn't say how much.
[[nodiscard]] bool has_varying_emission(const Material& material, SurfaceSide side);
[[nodiscard]] bool is_emissive(const Material& material);

// The most lobes that the material can make anywhere, and at least one for each way through its graphs: what
// validate() holds against Bsdf::max_lobes.
[[nodiscard]] int lobe_count(const Material& material);

}  // namespace basicrt
