// SPDX-License-Identifier: GPL-3.0-or-later
// Colours mixed, looked up and changed as in Blender's nodes.
#include "shading/color_operations.h"

#include <algorithm>
#include <cmath>

#include "shading/evaluator.h"

namespace basicrt {
namespace {

float unit(float x) { return std::clamp(x, 0.0f, 1.0f); }

Vec3f each(auto&& function, auto... vectors) {
  return {function(vectors.x...), function(vectors.y...), function(vectors.z...)};
}

// Hue in [0, 1) from the largest and the smallest channel; Smith 1978, "Color gamut transform pairs".
float hue_of(Color c, float largest, float range) {
  if (range == 0) return 0;
  const Vec3f distance = (Vec3f(largest) - c) / range;
  const float sector = c.x == largest   ? distance.z - distance.y
                       : c.y == largest ? 2 + distance.x - distance.z
                                        : 4 + distance.y - distance.x;
  const float hue = sector / 6;
  return hue < 0 ? hue + 1 : hue;
}

Vec3f to_hsv(Color c) {
  const float largest = max_component(c), range = largest - min_component(c);
  const float saturation = largest != 0 ? range / largest : 0;
  return {saturation != 0 ? hue_of(c, largest, range) : 0, saturation, largest};
}

// The fully saturated colour of a hue.
Color pure_hue(float hue) {
  return each(unit, Vec3f{std::abs(hue * 6 - 3) - 1, 2 - std::abs(hue * 6 - 2), 2 - std::abs(hue * 6 - 4)});
}

// Blender counts hues beyond [0, 1] as of the last sector.
Color from_hsv(Vec3f hsv) {
  const float value = hsv.z, saturation = hsv.y, turns = hsv.x == 1 ? 0 : hsv.x * 6;
  if (saturation == 0) return Color(value);
  const float sector = std::floor(turns), along = turns - sector;
  const float low = value * (1 - saturation), falling = value * (1 - saturation * along),
              rising = value * (1 - saturation * (1 - along));
  if (sector == 0) return {value, rising, low};
  if (sector == 1) return {falling, value, low};
  if (sector == 2) return {low, value, rising};
  if (sector == 3) return {low, falling, value};
  if (sector == 4) return {rising, low, value};
  return {value, low, falling};
}

Vec3f to_hsl(Color c) {
  const float largest = max_component(c), smallest = min_component(c), range = largest - smallest;
  const float lightness = std::min((largest + smallest) / 2, 1.0f);
  if (range == 0) return {0, 0, lightness};
  const float saturation = lightness > 0.5f ? range / (2 - largest - smallest) : range / (largest + smallest);
  return {hue_of(c, largest, range), saturation, lightness};
}

Color from_hsl(Vec3f hsl) {
  const float chroma = (1 - std::abs(2 * hsl.z - 1)) * hsl.y;
  return (pure_hue(hsl.x) - Vec3f(0.5f)) * chroma + Vec3f(hsl.z);
}

float burn(float t, float a, float b) {
  const float divisor = 1 - t + t * b;
  return divisor <= 0 ? 0 : unit(1 - (1 - a) / divisor);
}

float dodge(float t, float a, float b) {
  if (a == 0) return a;
  const float divisor = 1 - t * b;
  return divisor <= 0 ? 1 : std::min(a / divisor, 1.0f);
}

float overlay(float t, float a, float b) {
  return a < 0.5f ? a * (1 - t + 2 * t * b) : 1 - (1 - t + 2 * t * (1 - b)) * (1 - a);
}

float soft_light(float t, float a, float b) {
  const float screen = 1 - (1 - b) * (1 - a);
  return (1 - t) * a + t * ((1 - a) * b * a + a * screen);
}

// Takes hue, saturation or both of one colour to another.
Color blend_hsv(BlendKind kind, float t, Color a, Color b) {
  Vec3f hsv_a = to_hsv(a);
  const Vec3f hsv_b = to_hsv(b);
  switch (kind) {
    case BlendKind::hue:
    case BlendKind::color:
      if (hsv_b.y == 0) return a;
      hsv_a.x = hsv_b.x;
      if (kind == BlendKind::color) hsv_a.y = hsv_b.y;
      return lerp(a, from_hsv(hsv_a), t);
    case BlendKind::saturation:
      if (hsv_a.y == 0) return a;
      hsv_a.y = lerp(hsv_a.y, hsv_b.y, t);
      return from_hsv(hsv_a);
    default:
      hsv_a.z = lerp(hsv_a.z, hsv_b.z, t);
      return from_hsv(hsv_a);
  }
}

Color blend(BlendKind kind, float t, Color a, Color b) {
  const auto channels = [&](auto&& function) {
    return each([&](float x, float y) { return function(t, x, y); }, a, b);
  };
  switch (kind) {
    case BlendKind::mix:
      return lerp(a, b, t);
    case BlendKind::darken:
      return lerp(a, min(a, b), t);
    case BlendKind::multiply:
      return lerp(a, a * b, t);
    case BlendKind::burn:
      return channels(burn);
    case BlendKind::lighten:
      return lerp(a, max(a, b), t);
    case BlendKind::screen:
      return Color(1.0f) - (Color(1 - t) + (Color(1.0f) - b) * t) * (Color(1.0f) - a);
    case BlendKind::dodge:
      return channels(dodge);
    case BlendKind::add:
      return a + b * t;
    case BlendKind::overlay:
      return channels(overlay);
    case BlendKind::soft_light:
      return channels(soft_light);
    case BlendKind::linear_light:
      return a + (b * 2 - Color(1.0f)) * t;
    case BlendKind::difference:
      return lerp(a, abs(a - b), t);
    case BlendKind::exclusion:
      return max(lerp(a, a + b - a * b * 2, t), Color(0.0f));
    case BlendKind::subtract:
      return a - b * t;
    case BlendKind::divide:
      return channels([](float s, float x, float y) { return y != 0 ? (1 - s) * x + s * x / y : x; });
    default:
      return blend_hsv(kind, t, a, b);
  }
}

// One channel of the table's entries.
float look_up(const TableOperation& node, float value, std::size_t channel) {
  const std::size_t count = node.colors.size() / 3;
  const auto entry = [&](std::size_t i) { return node.colors[i * 3 + channel]; };
  const float last = static_cast<float>(count - 1),
              place = (value - node.minimum) / (node.maximum - node.minimum) * last;
  if (count > 1 && node.is_extrapolated && place < 0) return entry(0) + (entry(1) - entry(0)) * place;
  if (count > 1 && node.is_extrapolated && place > last)
    return entry(count - 1) + (entry(count - 1) - entry(count - 2)) * (place - last);
  const float inside = place > 0 ? std::min(place, last) : 0;  // NaN is at the beginning
  const auto index = static_cast<std::size_t>(inside);
  const float fraction = inside - static_cast<float>(index);
  if (!node.is_interpolated || fraction == 0) return entry(index);
  return lerp(entry(index), entry(index + 1), fraction);
}

}  // namespace

Vec3f eval(const MixOperation& node, const Evaluator& in) {
  Vec3f t = in(node.factor);
  if (node.is_factor_clamped) t = each(unit, t);
  const Vec3f a = in(node.a), b = in(node.b);
  const bool is_uniform = t.x == t.y && t.x == t.z;
  const Vec3f result =
      node.blend != BlendKind::mix || is_uniform ? blend(node.blend, t.x, a, b) : a * (Vec3f(1.0f) - t) + b * t;
  return node.is_result_clamped ? each(unit, result) : result;
}

Vec3f eval(const TableOperation& node, const Evaluator& in) {
  const Vec3f value = in(node.value);
  const Vec3f found{look_up(node, value.x, 0), look_up(node, value.y, 1), look_up(node, value.z, 2)};
  const float factor = in(node.factor);
  return factor == 1 ? found : lerp(value, found, factor);
}

Vec3f eval(const ConvertColorOperation& node, const Evaluator& in) {
  Vec3f color = in(node.color);
  if (node.source == node.target) return color;
  if (node.source == ColorModel::hsv) color = from_hsv(color);
  if (node.source == ColorModel::hsl) color = from_hsl(color);
  if (node.target == ColorModel::hsv) return to_hsv(color);
  return node.target == ColorModel::hsl ? to_hsl(color) : color;
}

Vec3f eval(const HueSaturationOperation& node, const Evaluator& in) {
  const Color color = in(node.color);
  Vec3f hsv = to_hsv(color);
  hsv.x += in(node.hue) + 0.5f;
  hsv.x -= std::floor(hsv.x);
  hsv.y = unit(hsv.y * in(node.saturation));
  hsv.z *= in(node.value);
  return max(lerp(color, from_hsv(hsv), in(node.factor)), Color(0.0f));
}

Vec3f eval(const ToneOperation& node, const Evaluator& in) {
  const Color color = in(node.color);
  const float a = in(node.a), b = in(node.b);
  switch (node.change) {
    case ToneKind::gamma:
      if (a == 0) return Color(1.0f);
      return each([&](float x) { return x > 0 ? std::pow(x, a) : x; }, color);
    case ToneKind::bright_contrast:
      return each([&](float x) { return std::max((1 + b) * x + a - b * 0.5f, 0.0f); }, color);
    case ToneKind::invert:
      return each([&](float x) { return lerp(x, 1 - x, a); }, color);
  }
  return color;
}

}  // namespace basicrt
