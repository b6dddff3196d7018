// SPDX-License-Identifier: GPL-3.0-or-later
// Four floats and two doubles at a time: SSE2, which every x86-64 has, or plain C++. Both give the same numbers.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace basicrt {

#if defined(__SSE2__)

struct Mask4 {
  __m128 lanes;  // all ones or all zeros

  friend Mask4 operator&(Mask4 a, Mask4 b) { return {_mm_and_ps(a.lanes, b.lanes)}; }
  friend Mask4 operator|(Mask4 a, Mask4 b) { return {_mm_or_ps(a.lanes, b.lanes)}; }
  [[nodiscard]] int bits() const { return _mm_movemask_ps(lanes); }  // bit i for lane i
};

struct Int4 {
  __m128i lanes;

  static Int4 all(int x) { return {_mm_set1_epi32(x)}; }
  static Int4 load(const std::int32_t* aligned) { return {_mm_load_si128(reinterpret_cast<const __m128i*>(aligned))}; }
  void store(std::int32_t* aligned) const { _mm_store_si128(reinterpret_cast<__m128i*>(aligned), lanes); }
  [[nodiscard]] std::array<std::uint32_t, 3> first_three() const {
    const auto two = static_cast<std::uint64_t>(_mm_cvtsi128_si64(lanes));
    const auto third = static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_unpackhi_epi32(lanes, lanes)));
    return {static_cast<std::uint32_t>(two), static_cast<std::uint32_t>(two >> 32), third};
  }
  friend Int4 operator+(Int4 a, Int4 b) { return {_mm_add_epi32(a.lanes, b.lanes)}; }
  template <int bits>
  [[nodiscard]] Int4 shifted_right() const {  // rounds down
    return {_mm_srai_epi32(lanes, bits)};
  }
};

struct Float4 {
  __m128 lanes;

  static Float4 load(const float* aligned) { return {_mm_load_ps(aligned)}; }
  static Float4 all(float x) { return {_mm_set1_ps(x)}; }
  static Float4 of(float x, float y, float z, float w) { return {_mm_setr_ps(x, y, z, w)}; }
  static Float4 from(Int4 a) { return {_mm_cvtepi32_ps(a.lanes)}; }
  void store(float* aligned) const { _mm_store_ps(aligned, lanes); }
  [[nodiscard]] Int4 truncated() const { return {_mm_cvttps_epi32(lanes)}; }  // of numbers that an int holds
  friend Float4 operator+(Float4 a, Float4 b) { return {_mm_add_ps(a.lanes, b.lanes)}; }
  friend Float4 operator-(Float4 a, Float4 b) { return {_mm_sub_ps(a.lanes, b.lanes)}; }
  friend Float4 operator/(Float4 a, Float4 b) { return {_mm_div_ps(a.lanes, b.lanes)}; }
  friend Float4 operator*(Float4 a, Float4 b) { return {_mm_mul_ps(a.lanes, b.lanes)}; }
  // a where one is greater (less), else b: so a NaN in `a` gives b.
  friend Float4 max(Float4 a, Float4 b) { return {_mm_max_ps(a.lanes, b.lanes)}; }
  friend Float4 min(Float4 a, Float4 b) { return {_mm_min_ps(a.lanes, b.lanes)}; }
  friend Float4 abs(Float4 a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.lanes)}; }
  friend Float4 sqrt(Float4 a) { return {_mm_sqrt_ps(a.lanes)}; }
  friend Float4 copysign(Float4 magnitude, Float4 sign) {
    const __m128 sign_bit = _mm_set1_ps(-0.0f);
    return {_mm_or_ps(_mm_andnot_ps(sign_bit, magnitude.lanes), _mm_and_ps(sign_bit, sign.lanes))};
  }
  friend Float4 select(Mask4 mask, Float4 where_set, Float4 elsewhere) {
    return {_mm_or_ps(_mm_and_ps(mask.lanes, where_set.lanes), _mm_andnot_ps(mask.lanes, elsewhere.lanes))};
  }
  friend Mask4 operator<(Float4 a, Float4 b) { return {_mm_cmplt_ps(a.lanes, b.lanes)}; }
  friend Mask4 operator<=(Float4 a, Float4 b) { return {_mm_cmple_ps(a.lanes, b.lanes)}; }
  friend Mask4 operator==(Float4 a, Float4 b) { return {_mm_cmpeq_ps(a.lanes, b.lanes)}; }
  [[nodiscard]] int sign_bits() const { return _mm_movemask_ps(lanes); }  // bit i where lane i is negative, or -0
  template <int lane>
  [[nodiscard]] Float4 broadcast() const {
    return {_mm_shuffle_ps(lanes, lanes, _MM_SHUFFLE(lane, lane, lane, lane))};
  }
  // Lane i of the three becomes lanes 0 to 2 of the i-th.
  friend void transpose(Float4& a, Float4& b, Float4& c) {
    const __m128 ab = _mm_unpacklo_ps(a.lanes, b.lanes), ab_z = _mm_unpackhi_ps(a.lanes, b.lanes);
    const __m128 cc = _mm_unpacklo_ps(c.lanes, c.lanes), cc_z = _mm_unpackhi_ps(c.lanes, c.lanes);
    a.lanes = _mm_movelh_ps(ab, cc);
    b.lanes = _mm_movehl_ps(cc, ab);
    c.lanes = _mm_movelh_ps(ab_z, cc_z);
  }
};

