// SPDX-License-Identifier: GPL-3.0-or-later
// Four floats and two doubles at a time: SSE2, which every x86-64 has, or plain C++. Both give the same numbers.
#pragma once

#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace basicrt {

#if defined(__SSE2__)

struct Float4 {
  __m128 lanes;

  static Float4 load(const float* aligned) { return {_mm_load_ps(aligned)}; }
  static Float4 all(float x) { return {_mm_set1_ps(x)}; }
  void store(float* aligned) const { _mm_store_ps(aligned, lanes); }
  friend Float4 operator+(Float4 a, Float4 b) { return {_mm_add_ps(a.lanes, b.lanes)}; }
  friend Float4 operator-(Float4 a, Float4 b) { return {_mm_sub_ps(a.lanes, b.lanes)}; }
  friend Float4 operator*(Float4 a, Float4 b) { return {_mm_mul_ps(a.lanes, b.lanes)}; }
  // a where one is greater (less), else b: so a NaN in `a` gives b.
  friend Float4 max(Float4 a, Float4 b) { return {_mm_max_ps(a.lanes, b.lanes)}; }
  friend Float4 min(Float4 a, Float4 b) { return {_mm_min_ps(a.lanes, b.lanes)}; }
  friend Float4 abs(Float4 a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.lanes)}; }
  // Bit i is set where a[i] <= b[i].
  friend int less_equal_bits(Float4 a, Float4 b) { return _mm_movemask_ps(_mm_cmple_ps(a.lanes, b.lanes)); }
};

struct Double2 {
  __m128d lanes;

  static Double2 from_floats(const float* pair) {
    return {_mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(pair))))};
  }
  static Double2 all(double x) { return {_mm_set1_pd(x)}; }
  void store(double* aligned) const { _mm_store_pd(aligned, lanes); }
  friend Double2 operator+(Double2 a, Double2 b) { return {_mm_add_pd(a.lanes, b.lanes)}; }
  friend Double2 operator-(Double2 a, Double2 b) { return {_mm_sub_pd(a.lanes, b.lanes)}; }
  friend Double2 operator*(Double2 a, Double2 b) { return {_mm_mul_pd(a.lanes, b.lanes)}; }
  friend Double2 operator/(Double2 a, Double2 b) { return {_mm_div_pd(a.lanes, b.lanes)}; }
  friend int less_equal_bits(Double2 a, Double2 b) { return _mm_movemask_pd(_mm_cmple_pd(a.lanes, b.lanes)); }
};

#else

struct Float4 {
  float lanes[4];

  static Float4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
  static Float4 all(float x) { return {{x, x, x, x}}; }
  void store(float* p) const {
    for (int i = 0; i < 4; ++i) p[i] = lanes[i];
  }
  template <class Operation>
  static Float4 each(Float4 a, Float4 b, Operation operation) {
    for (int i = 0; i < 4; ++i) a.lanes[i] = operation(a.lanes[i], b.lanes[i]);
    return a;
  }
  friend Float4 operator+(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x + y; });
  }
  friend Float4 operator-(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x - y; });
  }
  friend Float4 operator*(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x * y; });
  }
  friend Float4 max(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x > y ? x : y; });
  }
  friend Float4 min(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x < y ? x : y; });
  }
  friend Float4 abs(Float4 a) {
    return each(a, a, [](float x, float) { return std::fabs(x); });
  }
  friend int less_equal_bits(Float4 a, Float4 b) {
    int bits = 0;
    for (int i = 0; i < 4; ++i) bits |= (a.lanes[i] <= b.lanes[i]) << i;
    return bits;
  }
};

struct Double2 {
  double lanes[2];

  static Double2 from_floats(const float* pair) { return {{pair[0], pair[1]}}; }
  static Double2 all(double x) { return {{x, x}}; }
  void store(double* p) const { p[0] = lanes[0], p[1] = lanes[1]; }
  friend Double2 operator+(Double2 a, Double2 b) { return {{a.lanes[0] + b.lanes[0], a.lanes[1] + b.lanes[1]}}; }
  friend Double2 operator-(Double2 a, Double2 b) { return {{a.lanes[0] - b.lanes[0], a.lanes[1] - b.lanes[1]}}; }
  friend Double2 operator*(Double2 a, Double2 b) { return {{a.lanes[0] * b.lanes[0], a.lanes[1] * b.lanes[1]}}; }
  friend Double2 operator/(Double2 a, Double2 b) { return {{a.lanes[0] / b.lanes[0], a.lanes[1] / b.lanes[1]}}; }
  friend int less_equal_bits(Double2 a, Double2 b) {
    return (a.lanes[0] <= b.lanes[0]) | (a.lanes[1] <= b.lanes[1]) << 1;
  }
};

#endif

}  // namespace basicrt
