// SPDX-License-Identifier: GPL-3.0-or-later
// Four floats at a time in plain C++, for machines without vectors of ours.

struct Mask4 {
  bool lanes[4];

  friend Mask4 operator&(Mask4 a, Mask4 b) {
    Mask4 result;
    for (int i = 0; i < 4; ++i) result.lanes[i] = a.lanes[i] && b.lanes[i];
    return result;
  }
  friend Mask4 operator|(Mask4 a, Mask4 b) {
    Mask4 result;
    for (int i = 0; i < 4; ++i) result.lanes[i] = a.lanes[i] || b.lanes[i];
    return result;
  }
  unsigned bits() const { return lanes[0] | lanes[1] << 1 | lanes[2] << 2 | lanes[3] << 3; }
};

struct Float4 {
  float lanes[4];

  template <class Function>
  static Float4 of_each(Function&& function) {
    Float4 result;
    for (int i = 0; i < 4; ++i) result.lanes[i] = function(i);
    return result;
  }
  template <class Function>
  static Mask4 mask_of_each(Function&& function) {
    Mask4 result;
    for (int i = 0; i < 4; ++i) result.lanes[i] = function(i);
    return result;
  }

  // By memory, like those of other instruction sets: packets keep the bits of numbers in floats.
  static Float4 load(const float* from) {
    Float4 result;
    __builtin_memcpy(result.lanes, from, sizeof lanes);
    return result;
  }
  static Float4 load_anywhere(const float* from) { return load(from); }
  static Float4 all(float x) { return {{x, x, x, x}}; }
  static Float4 of(float x, float y, float z) { return {{x, y, z, 0}}; }
  static Mask4 mask(unsigned bits) {
    return mask_of_each([&](int i) { return (bits >> i & 1) != 0; });
  }
  void store(float* to) const { __builtin_memcpy(to, lanes, sizeof lanes); }
  void store3(float* to) const {
    for (int i = 0; i < 3; ++i) to[i] = lanes[i];
  }
  friend Float4 operator+(Float4 a, Float4 b) {
    return of_each([&](int i) { return a.lanes[i] + b.lanes[i]; });
  }
  friend Float4 operator-(Float4 a, Float4 b) {
    return of_each([&](int i) { return a.lanes[i] - b.lanes[i]; });
  }
  friend Float4 operator*(Float4 a, Float4 b) {
    return of_each([&](int i) { return a.lanes[i] * b.lanes[i]; });
  }
  friend Float4 operator/(Float4 a, Float4 b) {
    return of_each([&](int i) { return a.lanes[i] / b.lanes[i]; });
  }
  // Where one is NaN, b.
  friend Float4 min(Float4 a, Float4 b) {
    return of_each([&](int i) { return a.lanes[i] < b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
  }
  friend Float4 max(Float4 a, Float4 b) {
    return of_each([&](int i) { return a.lanes[i] > b.lanes[i] ? a.lanes[i] : b.lanes[i]; });
  }
  friend Float4 abs(Float4 a) {
    return of_each([&](int i) { return __builtin_fabsf(a.lanes[i]); });
  }
  friend Float4 copysign(Float4 magnitude, Float4 sign) {
    return of_each([&](int i) { return __builtin_copysignf(magnitude.lanes[i], sign.lanes[i]); });
  }
  friend Float4 select(Mask4 mask, Float4 where_set, Float4 elsewhere) {
    return of_each([&](int i) { return mask.lanes[i] ? where_set.lanes[i] : elsewhere.lanes[i]; });
  }
  friend Mask4 operator<=(Float4 a, Float4 b) {
    return mask_of_each([&](int i) { return a.lanes[i] <= b.lanes[i]; });
  }
  friend Mask4 operator<(Float4 a, Float4 b) {
    return mask_of_each([&](int i) { return a.lanes[i] < b.lanes[i]; });
  }
  friend Mask4 operator==(Float4 a, Float4 b) {
    return mask_of_each([&](int i) { return a.lanes[i] == b.lanes[i]; });
  }
  friend Mask4 operator!=(Float4 a, Float4 b) {
    return mask_of_each([&](int i) { return a.lanes[i] != b.lanes[i]; });
  }
  unsigned sign_bits() const {
    return mask_of_each([&](int i) { return __builtin_signbit(lanes[i]) != 0; }).bits();
  }
  float smallest() const {
    float result = lanes[0];
    for (int i = 1; i < 4; ++i) result = lanes[i] < result ? lanes[i] : result;
    return result;
  }
  float largest() const {
    float result = lanes[0];
    for (int i = 1; i < 4; ++i) result = lanes[i] > result ? lanes[i] : result;
    return result;
  }
};

inline Mask4 equal(const std::uint32_t* from, std::uint32_t value) {
  return Float4::mask_of_each([&](int i) { return from[i] == value; });
}
inline Mask4 without(Mask4 mask, Mask4 those) {
  return Float4::mask_of_each([&](int i) { return mask.lanes[i] && !those.lanes[i]; });
}
