// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic as Blender defines it.
#include "shading/math_operations.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shading/evaluator.h"

namespace basicrt {
namespace {

float divide(float a, float b) { return b != 0 ? a / b : 0; }

// Of a negative number only whole powers exist.
float power(float a, float b) {
  if (b == 0) return 1;
  if (a == 0) return 0;
  if (a < 0 && b != std::trunc(b)) return 0;
  return std::pow(a, b);
}

float logarithm(float a, float base) { return a > 0 && base > 0 ? divide(std::log(a), std::log(base)) : 0; }
float modulo(float a, float b) { return b != 0 ? std::fmod(a, b) : 0; }
float floored_modulo(float a, float b) { return b != 0 ? a - std::floor(a / b) * b : 0; }
float fraction(float a) { return a - std::floor(a); }
float sign(float a) { return static_cast<float>((a > 0) - (a < 0)); }
float snap(float a, float b) { return std::floor(divide(a, b)) * b; }

float wrap(float value, float high, float low) {
  const float range = high - low;
  return range != 0 ? value - range * std::floor((value - low) / range) : low;
}

float pingpong(float a, float scale) {
  return scale != 0 ? std::abs(fraction((a - scale) / (scale * 2)) * scale * 2 - scale) : 0;
}

// Cubic (Quilez, "Smooth minimum").
float smooth_min(float a, float b, float width) {
  if (width == 0) return std::min(a, b);
  const float h = std::max(width - std::abs(a - b), 0.0f) / width;
  return std::min(a, b) - h * h * h * width * (1.0f / 6.0f);
}

float evaluate(MathKind kind, float a, float b, float c) {
  switch (kind) {
    case MathKind::add:
      return a + b;
    case MathKind::subtract:
      return a - b;
    case MathKind::multiply:
      return a * b;
    case MathKind::divide:
      return divide(a, b);
    case MathKind::multiply_add:
      return a * b + c;
    case MathKind::power:
      return power(a, b);
    case MathKind::logarithm:
      return logarithm(a, b);
    case MathKind::sqrt:
      return a > 0 ? std::sqrt(a) : 0;
    case MathKind::inverse_sqrt:
      return a > 0 ? 1 / std::sqrt(a) : 0;
    case MathKind::absolute:
      return std::abs(a);
    case MathKind::exponent:
      return std::exp(a);
    case MathKind::minimum:
      return std::min(a, b);
    case MathKind::maximum:
      return std::max(a, b);
    case MathKind::less_than:
      return a < b;
    case MathKind::greater_than:
      return a > b;
    case MathKind::sign:
      return sign(a);
    case MathKind::compare:
      return a == b || std::abs(a - b) <= std::max(c, 1.1920929e-7f);
    case MathKind::smooth_min:
      return smooth_min(a, b, c);
    case MathKind::smooth_max:
      return -smooth_min(-a, -b, c);
    case MathKind::round:
      return std::floor(a + 0.5f);
    case MathKind::floor:
      return std::floor(a);
    case MathKind::ceil:
      return std::ceil(a);
    case MathKind::trunc:
      return std::trunc(a);
    case MathKind::fraction:
      return fraction(a);
    case MathKind::modulo:
      return modulo(a, b);
    case MathKind::floored_modulo:
      return floored_modulo(a, b);
    case MathKind::wrap:
      return wrap(a, b, c);
    case MathKind::snap:
      return snap(a, b);
    case MathKind::pingpong:
      return pingpong(a, b);
    case MathKind::sine:
      return std::sin(a);
    case MathKind::cosine:
      return std::cos(a);
    case MathKind::tangent:
      return std::tan(a);
    case MathKind::arcsine:
      return std::asin(std::clamp(a, -1.0f, 1.0f));
    case MathKind::arccosine:
      return std::acos(std::clamp(a, -1.0f, 1.0f));
    case MathKind::arctangent:
      return std::atan(a);
    case MathKind::arctan2:
      return std::atan2(a, b);
    case MathKind::sinh:
      return std::sinh(a);
    case MathKind::cosh:
      return std::cosh(a);
    case MathKind::tanh:
      return std::tanh(a);
    case MathKind::radians:
      return a * (std::numbers::pi_v<float> / 180);
    case MathKind::degrees:
      return a * (180 / std::numbers::pi_v<float>);
  }
  return 0;
}

Vec3f each(auto&& function, auto... vectors) {
  return {function(vectors.x...), function(vectors.y...), function(vectors.z...)};
}

Vec3f normalized(Vec3f a) {
  const float size = length(a);
  return size > 0 ? a / size : Vec3f(0.0f);
}

Vec3f refracted(Vec3f direction, Vec3f normal, float eta) {
  const float cosine = dot(normal, direction), k = 1 - eta * eta * (1 - cosine * cosine);
  return k < 0 ? Vec3f(0.0f) : eta * direction - (eta * cosine + std::sqrt(k)) * normal;
}

Vec3f evaluate(VectorMathKind kind, Vec3f a, Vec3f b, Vec3f c, float scale) {
  switch (kind) {
    case VectorMathKind::add:
      return a + b;
    case VectorMathKind::subtract:
      return a - b;
    case VectorMathKind::multiply:
      return a * b;
    case VectorMathKind::divide:
      return each(divide, a, b);
    case VectorMathKind::multiply_add:
      return a * b + c;
    case VectorMathKind::cross_product:
      return cross(a, b);
    case VectorMathKind::project:
      return length_squared(b) != 0 ? b * (dot(a, b) / length_squared(b)) : Vec3f(0.0f);
    case VectorMathKind::reflect: {
      const Vec3f normal = normalized(b);
      return a - normal * (2 * dot(a, normal));
    }
    case VectorMathKind::refract:
      return refracted(a, normalized(b), scale);
    case VectorMathKind::faceforward:
      return dot(c, b) < 0 ? a : -a;
    case VectorMathKind::dot_product:
      return Vec3f(dot(a, b));
    case VectorMathKind::distance:
      return Vec3f(length(a - b));
    case VectorMathKind::length:
      return Vec3f(length(a));
    case VectorMathKind::scale:
      return a * scale;
    case VectorMathKind::normalize:
      return normalized(a);
    case VectorMathKind::absolute:
      return abs(a);
    case VectorMathKind::power:
      return each(power, a, b);
    case VectorMathKind::sign:
      return each(sign, a);
    case VectorMathKind::minimum:
      return min(a, b);
    case VectorMathKind::maximum:
      return max(a, b);
    case VectorMathKind::floor:
      return each([](float x) { return std::floor(x); }, a);
    case VectorMathKind::ceil:
      return each([](float x) { return std::ceil(x); }, a);
    case VectorMathKind::fraction:
      return each(fraction, a);
    case VectorMathKind::modulo:
      return each(modulo, a, b);
    case VectorMathKind::wrap:
      return each(wrap, a, b, c);
    case VectorMathKind::snap:
      return each(snap, a, b);
    case VectorMathKind::sine:
      return each([](float x) { return std::sin(x); }, a);
    case VectorMathKind::cosine:
      return each([](float x) { return std::cos(x); }, a);
    case VectorMathKind::tangent:
      return each([](float x) { return std::tan(x); }, a);
  }
  return {};
}

float unit(float x) { return std::clamp(x, 0.0f, 1.0f); }

struct RangeMap {
  RangeInterpolation interpolation;
  bool is_clamped;

