// SPDX-License-Identifier: GPL-3.0-or-later
// Four doubles, or four floats, at a time in the compiler's own vectors of 16 bytes.

using FourFloats = float __attribute__((vector_size(16)));
using FourInts = int __attribute__((vector_size(16)));
using TwoDoubles = double __attribute__((vector_size(16)));
using TwoLongs = long long __attribute__((vector_size(16)));

struct FloatMask {
  FourInts lanes;  // all ones or all zeros

  friend FloatMask operator&(FloatMask a, FloatMask b) { return {a.lanes & b.lanes}; }
};

struct Floats {
  FourFloats lanes;

  static Floats all(float x) { return {FourFloats{x, x, x, x}}; }
  static Floats of(float a, float b, float c, float d) { return {FourFloats{a, b, c, d}}; }
  friend Floats operator+(Floats a, Floats b) { return {a.lanes + b.lanes}; }
  friend Floats operator-(Floats a, Floats b) { return {a.lanes - b.lanes}; }
  friend Floats operator*(Floats a, Floats b) { return {a.lanes * b.lanes}; }
  friend Floats operator/(Floats a, Floats b) { return {a.lanes / b.lanes}; }
  friend Floats operator-(Floats a) { return {-a.lanes}; }
  friend Floats square_root(Floats a) {
    return of(__builtin_sqrtf(a.lanes[0]), __builtin_sqrtf(a.lanes[1]), __builtin_sqrtf(a.lanes[2]),
              __builtin_sqrtf(a.lanes[3]));
  }
  friend FloatMask operator<(Floats a, Floats b) { return {a.lanes < b.lanes}; }
  friend FloatMask operator<=(Floats a, Floats b) { return {a.lanes <= b.lanes}; }
  friend Floats select(FloatMask mask, Floats where_set, Floats elsewhere) {
    return {mask.lanes ? where_set.lanes : elsewhere.lanes};
  }
};

struct DoubleMask {
  TwoLongs low, high;  // all ones or all zeros

  friend DoubleMask operator&(DoubleMask a, DoubleMask b) { return {a.low & b.low, a.high & b.high}; }
  [[nodiscard]] bool is_all_set() const {
    const TwoLongs both = low & high;
    return (both[0] & both[1]) != 0;
  }
};

struct Doubles {
  TwoDoubles low, high;

  static Doubles all(double x) { return {TwoDoubles{x, x}, TwoDoubles{x, x}}; }
  static Doubles of(double a, double b, double c, double d) { return {TwoDoubles{a, b}, TwoDoubles{c, d}}; }
  static Doubles from(Floats a) {
    return of(double{a.lanes[0]}, double{a.lanes[1]}, double{a.lanes[2]}, double{a.lanes[3]});
  }
  [[nodiscard]] Floats rounded() const {
    return Floats::of(static_cast<float>(low[0]), static_cast<float>(low[1]), static_cast<float>(high[0]),
                      static_cast<float>(high[1]));
  }
  friend Doubles operator+(Doubles a, Doubles b) { return {a.low + b.low, a.high + b.high}; }
  friend Doubles operator-(Doubles a, Doubles b) { return {a.low - b.low, a.high - b.high}; }
  friend Doubles operator*(Doubles a, Doubles b) { return {a.low * b.low, a.high * b.high}; }
  friend Doubles operator/(Doubles a, Doubles b) { return {a.low / b.low, a.high / b.high}; }
  friend Doubles operator-(Doubles a) { return {-a.low, -a.high}; }
  friend Doubles abs(Doubles a) {
    const auto absolute = [](TwoDoubles x) {
      constexpr long long without_sign = 0x7fffffffffffffff;
      return reinterpret_cast<TwoDoubles>(reinterpret_cast<TwoLongs>(x) & TwoLongs{without_sign, without_sign});
    };
    return {absolute(a.low), absolute(a.high)};
  }
  friend Doubles square_root(Doubles a) {
    return {TwoDoubles{__builtin_sqrt(a.low[0]), __builtin_sqrt(a.low[1])},
            TwoDoubles{__builtin_sqrt(a.high[0]), __builtin_sqrt(a.high[1])}};
  }
  // Where neither is less, b.
  friend Doubles min(Doubles a, Doubles b) { return select(a < b, a, b); }
  friend Doubles max(Doubles a, Doubles b) { return select(b < a, a, b); }
  friend DoubleMask operator<(Doubles a, Doubles b) { return {a.low < b.low, a.high < b.high}; }
  friend DoubleMask operator<=(Doubles a, Doubles b) { return {a.low <= b.low, a.high <= b.high}; }
  friend Doubles select(DoubleMask mask, Doubles where_set, Doubles elsewhere) {
    return {mask.low ? where_set.low : elsewhere.low, mask.high ? where_set.high : elsewhere.high};
  }
};

// Three numbers, and no more, are read at each place.
inline void load_columns(const float* const (&rows)[4], Floats& x, Floats& y, Floats& z) {
  const auto column = [&](int i) { return Floats::of(rows[0][i], rows[1][i], rows[2][i], rows[3][i]); };
  x = column(0), y = column(1), z = column(2);
}
inline void load_columns(const double* const (&rows)[4], Doubles (&columns)[4]) {
  for (int i = 0; i < 4; ++i) columns[i] = {TwoDoubles{rows[0][i], rows[1][i]}, TwoDoubles{rows[2][i], rows[3][i]}};
}
inline void store_columns(Floats a, Floats b, Floats c, Floats d, float* const (&rows)[4]) {
  for (int i = 0; i < 4; ++i) {
    rows[i][0] = a.lanes[i];
    rows[i][1] = b.lanes[i];
    rows[i][2] = c.lanes[i];
    rows[i][3] = d.lanes[i];
  }
}
