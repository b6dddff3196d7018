// SPDX-License-Identifier: GPL-3.0-or-later
// A place on a lamp as the lamp's material sees it.
#pragma once

#include "geometry/surface_point.h"
#include "light/lamp.h"

namespace basicrt {

// What is seen of the lamp from `position` along the unit vector `wi`, `distance` away; infinite for a sun. As Blender
// has it:
//
//   - an area lamp has the normal of the side that shines, and its edges run from 0 to 1 in uv;
//   - a ball's normal points away from its middle, a disc's and a point's to whoever looks. uv of a point lamp goes round
//     the object's z axis; that of a spot is the picture that it projects, which just fills the cone;
//   - a sun's place and normal are the direction that its light travels in, and uv fills its disc.
[[nodiscard]] SurfacePoint lamp_point(const Lamp& lamp, Vec3f position, Vec3f wi, float distance, float time);

}  // namespace basicrt