struct Mask2 {
  __m128d lanes;  // all ones or all zeros

  friend Mask2 operator&(Mask2 a, Mask2 b) { return {_mm_and_pd(a.lanes, b.lanes)}; }
  [[nodiscard]] int bits() const { return _mm_movemask_pd(lanes); }  // bit i for lane i
};

struct Double2 {
  __m128d lanes;

  static Double2 from_floats(const float* pair) {
    return {_mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(pair))))};
  }
  static Double2 all(double x) { return {_mm_set1_pd(x)}; }
  static Double2 of(double x, double y) { return {_mm_setr_pd(x, y)}; }
  [[nodiscard]] double first() const { return _mm_cvtsd_f64(lanes); }
  [[nodiscard]] double second() const { return _mm_cvtsd_f64(_mm_unpackhi_pd(lanes, lanes)); }
  [[nodiscard]] Double2 swapped() const { return {_mm_shuffle_pd(lanes, lanes, 1)}; }
  friend Double2 abs(Double2 a) { return {_mm_andnot_pd(_mm_set1_pd(-0.0), a.lanes)}; }
  void store(double* aligned) const { _mm_store_pd(aligned, lanes); }
  friend Double2 operator+(Double2 a, Double2 b) { return {_mm_add_pd(a.lanes, b.lanes)}; }
  friend Double2 operator-(Double2 a, Double2 b) { return {_mm_sub_pd(a.lanes, b.lanes)}; }
  friend Double2 operator*(Double2 a, Double2 b) { return {_mm_mul_pd(a.lanes, b.lanes)}; }
  friend Double2 operator/(Double2 a, Double2 b) { return {_mm_div_pd(a.lanes, b.lanes)}; }
  friend Mask2 operator<=(Double2 a, Double2 b) { return {_mm_cmple_pd(a.lanes, b.lanes)}; }
};

#else

struct Mask4 {
  int set;  // bit i for lane i

  friend Mask4 operator&(Mask4 a, Mask4 b) { return {a.set & b.set}; }
  friend Mask4 operator|(Mask4 a, Mask4 b) { return {a.set | b.set}; }
  [[nodiscard]] int bits() const { return set; }
};

struct alignas(16) Int4 {
  std::int32_t lanes[4];

  static Int4 all(int x) { return {{x, x, x, x}}; }
  static Int4 load(const std::int32_t* p) { return {{p[0], p[1], p[2], p[3]}}; }
  void store(std::int32_t* p) const {
    for (int i = 0; i < 4; ++i) p[i] = lanes[i];
  }
  [[nodiscard]] std::array<std::uint32_t, 3> first_three() const {
    return {static_cast<std::uint32_t>(lanes[0]), static_cast<std::uint32_t>(lanes[1]),
            static_cast<std::uint32_t>(lanes[2])};
  }
  friend Int4 operator+(Int4 a, Int4 b) {
    for (int i = 0; i < 4; ++i) a.lanes[i] += b.lanes[i];
    return a;
  }
  template <int bits>
  [[nodiscard]] Int4 shifted_right() const {  // rounds down
    return {{lanes[0] >> bits, lanes[1] >> bits, lanes[2] >> bits, lanes[3] >> bits}};
  }
};

struct alignas(16) Float4 {
  float lanes[4];

