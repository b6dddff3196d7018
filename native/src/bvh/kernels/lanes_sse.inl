// SPDX-License-Identifier: GPL-3.0-or-later
// Four floats at a time, with SSE4.2 or (by the compiler's flags) the shorter instructions of its successors.

struct Mask4 {
  __m128 lanes;

  friend Mask4 operator&(Mask4 a, Mask4 b) { return {_mm_and_ps(a.lanes, b.lanes)}; }
  friend Mask4 operator|(Mask4 a, Mask4 b) { return {_mm_or_ps(a.lanes, b.lanes)}; }
  unsigned bits() const { return static_cast<unsigned>(_mm_movemask_ps(lanes)); }
};

struct Float4 {
  __m128 lanes;

  static Float4 load(const float* aligned) { return {_mm_load_ps(aligned)}; }
  static Float4 load_anywhere(const float* from) { return {_mm_loadu_ps(from)}; }
  static Float4 all(float x) { return {_mm_set1_ps(x)}; }
  static Float4 of(float x, float y, float z) { return {_mm_setr_ps(x, y, z, 0)}; }
  static Mask4 mask(unsigned bits) {
    const __m128i lane_bits = _mm_setr_epi32(1, 2, 4, 8);
    return {
        _mm_castsi128_ps(_mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(static_cast<int>(bits)), lane_bits), lane_bits))};
  }
  void store(float* aligned) const { _mm_store_ps(aligned, lanes); }
  void store3(float* to) const {
    _mm_storel_pi(reinterpret_cast<__m64*>(to), lanes);
    _mm_store_ss(to + 2, _mm_movehl_ps(lanes, lanes));
  }
  friend Float4 operator+(Float4 a, Float4 b) { return {_mm_add_ps(a.lanes, b.lanes)}; }
  friend Float4 operator-(Float4 a, Float4 b) { return {_mm_sub_ps(a.lanes, b.lanes)}; }
  friend Float4 operator*(Float4 a, Float4 b) { return {_mm_mul_ps(a.lanes, b.lanes)}; }
  friend Float4 operator/(Float4 a, Float4 b) { return {_mm_div_ps(a.lanes, b.lanes)}; }
  // Where one is NaN, b.
  friend Float4 min(Float4 a, Float4 b) { return {_mm_min_ps(a.lanes, b.lanes)}; }
  friend Float4 max(Float4 a, Float4 b) { return {_mm_max_ps(a.lanes, b.lanes)}; }
  friend Float4 abs(Float4 a) { return {_mm_andnot_ps(_mm_set1_ps(-0.0f), a.lanes)}; }
  friend Float4 copysign(Float4 magnitude, Float4 sign) {
    return {_mm_or_ps(_mm_andnot_ps(_mm_set1_ps(-0.0f), magnitude.lanes), _mm_and_ps(_mm_set1_ps(-0.0f), sign.lanes))};
  }
  friend Float4 select(Mask4 mask, Float4 where_set, Float4 elsewhere) {
    return {_mm_blendv_ps(elsewhere.lanes, where_set.lanes, mask.lanes)};
  }
  friend Mask4 operator<=(Float4 a, Float4 b) { return {_mm_cmple_ps(a.lanes, b.lanes)}; }
  friend Mask4 operator<(Float4 a, Float4 b) { return {_mm_cmplt_ps(a.lanes, b.lanes)}; }
  friend Mask4 operator==(Float4 a, Float4 b) { return {_mm_cmpeq_ps(a.lanes, b.lanes)}; }
  // All bits, where a != b counts for NaN too.
  friend Mask4 operator!=(Float4 a, Float4 b) { return {_mm_cmpneq_ps(a.lanes, b.lanes)}; }
  unsigned sign_bits() const { return static_cast<unsigned>(_mm_movemask_ps(lanes)); }
  float smallest() const {
    const __m128 pairs = _mm_min_ps(lanes, _mm_movehl_ps(lanes, lanes));
    return _mm_cvtss_f32(_mm_min_ss(pairs, _mm_movehdup_ps(pairs)));
  }
  float largest() const {
    const __m128 pairs = _mm_max_ps(lanes, _mm_movehl_ps(lanes, lanes));
    return _mm_cvtss_f32(_mm_max_ss(pairs, _mm_movehdup_ps(pairs)));
  }
};

inline Mask4 equal(const std::uint32_t* aligned, std::uint32_t value) {
  return {_mm_castsi128_ps(_mm_cmpeq_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(aligned)),
                                           _mm_set1_epi32(static_cast<int>(value))))};
}
inline Mask4 without(Mask4 mask, Mask4 those) { return {_mm_andnot_ps(those.lanes, mask.lanes)}; }