  float operator()(float value, float from_min, float from_max, float to_min, float to_max, float steps) const {
    const float share = (value - from_min) / (from_max - from_min);
    if (interpolation == RangeInterpolation::smoothstep || interpolation == RangeInterpolation::smootherstep) {
      if (from_min == from_max) return to_min;
      const float t = unit(share);
      const bool is_smoother = interpolation == RangeInterpolation::smootherstep;
      const float s = is_smoother ? t * t * t * (t * (t * 6 - 15) + 10) : t * t * (3 - 2 * t);
      return to_min + s * (to_max - to_min);
    }
    if (from_min == from_max) return 0;
    const bool is_stepped = interpolation == RangeInterpolation::stepped;
    const float t = !is_stepped ? share : steps > 0 ? std::floor(share * (steps + 1)) / steps : 0;
    const float result = to_min + t * (to_max - to_min);
    return is_clamped ? std::clamp(result, std::min(to_min, to_max), std::max(to_min, to_max)) : result;
  }
};

}  // namespace

Vec3f eval(const MathOperation& node, const Evaluator& in) {
  const float result = evaluate(node.operation, in(node.a), in(node.b), in(node.c));
  return Vec3f(node.is_clamped ? unit(result) : result);
}

Vec3f eval(const VectorMathOperation& node, const Evaluator& in) {
  return evaluate(node.operation, in(node.a), in(node.b), in(node.c), in(node.scale));
}

Vec3f eval(const MapRangeOperation& node, const Evaluator& in) {
  return each(RangeMap{node.interpolation, node.is_clamped}, in(node.value), in(node.from_min), in(node.from_max),
              in(node.to_min), in(node.to_max), in(node.steps));
}

Vec3f eval(const ComponentOperation& node, const Evaluator& in) {
  const Vec3f value = in(node.value);
  switch (node.component) {
    case Component::average:
      return Vec3f(average(value));
    case Component::luminance:
      return Vec3f(luminance(value));
    default:
      return Vec3f(value[static_cast<std::size_t>(node.component)]);
  }
}

Vec3f eval(const CombineOperation& node, const Evaluator& in) { return {in(node.x), in(node.y), in(node.z)}; }

}  // namespace basicrt
