// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of two and three numbers. Points, directions and colours share them; names tell them apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace basicrt {

template <class T>
struct Vec2 {
  T x{}, y{};

  constexpr Vec2() = default;
  constexpr Vec2(T x_, T y_) : x(x_), y(y_) {}
  template <class U>
  constexpr explicit Vec2(const Vec2<U>& v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)) {}

  constexpr bool operator==(const Vec2&) const = default;
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, Vec2 b) { return {a.x * b.x, a.y * b.y}; }
  friend constexpr Vec2 operator*(Vec2 a, T s) { return {a.x * s, a.y * s}; }
  friend constexpr Vec2 operator*(T s, Vec2 a) { return a * s; }
};

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3() = default;
  constexpr explicit Vec3(T s) : x(s), y(s), z(s) {}
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  template <class U>
  constexpr explicit Vec3(const Vec3<U>& v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

  constexpr T operator[](std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr T& operator[](std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }

  constexpr bool operator==(const Vec3&) const = default;
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend constexpr Vec3 operator/(Vec3 a, Vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  constexpr Vec3& operator*=(Vec3 b) { return *this = *this * b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec2i = Vec2<int>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_squared(Vec3<T> a) {
  return dot(a, a);
}
template <class T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}
// The zero vector gives NaN: callers who may have one ask first.
template <class T>
Vec3<T> normalize(Vec3<T> a) {
  return a * (T(1) / length(a));
}
template <class T>
Vec3<T> abs(Vec3<T> a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
constexpr T min_component(Vec3<T> a) {
  return std::min(a.x, std::min(a.y, a.z));
}
template <class T>
constexpr T max_component(Vec3<T> a) {
  return std::max(a.x, std::max(a.y, a.z));
}
template <class T>
bool is_finite(Vec3<T> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
template <class V, class T>
constexpr V lerp(V a, V b, T t) {
  return a * (T(1) - t) + b * t;
}

// Calls visit(number) for each component: how validate_fields() looks into a described field.
template <class T, class Visitor>
constexpr void for_each_number(Vec2<T> a, Visitor&& visit) {
  visit(a.x), visit(a.y);
}
template <class T, class Visitor>
constexpr void for_each_number(Vec3<T> a, Visitor&& visit) {
  visit(a.x), visit(a.y), visit(a.z);
}

}  // namespace basicrt