  static Float4 load(const float* p) { return {{p[0], p[1], p[2], p[3]}}; }
  static Float4 all(float x) { return {{x, x, x, x}}; }
  static Float4 of(float x, float y, float z, float w) { return {{x, y, z, w}}; }
  static Float4 from(Int4 a) {
    return {{static_cast<float>(a.lanes[0]), static_cast<float>(a.lanes[1]), static_cast<float>(a.lanes[2]),
             static_cast<float>(a.lanes[3])}};
  }
  void store(float* p) const {
    for (int i = 0; i < 4; ++i) p[i] = lanes[i];
  }
  [[nodiscard]] Int4 truncated() const {  // of numbers that an int holds
    return {{static_cast<std::int32_t>(lanes[0]), static_cast<std::int32_t>(lanes[1]),
             static_cast<std::int32_t>(lanes[2]), static_cast<std::int32_t>(lanes[3])}};
  }
  template <class Operation>
  static Float4 each(Float4 a, Float4 b, Operation operation) {
    for (int i = 0; i < 4; ++i) a.lanes[i] = operation(a.lanes[i], b.lanes[i]);
    return a;
  }
  template <class Condition>
  static Mask4 where(Float4 a, Float4 b, Condition condition) {
    int bits = 0;
    for (int i = 0; i < 4; ++i) bits |= condition(a.lanes[i], b.lanes[i]) << i;
    return {bits};
  }
  friend Float4 operator+(Float4 a, Float4 b) { return each(a, b, std::plus<float>()); }
  friend Float4 operator-(Float4 a, Float4 b) { return each(a, b, std::minus<float>()); }
  friend Float4 operator*(Float4 a, Float4 b) { return each(a, b, std::multiplies<float>()); }
  friend Float4 operator/(Float4 a, Float4 b) { return each(a, b, std::divides<float>()); }
  friend Float4 max(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x > y ? x : y; });
  }
  friend Float4 min(Float4 a, Float4 b) {
    return each(a, b, [](float x, float y) { return x < y ? x : y; });
  }
  friend Float4 abs(Float4 a) {
    return each(a, a, [](float x, float) { return std::fabs(x); });
  }
  friend Float4 sqrt(Float4 a) {
    return each(a, a, [](float x, float) { return std::sqrt(x); });
  }
  friend Float4 copysign(Float4 magnitude, Float4 sign) {
    return each(magnitude, sign, [](float x, float y) { return std::copysign(x, y); });
  }
  friend Float4 select(Mask4 mask, Float4 where_set, Float4 elsewhere) {
    for (int i = 0; i < 4; ++i)
      if (mask.set >> i & 1) elsewhere.lanes[i] = where_set.lanes[i];
    return elsewhere;
  }
  friend Mask4 operator<(Float4 a, Float4 b) { return where(a, b, std::less<float>()); }
  friend Mask4 operator<=(Float4 a, Float4 b) { return where(a, b, std::less_equal<float>()); }
  friend Mask4 operator==(Float4 a, Float4 b) { return where(a, b, std::equal_to<float>()); }
  [[nodiscard]] int sign_bits() const {
    return where(*this, *this, [](float x, float) { return std::signbit(x); }).set;
  }
  template <int lane>
  [[nodiscard]] Float4 broadcast() const {
    return all(lanes[lane]);
  }
  // Lane i of the three becomes lanes 0 to 2 of the i-th.
  friend void transpose(Float4& a, Float4& b, Float4& c) {
    std::swap(a.lanes[1], b.lanes[0]);
    std::swap(a.lanes[2], c.lanes[0]);
    std::swap(b.lanes[2], c.lanes[1]);
  }
};

struct Mask2 {
  int set;  // bit i for lane i

  friend Mask2 operator&(Mask2 a, Mask2 b) { return {a.set & b.set}; }
  [[nodiscard]] int bits() const { return set; }
};

struct Double2 {
  double lanes[2];

  static Double2 from_floats(const float* pair) { return {{pair[0], pair[1]}}; }
  static Double2 all(double x) { return {{x, x}}; }
  static Double2 of(double x, double y) { return {{x, y}}; }
  [[nodiscard]] double first() const { return lanes[0]; }
  [[nodiscard]] double second() const { return lanes[1]; }
  [[nodiscard]] Double2 swapped() const { return {{lanes[1], lanes[0]}}; }
  friend Double2 abs(Double2 a) { return {{std::fabs(a.lanes[0]), std::fabs(a.lanes[1])}}; }
  void store(double* p) const { p[0] = lanes[0], p[1] = lanes[1]; }
  friend Double2 operator+(Double2 a, Double2 b) { return {{a.lanes[0] + b.lanes[0], a.lanes[1] + b.lanes[1]}}; }
  friend Double2 operator-(Double2 a, Double2 b) { return {{a.lanes[0] - b.lanes[0], a.lanes[1] - b.lanes[1]}}; }
  friend Double2 operator*(Double2 a, Double2 b) { return {{a.lanes[0] * b.lanes[0], a.lanes[1] * b.lanes[1]}}; }
  friend Double2 operator/(Double2 a, Double2 b) { return {{a.lanes[0] / b.lanes[0], a.lanes[1] / b.lanes[1]}}; }
  friend Mask2 operator<=(Double2 a, Double2 b) {
    return {(a.lanes[0] <= b.lanes[0]) | (a.lanes[1] <= b.lanes[1]) << 1};
  }
};

#endif

}  // namespace basicrt
