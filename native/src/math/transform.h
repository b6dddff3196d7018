// SPDX-License-Identifier: GPL-3.0-or-later
// Affine transforms: a 3x4 matrix, rows first, that takes columns of points.
#pragma once

#include <array>

#include "math/bounds.h"
#include "math/vec.h"

namespace basicrt {

template <class T>
struct Affine {
  // rows[i] = {m_i0, m_i1, m_i2, translation_i}
  std::array<std::array<T, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  constexpr Affine() = default;
  constexpr explicit Affine(const std::array<std::array<T, 4>, 3>& m) : rows(m) {}
  template <class U>
  constexpr explicit Affine(const Affine<U>& other) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j) rows[i][j] = static_cast<T>(other.rows[i][j]);
  }

  constexpr bool operator==(const Affine&) const = default;
  [[nodiscard]] constexpr Vec3<T> column(int j) const { return {rows[0][j], rows[1][j], rows[2][j]}; }

  template <class U>
  [[nodiscard]] constexpr Vec3<U> point(Vec3<U> p) const {
    return vector(p) + Vec3<U>(column(3));
  }
  template <class U>
  [[nodiscard]] constexpr Vec3<U> vector(Vec3<U> v) const {
    return {U(rows[0][0]) * v.x + U(rows[0][1]) * v.y + U(rows[0][2]) * v.z,
            U(rows[1][0]) * v.x + U(rows[1][1]) * v.y + U(rows[1][2]) * v.z,
            U(rows[2][0]) * v.x + U(rows[2][1]) * v.y + U(rows[2][2]) * v.z};
  }
  // By the transpose of the linear part: with the inverse transform this takes normals (not of unit length any more).
  template <class U>
  [[nodiscard]] constexpr Vec3<U> transposed_vector(Vec3<U> v) const {
    return {U(rows[0][0]) * v.x + U(rows[1][0]) * v.y + U(rows[2][0]) * v.z,
            U(rows[0][1]) * v.x + U(rows[1][1]) * v.y + U(rows[2][1]) * v.z,
            U(rows[0][2]) * v.x + U(rows[1][2]) * v.y + U(rows[2][2]) * v.z};
  }
  [[nodiscard]] constexpr T determinant() const { return dot(column(0), cross(column(1), column(2))); }
};

using Transform = Affine<float>;
using TransformD = Affine<double>;

template <class T>
constexpr Affine<T> operator*(const Affine<T>& a, const Affine<T>& b) {
  Affine<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      c.rows[i][j] = a.rows[i][0] * b.rows[0][j] + a.rows[i][1] * b.rows[1][j] + a.rows[i][2] * b.rows[2][j] +
                     (j == 3 ? a.rows[i][3] : T(0));
  return c;
}

// Needs a determinant that is not zero: validate() asks for that.
template <class T>
constexpr Affine<T> inverse(const Affine<T>& m) {
  const Vec3<T> a = m.column(0), b = m.column(1), c = m.column(2), t = m.column(3);
  const T scale = T(1) / m.determinant();
  const Vec3<T> r0 = cross(b, c) * scale, r1 = cross(c, a) * scale, r2 = cross(a, b) * scale;
  return Affine<T>(
      {{{r0.x, r0.y, r0.z, -dot(r0, t)}, {r1.x, r1.y, r1.z, -dot(r1, t)}, {r2.x, r2.y, r2.z, -dot(r2, t)}}});
}

// The box of a transformed box.
template <class T>
constexpr Bounds3<T> transform_bounds(const Affine<T>& m, const Bounds3<T>& box) {
  Bounds3<T> result;
  if (box.is_empty()) return result;
  for (int corner = 0; corner < 8; ++corner)
    result.extend(m.point(Vec3<T>((corner & 1) ? box.upper.x : box.lower.x, (corner & 2) ? box.upper.y : box.lower.y,
                                  (corner & 4) ? box.upper.z : box.lower.z)));
  return result;
}

template <class T, class Visitor>
constexpr void for_each_number(const Affine<T>& m, Visitor&& visit) {
  for (const auto& row : m.rows)
    for (const T number : row) visit(number);
}

}  // namespace basicrt
