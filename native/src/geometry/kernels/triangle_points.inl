// SPDX-License-Identifier: GPL-3.0-or-later
// Hits on triangles, solved again from the corners in double precision in the object's space and taken to the world,
// with the bound of all that rounding does: four at a time, each in a lane of its own. Möller and Trumbore 1997, "Fast,
// Minimum Storage Ray/Triangle Intersection", in terms of the normal.

template <class T>
struct Vector {
  T x, y, z;

  friend Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vector operator*(const Vector& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Vector abs(const Vector& a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
};
using FloatVector = Vector<Floats>;
using DoubleVector = Vector<Doubles>;

template <class T>
T dot(const Vector<T>& a, const Vector<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline DoubleVector cross(const DoubleVector& a, const DoubleVector& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
inline Doubles sum(const DoubleVector& a) { return a.x + a.y + a.z; }

inline DoubleVector widen(const FloatVector& a) { return {Doubles::from(a.x), Doubles::from(a.y), Doubles::from(a.z)}; }
inline FloatVector round(const DoubleVector& a) { return {a.x.rounded(), a.y.rounded(), a.z.rounded()}; }

template <class Number, class Mask>
Vector<Number> select(Mask mask, const Vector<Number>& where_set, const Vector<Number>& elsewhere) {
  return {select(mask, where_set.x, elsewhere.x), select(mask, where_set.y, elsewhere.y),
          select(mask, where_set.z, elsewhere.z)};
}

// The direction that `v` has, or `otherwise` where it has none. `least` and `most` are the normal numbers' ends.
template <class T>
Vector<T> direction_or(const Vector<T>& v, const Vector<T>& otherwise, T least, T most) {
  const T squared = dot(v, v);
  return select((least <= squared) & (squared <= most), v * (T::all(1) / square_root(squared)), otherwise);
}

inline FloatVector load_vectors(const float* const (&places)[4]) {
  FloatVector result;
  load_columns(places, result.x, result.y, result.z);
  return result;
}

struct Transforms {
  Doubles rows[3][4];

  [[nodiscard]] DoubleVector column(int i) const { return {rows[0][i], rows[1][i], rows[2][i]}; }
  [[nodiscard]] DoubleVector vector(const DoubleVector& v) const {
    const auto of_row = [&](int i) { return rows[i][0] * v.x + rows[i][1] * v.y + rows[i][2] * v.z; };
    return {of_row(0), of_row(1), of_row(2)};
  }
  [[nodiscard]] DoubleVector point(const DoubleVector& p) const { return vector(p) + column(3); }
  [[nodiscard]] DoubleVector transposed_vector(const DoubleVector& v) const {
    return {dot(column(0), v), dot(column(1), v), dot(column(2), v)};
  }
  // Of each coordinate of point(p), given that each coordinate of p is off by at most `error`.
  [[nodiscard]] DoubleVector point_error(const DoubleVector& p, const DoubleVector& error) const {
    const DoubleVector before = error + abs(p) * Doubles::all(gamma(4));
    const auto of_row = [&](int i) {
      return abs(rows[i][0]) * before.x + abs(rows[i][1]) * before.y + abs(rows[i][2]) * before.z;
    };
    return DoubleVector{of_row(0), of_row(1), of_row(2)} + abs(column(3)) * Doubles::all(gamma(4));
  }
};

// What to look at in four requests.
struct Four {
  const PointRequest* requests[4];
  PointResult* results[4];

  template <class Find>
  [[nodiscard]] FloatVector vectors(Find&& find) const {
    return load_vectors({find(*requests[0]), find(*requests[1]), find(*requests[2]), find(*requests[3])});
  }
  template <class Find>
  [[nodiscard]] Transforms transforms(Find&& find) const {
    Transforms result;
    for (int row = 0; row < 3; ++row)
      load_columns({find(*requests[0]) + 4 * row, find(*requests[1]) + 4 * row, find(*requests[2]) + 4 * row,
                    find(*requests[3]) + 4 * row},
                   result.rows[row]);
    return result;
  }
  // The last column alone.
  template <class Find>
  [[nodiscard]] DoubleVector translations(Find&& find) const {
    const auto of_axis = [&](int axis) {
      const auto of = [&](int lane) { return find(*requests[lane])[4 * axis + 3]; };
      return Doubles::of(of(0), of(1), of(2), of(3));
    };
    return {of_axis(0), of_axis(1), of_axis(2)};
  }
  [[nodiscard]] Doubles numbers(float PointRequest::* number) const {
    return Doubles::from(
        Floats::of(requests[0]->*number, requests[1]->*number, requests[2]->*number, requests[3]->*number));
  }
  void store(int first, Floats a, Floats b, Floats c, Floats d) const {
    const auto place = [&](int lane) { return reinterpret_cast<float*>(results[lane]) + first; };
    store_columns(a, b, c, d, {place(0), place(1), place(2), place(3)});
  }
};

struct LocalPoints {
  Doubles t, u, v;
  DoubleVector position, error, normal;
  DoubleMask is_backfacing;
};

[[gnu::always_inline]] inline LocalPoints solve_locally(const Four& four, const DoubleVector& origin,
                                                        const DoubleVector& direction) {
  const auto corner = [&](int i) {
    return widen(four.vectors([&](const PointRequest& request) { return request.corners[i]; }));
  };
  const DoubleVector p0 = corner(0), edge1 = corner(1) - p0, edge2 = corner(2) - p0, from_p0 = origin - p0;
  const DoubleVector normal = cross(edge1, edge2), q = cross(from_p0, direction);
  const Doubles determinant = dot(direction, normal), inverse_determinant = Doubles::all(1) / determinant;
  Doubles t = -dot(from_p0, normal) * inverse_determinant;
  Doubles u = -dot(edge2, q) * inverse_determinant, v = dot(edge1, q) * inverse_determinant;
  Doubles along_plane = Doubles::all(gamma(16)) * abs(inverse_determinant);
  // The hit knows better where the line of the ray doesn't say.
  const DoubleMask is_finite = abs(t + u + v) <= Doubles::all(__DBL_MAX__);
  if (!is_finite.is_all_set()) {
    t = select(is_finite, t, four.numbers(&PointRequest::t));
    u = select(is_finite, u, four.numbers(&PointRequest::u));
    v = select(is_finite, v, four.numbers(&PointRequest::v));
    along_plane = select(is_finite, along_plane, Doubles::all(0));
  }
  u = max(min(Doubles::all(1), u), Doubles::all(0));
  v = max(min(Doubles::all(1) - u, v), Doubles::all(0));

  // Two parts: interpolation; and the barycentrics, which a grazing ray leaves uncertain along the plane. Sums of
  // coordinates bound lengths without a root; the origin is no farther than p0 and it from there.
  const DoubleVector edge_sum = abs(edge1) + abs(edge2);
  const Doubles size = sum(edge_sum), reach = Doubles::all(2) * (sum(abs(from_p0)) + sum(abs(p0))) + size;
  along_plane = along_plane * (sum(abs(direction)) * reach * size);
  return {.t = t,
          .u = u,
          .v = v,
          .position = p0 + (edge1 * u + edge2 * v),
          .error = abs(p0) * Doubles::all(gamma(6)) + edge_sum * (Doubles::all(gamma(6)) + along_plane),
          .normal = normal,
          .is_backfacing = Doubles::all(0) < determinant};
}

// At least the error of p after it is rounded to floats too.
inline FloatVector add_float_rounding(const DoubleVector& p, const DoubleVector& error) {
  // Rounding the bound itself takes off less than is added here.
  const FloatVector bound = round((error + abs(p) * Doubles::all(0x1p-24)) * Doubles::all(1 + 0x1p-23));
  const Floats least = Floats::all(__FLT_DENORM_MIN__);
  return bound + FloatVector{least, least, least};
}

template <bool is_translation, bool has_normals>
void solve_four(const Four& four) {
  const auto to_object_of = [](const PointRequest& request) { return request.to_object; };
  const auto to_world_of = [](const PointRequest& request) { return request.to_world; };
  DoubleVector origin = widen(four.vectors([](const PointRequest& request) { return request.ray; }));
  DoubleVector direction = widen(four.vectors([](const PointRequest& request) { return request.ray + 4; }));
  Transforms to_object;
  if constexpr (is_translation) {
    origin = origin + four.translations(to_object_of);
  } else {
    to_object = four.transforms(to_object_of);
    origin = to_object.point(origin);
    direction = to_object.vector(direction);
  }
  const LocalPoints local = solve_locally(four, origin, direction);

  // Taking the point to the world, and taking it back as the origin of the next ray, both round. Normals go by the
  // inverse transpose, which keeps the outward side outward under mirroring too.
  DoubleVector position, error, world_normal = local.normal;
  if constexpr (is_translation) {
    const DoubleVector translation = four.translations(to_world_of);
    position = local.position + translation;
    error = local.error + (abs(local.position) + abs(translation)) * Doubles::all(gamma(4));
  } else {
    const Transforms to_world = four.transforms(to_world_of);
    const Doubles zero = Doubles::all(0);
    position = to_world.point(local.position);
    error = to_world.point_error(local.position,
                                 local.error + to_object.point_error(position, DoubleVector{zero, zero, zero}));
    world_normal = to_object.transposed_vector(local.normal);
  }
  const FloatVector position_error = add_float_rounding(position, error), rounded_position = round(position);
  const Doubles zero = Doubles::all(0);
  const FloatVector normal = round(
      direction_or(world_normal, {zero, zero, Doubles::all(1)}, Doubles::all(__DBL_MIN__), Doubles::all(__DBL_MAX__)));

  const Floats u = local.u.rounded(), v = local.v.rounded();
  FloatVector shading_normal = normal;
  if constexpr (has_normals) {
    const auto corner_normal = [&](int i) {
      return four.vectors([&](const PointRequest& request) { return request.corner_normals + 3 * i; });
    };
    FloatVector interpolated =
        corner_normal(0) * (Floats::all(1) - u - v) + corner_normal(1) * u + corner_normal(2) * v;
    if constexpr (!is_translation) interpolated = round(to_object.transposed_vector(widen(interpolated)));
    interpolated = direction_or(interpolated, normal, Floats::all(__FLT_MIN__), Floats::all(__FLT_MAX__));
    const FloatVector turned{-interpolated.x, -interpolated.y, -interpolated.z};
    shading_normal = select(dot(interpolated, normal) < Floats::all(0), turned, interpolated);
  }

  four.store(0, rounded_position.x, rounded_position.y, rounded_position.z, position_error.x);
  four.store(4, position_error.y, position_error.z, normal.x, normal.y);
  four.store(8, normal.z, shading_normal.x, shading_normal.y, shading_normal.z);
  four.store(12, u, v, local.t.rounded(), select(local.is_backfacing, Doubles::all(1), zero).rounded());
}

template <bool is_translation, bool has_normals>
void solve_all(const PointRequest* requests, PointResult* results, std::size_t count) {
  for (std::size_t first = 0; first < count; first += 4) {
    Four four;
    // The last few are done again rather than fewer.
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const std::size_t i = first + lane < count ? first + lane : count - 1;
      four.requests[lane] = &requests[i];
      four.results[lane] = &results[i];
    }
    solve_four<is_translation, has_normals>(four);
  }
}

inline void solve(PointKind kind, const PointRequest* requests, PointResult* results, std::size_t count) {
  if (kind.is_translation)
    kind.has_normals ? solve_all<true, true>(requests, results, count)
                     : solve_all<true, false>(requests, results, count);
  else
    kind.has_normals ? solve_all<false, true>(requests, results, count)
                     : solve_all<false, false>(requests, results, count);
}
