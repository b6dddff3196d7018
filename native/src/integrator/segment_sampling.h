// SPDX-License-Identifier: GPL-3.0-or-later
// A straight piece of a path through a volume: how much light gets along it, and where on it to look for scattering.
// Distances are measured from the segment's start; its length may be infinite.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "math/color.h"
#include "math/constants.h"

namespace basicrt {

// exp(-extinction distance), where nothing times infinitely far is nothing.
[[nodiscard]] inline float transmittance(float extinction, float distance) {
  return extinction > 0 ? std::exp(-extinction * distance) : 1;
}
[[nodiscard]] inline Color transmittance(Color extinction, float distance) {
  return {transmittance(extinction.x, distance), transmittance(extinction.y, distance),
          transmittance(extinction.z, distance)};
}

// The integral of the transmittance along the segment: what emission is multiplied by. Of an infinite segment that
// nothing dims it is said to be 0.
[[nodiscard]] inline float integrated_transmittance(float extinction, float length) {
  if (extinction > 0) return -std::expm1(-extinction * length) / extinction;
  return length < infinity ? length : 0;
}
[[nodiscard]] inline Color integrated_transmittance(Color extinction, float length) {
  return {integrated_transmittance(extinction.x, length), integrated_transmittance(extinction.y, length),
          integrated_transmittance(extinction.z, length)};
}

// In proportion to `share`, which then adds up to one; nothing where that is black.
[[nodiscard]] inline std::optional<Color> channel_shares(Color share) {
  const float sum = share.x + share.y + share.z;
  return sum > 0 && sum < infinity ? std::optional(share / sum) : std::nullopt;
}

// Which channel a number in [0, 1) picks.
[[nodiscard]] inline std::size_t pick_channel(Color shares, float choice) {
  if (choice < shares.x || (shares.y == 0 && shares.z == 0)) return 0;
  return choice < shares.x + shares.y || shares.z == 0 ? 1 : 2;
}

// Distances to the next collision, by the exponential distribution of one channel picked by chance; densities are those
// of the mixture, so that no weight exceeds what the picked channel bounds (Wilkie et al. 2014, "Hero wavelength
// spectral sampling").
class CollisionSampling {
 public:
  CollisionSampling(Color extinction, Color shares) : extinction_(extinction), shares_(shares) {}

  // Infinite where the picked channel meets nothing.
  [[nodiscard]] float sample(float choice, float u) const {
    const float extinction = extinction_[pick_channel(shares_, choice)];
    return extinction > 0 ? -std::log1p(-u) / extinction : infinity;
  }
  [[nodiscard]] float pdf(float distance) const {
    return sum(shares_ * extinction_ * transmittance(extinction_, distance));
  }
  // That it is at least so far.
  [[nodiscard]] float pass_probability(float distance) const {
    return sum(shares_ * transmittance(extinction_, distance));
  }

 private:
  [[nodiscard]] static float sum(Color c) { return c.x + c.y + c.z; }
  Color extinction_, shares_;
};

// The same within the segment: there always is a distance. No channel with a share may have no extinction.
class TruncatedCollisionSampling {
 public:
  TruncatedCollisionSampling(Color extinction, Color shares, float length)
      : extinction_(extinction),
        shares_(shares),
        length_(length),
        mass_(extinction * integrated_transmittance(extinction, length)) {}

  [[nodiscard]] float sample(float choice, float u) const {
    const std::size_t channel = pick_channel(shares_, choice);
    return std::min(-std::log1p(-u * mass_[channel]) / extinction_[channel], length_);
  }
  [[nodiscard]] float pdf(float distance) const {
    float sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (shares_[i] > 0) sum += shares_[i] * extinction_[i] * transmittance(extinction_[i], distance) / mass_[i];
    return sum;
  }

 private:
  Color extinction_, shares_;
  float length_;
  Color mass_;  // of each channel's distribution, within the segment
};

// Distances at which equal angles are seen from a light: Kulla and Fajardo 2012, "Importance Sampling Techniques for Path
// Tracing in Participating Media".
class EquiangularSampling {
 public:
  // `offset` is from the segment's start to the light's middle. What has a radius is never seen from nearer than that: so
  // near a light of some size nothing grows beyond bounds. Nothing where a light without size is on the segment's line.
  [[nodiscard]] static std::optional<EquiangularSampling> make(Vec3f offset, float radius, Vec3f direction,
                                                               float length) {
    EquiangularSampling sampling;
    sampling.nearest_ = dot(offset, direction);
    sampling.height_ = std::hypot(basicrt::length(offset - direction * sampling.nearest_), radius);
    if (!(sampling.height_ > 1e-6f * basicrt::length(offset))) return std::nullopt;
    sampling.first_angle_ = std::atan(-sampling.nearest_ / sampling.height_);
    sampling.angle_ = std::atan((length - sampling.nearest_) / sampling.height_) - sampling.first_angle_;
    sampling.length_ = length;
    return sampling.angle_ > 1e-6f ? std::optional(sampling) : std::nullopt;
  }

  [[nodiscard]] float sample(float u) const {
    const float distance = nearest_ + height_ * std::tan(first_angle_ + u * angle_);
    return std::clamp(distance, 0.0f, length_);
  }
  [[nodiscard]] float pdf(float distance) const {
    const float along = distance - nearest_;
    return height_ / (angle_ * (height_ * height_ + along * along));
  }

 private:
  float nearest_, height_;  // where the line passes the light, and how far away
  float first_angle_, angle_, length_;
};

}  // namespace basicrt
