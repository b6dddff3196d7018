// SPDX-License-Identifier: GPL-3.0-or-later
// Eight floats at a time with AVX2.

struct Mask8 {
  __m256 lanes;

  friend Mask8 operator&(Mask8 a, Mask8 b) { return {_mm256_and_ps(a.lanes, b.lanes)}; }
  friend Mask8 operator|(Mask8 a, Mask8 b) { return {_mm256_or_ps(a.lanes, b.lanes)}; }
  unsigned bits() const { return static_cast<unsigned>(_mm256_movemask_ps(lanes)); }
};

struct Float8 {
  __m256 lanes;

  static Float8 load(const float* aligned) { return {_mm256_load_ps(aligned)}; }
  static Float8 all(float x) { return {_mm256_set1_ps(x)}; }
  static Mask8 mask(unsigned bits) {
    const __m256i lane_bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    return {_mm256_castsi256_ps(
        _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), lane_bits), lane_bits))};
  }
  void store(float* aligned) const { _mm256_store_ps(aligned, lanes); }
  friend Float8 operator+(Float8 a, Float8 b) { return {_mm256_add_ps(a.lanes, b.lanes)}; }
  friend Float8 operator-(Float8 a, Float8 b) { return {_mm256_sub_ps(a.lanes, b.lanes)}; }
  friend Float8 operator*(Float8 a, Float8 b) { return {_mm256_mul_ps(a.lanes, b.lanes)}; }
  friend Float8 operator/(Float8 a, Float8 b) { return {_mm256_div_ps(a.lanes, b.lanes)}; }
  // Where one is NaN, b.
  friend Float8 min(Float8 a, Float8 b) { return {_mm256_min_ps(a.lanes, b.lanes)}; }
  friend Float8 max(Float8 a, Float8 b) { return {_mm256_max_ps(a.lanes, b.lanes)}; }
  friend Float8 abs(Float8 a) { return {_mm256_andnot_ps(_mm256_set1_ps(-0.0f), a.lanes)}; }
  friend Float8 copysign(Float8 magnitude, Float8 sign) {
    return {_mm256_or_ps(_mm256_andnot_ps(_mm256_set1_ps(-0.0f), magnitude.lanes),
                         _mm256_and_ps(_mm256_set1_ps(-0.0f), sign.lanes))};
  }
  friend Float8 select(Mask8 mask, Float8 where_set, Float8 elsewhere) {
    return {_mm256_blendv_ps(elsewhere.lanes, where_set.lanes, mask.lanes)};
  }
  friend Mask8 operator<=(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.lanes, b.lanes, _CMP_LE_OQ)}; }
  friend Mask8 operator<(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.lanes, b.lanes, _CMP_LT_OQ)}; }
  friend Mask8 operator==(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.lanes, b.lanes, _CMP_EQ_OQ)}; }
  unsigned sign_bits() const { return static_cast<unsigned>(_mm256_movemask_ps(lanes)); }
  float smallest() const {
    return Float4{_mm_min_ps(_mm256_castps256_ps128(lanes), _mm256_extractf128_ps(lanes, 1))}.smallest();
  }
  float largest() const {
    return Float4{_mm_max_ps(_mm256_castps256_ps128(lanes), _mm256_extractf128_ps(lanes, 1))}.largest();
  }
};

// What packets have in each lane a ray of.
using Pack = Float8;

// Row m: the numbers of the set bits of m in front, four bits each, which moves the lanes of a mask together. In this form all rows take a kilobyte
// of the nearest cache.
struct CompressTable {
  alignas(64) std::uint32_t rows[256] = {};

  constexpr CompressTable() {
    for (unsigned mask = 0; mask < 256; ++mask) {
      unsigned count = 0;
      for (unsigned bit = 0; bit < 8; ++bit)
        if (mask >> bit & 1) rows[mask] |= bit << 4 * count++;
    }
  }
};
constexpr CompressTable compress_table;

// Permutations use the lowest three bits of each number.
inline __m256i compressing(unsigned mask) {
  const __m256i places = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  return _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(compress_table.rows[mask])), places);
}

inline unsigned children_within(const Float8& entry, const Float8& exit) { return (entry <= exit).bits(); }

// The numbers of the children that are met, farthest first, of which only the lowest three bits count.
struct MetChildren {
  __m256i numbers;
  unsigned places;  // bits: where they are in the node's order

  std::uint32_t count() const { return static_cast<std::uint32_t>(_mm_popcnt_u32(places)); }
};
inline MetChildren met_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                const Float8& exit) {
  const __m256i order = _mm256_srl_epi32(_mm256_load_si256(reinterpret_cast<const __m256i*>(node.order)),
                                         _mm_cvtsi32_si128(static_cast<int>(octant_shift)));
  const unsigned mask = Mask8{_mm256_permutevar8x32_ps((entry <= exit).lanes, order)}.bits();
  return {_mm256_permutevar8x32_epi32(order, compressing(mask)), mask};
}
inline std::uint32_t list_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                   const Float8& exit, std::uint32_t (&numbers)[8]) {
  const MetChildren met = met_children(node, octant_shift, entry, exit);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(numbers), met.numbers);
  return met.count();
}

// How many children were pushed, and where the nearest is in the node's order.
struct PushedChildren {
  std::uint32_t count, nearest;
};

inline PushedChildren push_children(const TreeNode& node, std::uint32_t octant_shift, const Float8& entry,
                                    const Float8& exit, TreeReference* references, float* entries) {
  const MetChildren met = met_children(node, octant_shift, entry, exit);
  const __m256i children = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.children));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(references), _mm256_permutevar8x32_epi32(children, met.numbers));
  _mm256_storeu_ps(entries, _mm256_permutevar8x32_ps(entry.lanes, met.numbers));
  return {met.count(), 31 - _lzcnt_u32(met.places | 1)};
}

inline std::uint32_t push_any_children(const TreeNode& node, const Float8& entry, const Float8& exit,
                                       TreeReference* references) {
  const unsigned mask = children_within(entry, exit);
  const __m256i children = _mm256_load_si256(reinterpret_cast<const __m256i*>(node.children));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(references), _mm256_permutevar8x32_epi32(children, compressing(mask)));
  return static_cast<std::uint32_t>(_mm_popcnt_u32(mask));
}

inline std::uint32_t keep_within(TreeReference* references, float* entries, std::uint32_t count, float t_max) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; i += 8) {
    const __m256i some = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(references + i));
    const __m256 distances = _mm256_loadu_ps(entries + i);
    const unsigned is_there = count - i >= 8 ? 255u : (1u << (count - i)) - 1;
    const int is_near = _mm256_movemask_ps(_mm256_cmp_ps(distances, _mm256_set1_ps(t_max), _CMP_LE_OQ));
    const unsigned mask = static_cast<unsigned>(is_near) & is_there;
    const __m256i row = compressing(mask);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(references + kept), _mm256_permutevar8x32_epi32(some, row));
    _mm256_storeu_ps(entries + kept, _mm256_permutevar8x32_ps(distances, row));
    kept += static_cast<std::uint32_t>(_mm_popcnt_u32(mask));
  }
  return kept;
}
