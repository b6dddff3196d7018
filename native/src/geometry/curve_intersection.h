// SPDX-License-Identifier: GPL-3.0-or-later
// Rays against parts of curves, in double precision.
#pragma once

#include <optional>

#include "geometry/curve_segment.h"
#include "geometry/precise_ray.h"

namespace basicrt {

struct CurveHit {
  double t = 0;  // along the ray
  double u = 0;  // along the segment
  double v = 0;  // across a ribbon, from -1 to 1; 0 on a round curve
};

// The nearest hit in [t_min, t_max] on a part of a segment that hardly bends. Curves are seen from outside only: a ray that
// starts in one leaves it freely. Parts that meet leave no gap. A ribbon is not met nearer than its width, as in Blender: a
// ray that leaves one would meet it again at once.
[[nodiscard]] std::optional<CurveHit> intersect_curve(const PreciseRay& ray, const CurveSegment& segment,
                                                      CurveRange range, CurveForm form);

}  // namespace basicrt
