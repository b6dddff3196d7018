// SPDX-License-Identifier: GPL-3.0-or-later
// Four doubles, or four floats, at a time with AVX2.

struct FloatMask {
  __m128 lanes;

  friend FloatMask operator&(FloatMask a, FloatMask b) { return {_mm_and_ps(a.lanes, b.lanes)}; }
};

struct Floats {
  __m128 lanes;

  static Floats all(float x) { return {_mm_set1_ps(x)}; }
  static Floats of(float a, float b, float c, float d) { return {_mm_setr_ps(a, b, c, d)}; }
  friend Floats operator+(Floats a, Floats b) { return {_mm_add_ps(a.lanes, b.lanes)}; }
  friend Floats operator-(Floats a, Floats b) { return {_mm_sub_ps(a.lanes, b.lanes)}; }
  friend Floats operator*(Floats a, Floats b) { return {_mm_mul_ps(a.lanes, b.lanes)}; }
  friend Floats operator/(Floats a, Floats b) { return {_mm_div_ps(a.lanes, b.lanes)}; }
  friend Floats operator-(Floats a) { return {_mm_xor_ps(a.lanes, _mm_set1_ps(-0.0f))}; }
  friend Floats square_root(Floats a) { return {_mm_sqrt_ps(a.lanes)}; }
  friend FloatMask operator<(Floats a, Floats b) { return {_mm_cmplt_ps(a.lanes, b.lanes)}; }
  friend FloatMask operator<=(Floats a, Floats b) { return {_mm_cmple_ps(a.lanes, b.lanes)}; }
  friend Floats select(FloatMask mask, Floats where_set, Floats elsewhere) {
    return {_mm_blendv_ps(elsewhere.lanes, where_set.lanes, mask.lanes)};
  }
};

struct DoubleMask {
  __m256d lanes;

  friend DoubleMask operator&(DoubleMask a, DoubleMask b) { return {_mm256_and_pd(a.lanes, b.lanes)}; }
  [[nodiscard]] bool is_all_set() const { return _mm256_movemask_pd(lanes) == 15; }
};

struct Doubles {
  __m256d lanes;

  static Doubles all(double x) { return {_mm256_set1_pd(x)}; }
  static Doubles of(double a, double b, double c, double d) { return {_mm256_setr_pd(a, b, c, d)}; }
  static Doubles from(Floats a) { return {_mm256_cvtps_pd(a.lanes)}; }
  [[nodiscard]] Floats rounded() const { return {_mm256_cvtpd_ps(lanes)}; }
  friend Doubles operator+(Doubles a, Doubles b) { return {_mm256_add_pd(a.lanes, b.lanes)}; }
  friend Doubles operator-(Doubles a, Doubles b) { return {_mm256_sub_pd(a.lanes, b.lanes)}; }
  friend Doubles operator*(Doubles a, Doubles b) { return {_mm256_mul_pd(a.lanes, b.lanes)}; }
  friend Doubles operator/(Doubles a, Doubles b) { return {_mm256_div_pd(a.lanes, b.lanes)}; }
  friend Doubles operator-(Doubles a) { return {_mm256_xor_pd(a.lanes, _mm256_set1_pd(-0.0))}; }
  friend Doubles abs(Doubles a) { return {_mm256_andnot_pd(_mm256_set1_pd(-0.0), a.lanes)}; }
  friend Doubles square_root(Doubles a) { return {_mm256_sqrt_pd(a.lanes)}; }
  // Where neither is less, b.
  friend Doubles min(Doubles a, Doubles b) { return {_mm256_min_pd(a.lanes, b.lanes)}; }
  friend Doubles max(Doubles a, Doubles b) { return {_mm256_max_pd(a.lanes, b.lanes)}; }
  friend DoubleMask operator<(Doubles a, Doubles b) { return {_mm256_cmp_pd(a.lanes, b.lanes, _CMP_LT_OQ)}; }
  friend DoubleMask operator<=(Doubles a, Doubles b) { return {_mm256_cmp_pd(a.lanes, b.lanes, _CMP_LE_OQ)}; }
  friend Doubles select(DoubleMask mask, Doubles where_set, Doubles elsewhere) {
    return {_mm256_blendv_pd(elsewhere.lanes, where_set.lanes, mask.lanes)};
  }
};

// Three numbers, and no more, are read at each place.
inline void load_columns(const float* const (&rows)[4], Floats& x, Floats& y, Floats& z) {
  const auto row = [&](int i) {
    double pair;  // two floats: their memory is not aligned for a double
    __builtin_memcpy(&pair, rows[i], sizeof pair);
    const __m128 two = _mm_castpd_ps(_mm_set_sd(pair));
    return _mm_insert_ps(two, _mm_load_ss(rows[i] + 2), 0x20);
  };
  const __m128 a = row(0), b = row(1), c = row(2), d = row(3);
  const __m128 ab = _mm_unpacklo_ps(a, b), cd = _mm_unpacklo_ps(c, d);
  x.lanes = _mm_movelh_ps(ab, cd);
  y.lanes = _mm_movehl_ps(cd, ab);
  z.lanes = _mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
}
inline void load_columns(const double* const (&rows)[4], Doubles (&columns)[4]) {
  const __m256d a = _mm256_loadu_pd(rows[0]), b = _mm256_loadu_pd(rows[1]);
  const __m256d c = _mm256_loadu_pd(rows[2]), d = _mm256_loadu_pd(rows[3]);
  const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b);
  const __m256d cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
  columns[0].lanes = _mm256_permute2f128_pd(ab_even, cd_even, 0x20);
  columns[1].lanes = _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20);
  columns[2].lanes = _mm256_permute2f128_pd(ab_even, cd_even, 0x31);
  columns[3].lanes = _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31);
}
inline void store_columns(Floats a, Floats b, Floats c, Floats d, float* const (&rows)[4]) {
  _MM_TRANSPOSE4_PS(a.lanes, b.lanes, c.lanes, d.lanes);
  _mm_store_ps(rows[0], a.lanes);
  _mm_store_ps(rows[1], b.lanes);
  _mm_store_ps(rows[2], c.lanes);
  _mm_store_ps(rows[3], d.lanes);
}
