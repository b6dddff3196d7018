// SPDX-License-Identifier: GPL-3.0-or-later
// Looks up a luminaire's table of angles.
#include "shading/ies_operation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "math/constants.h"
#include "shading/evaluator.h"

namespace basicrt {
namespace {

constexpr float slack = 1e-6f;  // radians: angles that were meant to be 0, or a whole turn

// Between the entries `index` and `index` + 1.
struct Slot {
  std::size_t index;
  float share;
};

// Nothing outside [first, last).
std::optional<Slot> find_slot(const std::vector<float>& angles, float angle) {
  if (!(angle >= angles.front() && angle < angles.back())) return std::nullopt;
  const auto above = std::ranges::upper_bound(angles, angle);
  const auto index = static_cast<std::size_t>(above - angles.begin()) - 1;
  return Slot{index, (angle - angles[index]) / (angles[index + 1] - angles[index])};
}

// Through b (at 0) and c (at 1), with the slopes of their neighbours (Catmull and Rom 1974, "A class of local interpolating
// splines").
float spline(float a, float b, float c, float d, float t) {
  const float slope_b = (c - a) / 2, slope_c = (d - b) / 2;
  const float bend = slope_b + slope_c - 2 * (c - b);
  return b + t * (slope_b + t * ((c - b) - slope_b - bend + t * bend));
}

// Along one half circle. At a pole it goes on as it came, as if the other side were the same.
float along_meridian(const IesOperation& node, std::size_t meridian, const Slot& slot) {
  const std::size_t count = node.vertical.size(), i = slot.index;
  const auto value = [&](std::size_t vertical) { return node.values[meridian * count + vertical]; };
  const bool has_bottom = node.vertical.front()<slack, has_top = node.vertical.back()> pi - slack;
  const float b = value(i), c = value(i + 1);
  const float a = i > 0 ? value(i - 1) : has_bottom ? value(1) : b;
  const float d = i + 2 < count ? value(i + 2) : has_top ? value(count - 2) : c;
  return spline(a, b, c, d, slot.share);
}

float look_up(const IesOperation& node, float horizontal, float vertical) {
  const std::optional<Slot> across = find_slot(node.horizontal, horizontal), up = find_slot(node.vertical, vertical);
  if (!across || !up) return 0;
  const std::size_t count = node.horizontal.size(), i = across->index;
  const auto at = [&](std::size_t meridian) { return along_meridian(node, meridian, *up); };
  const bool is_closed = node.horizontal.front() < slack && node.horizontal.back() > 2 * pi - slack;
  const float b = at(i), c = at(i + 1);
  const float a = i > 0 ? at(i - 1) : is_closed ? at(count - 2) : b;
  // Blender's choice where there is nothing beyond c. It means to close circles, too, but for rounding never does.
  const float d = i + 2 < count ? at(i + 2) : is_closed ? at(1) : b;
  return std::max(spline(a, b, c, d, across->share), 0.0f);
}

}  // namespace

Vec3f eval(const IesOperation& node, const Evaluator& in) {
  const Vec3f direction = in(node.vector);
  const float size = length(direction);
  const float down = size > 0 ? std::clamp(-direction.z / size, -1.0f, 1.0f) : 0;
  const float turn = std::atan2(direction.x, direction.y) + pi;
  const float horizontal = turn < 2 * pi ? turn : 0;  // the same direction
  return Vec3f(in(node.strength) * look_up(node, horizontal, std::acos(down)));
}

}  // namespace basicrt
