// SPDX-License-Identifier: GPL-3.0-or-later
// Eight floats at a time with AVX-512, which moves the lanes of a mask together in one instruction.

struct Float8 {
  __m256 lanes;

  static Float8 load(const float* aligned) { return {_mm256_load_ps(aligned)}; }
  static Float8 all(float x) { return {_mm256_set1_ps(x)}; }
  friend Float8 operator-(Float8 a, Float8 b) { return {_mm256_sub_ps(a.lanes, b.lanes)}; }
  friend Float8 operator*(Float8 a, Float8 b) { return {_mm256_mul_ps(a.lanes, b.lanes)}; }
  // Where one is NaN, b.
  friend Float8 min(Float8 a, Float8 b) { return {_mm256_min_ps(a.lanes, b.lanes)}; }
  friend Float8 max(Float8 a, Float8 b) { return {_mm256_max_ps(a.lanes, b.lanes)}; }
};

struct Mask16 {
  __mmask16 lanes;

  friend Mask16 operator&(Mask16 a, Mask16 b) { return {static_cast<__mmask16>(a.lanes & b.lanes)}; }
  friend Mask16 operator|(Mask16 a, Mask16 b) { return {static_cast<__mmask16>(a.lanes | b.lanes)}; }
  unsigned bits() const { return lanes; }
};

struct Float16 {
  __m512 lanes;

  static Float16 load(const float* aligned) { return {_mm512_load_ps(aligned)}; }
  static Float16 all(float x) { return {_mm512_set1_ps(x)}; }
  static Mask16 mask(unsigned bits) { return {static_cast<__mmask16>(bits)}; }
  void store(float* aligned) const { _mm512_store_ps(aligned, lanes); }
  friend Float16 operator+(Float16 a, Float16 b) { return {_mm512_add_ps(a.lanes, b.lanes)}; }
  friend Float16 operator-(Float16 a, Float16 b) { return {_mm512_sub_ps(a.lanes, b.lanes)}; }
  friend Float16 operator*(Float16 a, Float16 b) { return {_mm512_mul_ps(a.lanes, b.lanes)}; }
  friend Float16 operator/(Float16 a, Float16 b) { return {_mm512_div_ps(a.lanes, b.lanes)}; }
  // Where one is NaN, b.
  friend Float16 min(Float16 a, Float16 b) { return {_mm512_min_ps(a.lanes, b.lanes)}; }
  friend Float16 max(Float16 a, Float16 b) { return {_mm512_max_ps(a.lanes, b.lanes)}; }
  friend Float16 abs(Float16 a) { return {_mm512_abs_ps(a.lanes)}; }
  friend Float16 copysign(Float16 magnitude, Float16 sign) {
    return {_mm512_or_ps(_mm512_andnot_ps(_mm512_set1_ps(-0.0f), magnitude.lanes),
                         _mm512_and_ps(_mm512_set1_ps(-0.0f), sign.lanes))};
  }
  friend Float16 select(Mask16 mask, Float16 where_set, Float16 elsewhere) {
    return {_mm512_mask_blend_ps(mask.lanes, elsewhere.lanes, where_set.lanes)};
  }
  friend Mask16 operator<=(Float16 a, Float16 b) { return {_mm512_cmp_ps_mask(a.lanes, b.lanes, _CMP_LE_OQ)}; }
  friend Mask16 operator<(Float16 a, Float16 b) { return {_mm512_cmp_ps_mask(a.lanes, b.lanes, _CMP_LT_OQ)}; }
  friend Mask16 operator==(Float16 a, Float16 b) { return {_mm512_cmp_ps_mask(a.lanes, b.lanes, _CMP_EQ_OQ)}; }
  unsigned sign_bits() const { return _mm512_movepi32_mask(_mm512_castps_si512(lanes)); }
  float smallest() const { return _mm512_reduce_min_ps(lanes); }
  float largest() const { return _mm512_reduce_max_ps(lanes); }
};

// What packets have in each lane a ray of.
using Pack = Float16;

inline std::uint32_t push_compressed(__mmask8 mask, __m256i references, __m256 entries, TreeReference* to_references,
                                     float* to_entries) {
  // Compressed in registers: storing compressed memory is slow on some machines.
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to_references), _mm256_maskz_compress_epi32(mask, references));
  _mm256_storeu_ps(to_entries, _mm256_maskz_compress_ps(mask, entries));
  return static_cast<std::uint32_t>(_mm_popcnt_u32(mask));
}

// How many children were pushed, and where the nearest is in the node's order.
struct PushedChildren {
  std::uint32_t count, nearest;
};

inline PushedChildren push_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                    const Float8& exit, TreeReference* references, float* entries) {
  // Permutations use the lowest three bits of each number.
  const __m256i order = _mm256_srl_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(node.order)),
                                         _mm_cvtsi32_si128(static_cast<int>(octant_shift)));
  const __m256i children =
      _mm256_permutevar8x32_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(node.children)), order);
  const __m256 entry_distances = _mm256_permutevar8x32_ps(entry.lanes, order);
  const __m256 exit_distances = _mm256_permutevar8x32_ps(exit.lanes, order);
  const __mmask8 mask = _mm256_cmp_ps_mask(entry_distances, exit_distances, _CMP_LE_OQ);
  return {push_compressed(mask, children, entry_distances, references, entries),
          31 - static_cast<std::uint32_t>(__builtin_clz(mask | 1u))};
}

// The numbers of the children that are met, farthest first, of which only the lowest three bits count.
inline std::uint32_t list_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                   const Float8& exit, std::uint32_t (&numbers)[8]) {
  const __m256i order = _mm256_srl_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(node.order)),
                                         _mm_cvtsi32_si128(static_cast<int>(octant_shift)));
  const __mmask8 mask = _mm256_cmp_ps_mask(_mm256_permutevar8x32_ps(entry.lanes, order),
                                           _mm256_permutevar8x32_ps(exit.lanes, order), _CMP_LE_OQ);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(numbers), _mm256_maskz_compress_epi32(mask, order));
  return static_cast<std::uint32_t>(_mm_popcnt_u32(mask));
}

inline unsigned children_within(const Float8& entry, const Float8& exit) {
  return _mm256_cmp_ps_mask(entry.lanes, exit.lanes, _CMP_LE_OQ);
}

inline std::uint32_t push_any_children(const TreeNode& node, const Float8& entry, const Float8& exit,
                                       TreeReference* references) {
  const auto mask = static_cast<__mmask8>(children_within(entry, exit));
  const __m256i children = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.children));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(references), _mm256_maskz_compress_epi32(mask, children));
  return static_cast<std::uint32_t>(_mm_popcnt_u32(mask));
}

inline std::uint32_t keep_within(TreeReference* references, float* entries, std::uint32_t count, float t_max) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; i += 8) {
    const __m256i some = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(references + i));
    const __m256 distances = _mm256_loadu_ps(entries + i);
    const unsigned is_there = count - i >= 8 ? 255u : (1u << (count - i)) - 1;
    const auto mask = static_cast<__mmask8>(
        _mm256_mask_cmp_ps_mask(static_cast<__mmask8>(is_there), distances, _mm256_set1_ps(t_max), _CMP_LE_OQ));
    kept += push_compressed(mask, some, distances, references + kept, entries + kept);
  }
  return kept;
}
