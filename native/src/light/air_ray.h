// SPDX-License-Identifier: GPL-3.0-or-later
// A ray through the air around a round planet: all that counts is how far it is from the planet's centre.
#pragma once

#include <cmath>

namespace basicrt {

struct AirRay {
  double radius;  // of its start, from the planet's centre
  double cosine;  // of its direction with straight up, there

  [[nodiscard]] double radius_at(double distance) const {
    return std::sqrt(radius * radius + distance * (2 * radius * cosine + distance));
  }
  // It points at a sphere around the centre that is no larger than its start's.
  [[nodiscard]] bool meets(double sphere) const { return cosine < 0 && room(sphere) > 0; }
  [[nodiscard]] double distance_into(double sphere) const { return -radius * cosine - std::sqrt(room(sphere)); }
  // Out of a sphere that it starts in.
  [[nodiscard]] double distance_out_of(double sphere) const { return -radius * cosine + std::sqrt(room(sphere)); }

 private:
  // The square of half of the line's length in the sphere.
  [[nodiscard]] double room(double sphere) const { return sphere * sphere - radius * radius * (1 - cosine * cosine); }
};

}  // namespace basicrt
