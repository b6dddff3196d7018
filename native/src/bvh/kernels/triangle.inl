// SPDX-License-Identifier: GPL-3.0-or-later
// A ray against four triangles, watertight: of two triangles that share an edge at least one is hit by any ray that passes between them (Woop,
// Benthin and Wald 2013, "Watertight Ray/Triangle Intersection").

struct TriangleHits {
  Float4 t, u, v;
  Mask4 is_hit;  // within [t_min, t_max]
};

// The corners relative to the ray's origin, sheared so that the ray runs along the last axis.
struct ShearedCorners {
  Float4 x[3], y[3], z[3];
};

inline ShearedCorners shear(const TriangleBlock& block, const TriangleSpace& space) {
  ShearedCorners corners;
  for (int i = 0; i < 3; ++i) {
    const float* corner = &block.corners[i][0][0];
    corners.z[i] = Float4::load(corner + space.axes.offsets[2]) - Float4::all(space.origin[2]);
    corners.x[i] = (Float4::load(corner + space.axes.offsets[0]) - Float4::all(space.origin[0])) -
                   Float4::all(space.shear[0]) * corners.z[i];
    corners.y[i] = (Float4::load(corner + space.axes.offsets[1]) - Float4::all(space.origin[1])) -
                   Float4::all(space.shear[1]) * corners.z[i];
  }
  return corners;
}

// Triangles that move, at a ray's time: number for number as interpolate() in geometry/motion.h.
inline TriangleBlock block_at_time(const MovingTriangleBlock& block, const KernelInstance& instance, float time) {
  const Float4 fraction = Float4::all(key_interval(instance.interval_count, time).fraction);
  TriangleBlock result;
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      const Float4 start = Float4::load(block.corners[0][corner][axis]);
      const Float4 end = Float4::load(block.corners[1][corner][axis]);
      (start + (end - start) * fraction).store(result.corners[corner][axis]);
    }
  __builtin_memcpy(result.primitives, block.primitives, sizeof result.primitives);
  return result;
}

// Which side of the three edges the ray passes, as areas that weigh the opposite corners.
struct EdgeWeights {
  Float4 w[3];
};

inline EdgeWeights edge_weights(const ShearedCorners& corners) {
  const auto& [x, y, z] = corners;
  return {{x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]}};
}

// Below this an edge weight may have lost bits to underflow, or its sign to rounding: zero.
constexpr float smallest_weight = 0x1p-100f;

struct InsideHits {
  Float4 t, u, v;
  Mask4 is_inside;
};

inline InsideHits inside_hits(const ShearedCorners& corners, const EdgeWeights& weights, const TriangleSpace& space) {
  const auto& w = weights.w;
  const Float4 zero = Float4::all(0);
  const Float4 least = min(min(w[0], w[1]), w[2]), most = max(max(w[0], w[1]), w[2]);
  const Float4 inverse = Float4::all(1) / (w[0] + w[1] + w[2]);
  const Float4 depth = w[0] * corners.z[0] + w[1] * corners.z[1] + w[2] * corners.z[2];
  return {.t = depth * Float4::all(space.shear[2]) * inverse,
          .u = w[1] * inverse,
          .v = w[2] * inverse,
          .is_inside = (zero <= least) | (most <= zero)};
}

// What rare cases write, in memory: structures of vectors that come out of a call or a branch are copied at great cost.
struct LanesInMemory {
  alignas(16) float t[4], u[4], v[4], is_hit[4];  // is_hit: 0 or 1
};

// The same where single precision can't tell: products of two floats are exact in double precision.
[[gnu::noinline]] inline void find_inside_hits_in_double(const TriangleBlock& block, const TriangleSpace& space,
                                                         LanesInMemory& result) {
  const ShearedCorners corners = shear(block, space);
  alignas(16) float x[3][4], y[3][4], z[3][4];
  for (int i = 0; i < 3; ++i) {
    corners.x[i].store(x[i]);
    corners.y[i].store(y[i]);
    corners.z[i].store(z[i]);
  }
  for (int lane = 0; lane < 4; ++lane) {
    const auto cross = [&](int i, int j) {
      return static_cast<double>(x[i][lane]) * y[j][lane] - static_cast<double>(y[i][lane]) * x[j][lane];
    };
    const double w0 = cross(2, 1), w1 = cross(0, 2), w2 = cross(1, 0), sum = w0 + w1 + w2;
    const bool is_inside = ((w0 >= 0 && w1 >= 0 && w2 >= 0) || (w0 <= 0 && w1 <= 0 && w2 <= 0)) && sum != 0;
    const double inverse = is_inside ? 1 / sum : 0;
    const double depth = w0 * z[0][lane] + w1 * z[1][lane] + w2 * z[2][lane];
    result.t[lane] = static_cast<float>(depth * space.shear[2] * inverse);
    result.u[lane] = static_cast<float>(w1 * inverse);
    result.v[lane] = static_cast<float>(w2 * inverse);
    result.is_hit[lane] = is_inside;
  }
}

// Solves the lanes that are near in double precision, by the ray as it was given.
[[gnu::noinline]] inline void confirm_near(unsigned near, const TriangleBlock& block, const TriangleSpace& space,
                                           const KernelScene& scene, const KernelRay& ray, float t_max,
                                           LanesInMemory& result) {
  for (unsigned lane = 0; lane < 4; ++lane) {
    result.is_hit[lane] = 1;
    if (!(near >> lane & 1)) continue;
    float corners[3][3];
    for (int i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis) corners[i][axis] = block.corners[i][axis][lane];
    const double distance = scene.plane_distance(scene.instances[space.instance], ray, corners);
    result.t[lane] = static_cast<float>(distance);
    result.is_hit[lane] = distance >= ray.t_min && distance >= 0 && distance <= t_max;
  }
}

inline TriangleHits intersect_block(const TriangleBlock& block, const TriangleSpace& space, float begin, float t_max,
                                    const KernelScene& scene, const KernelRay& ray) {
  const ShearedCorners corners = shear(block, space);
  const EdgeWeights weights = edge_weights(corners);
  InsideHits inside = inside_hits(corners, weights, space);
  const Float4 least = min(min(abs(weights.w[0]), abs(weights.w[1])), abs(weights.w[2]));
  const Mask4 is_unclear = least <= Float4::all(smallest_weight);
  if (__builtin_expect(is_unclear.bits() != 0, 0)) {
    LanesInMemory solved;
    find_inside_hits_in_double(block, space, solved);
    inside.t = select(is_unclear, Float4::load(solved.t), inside.t);
    inside.u = select(is_unclear, Float4::load(solved.u), inside.u);
    inside.v = select(is_unclear, Float4::load(solved.v), inside.v);
    inside.is_inside =
        without(inside.is_inside, is_unclear) | (is_unclear & (Float4::load(solved.is_hit) == Float4::all(1)));
  }

  // A NaN is no hit.
  Mask4 is_hit = without(inside.is_inside & (inside.t <= Float4::all(t_max)) & (Float4::all(begin) <= inside.t),
                         equal(block.primitives, space.skipped_primitive));
  const unsigned is_near = (is_hit & (inside.t <= Float4::all(space.near_end))).bits();
  if (__builtin_expect(is_near != 0, 0)) {
    LanesInMemory solved;
    inside.t.store(solved.t);
    confirm_near(is_near, block, space, scene, ray, t_max, solved);
    inside.t = Float4::load(solved.t);
    is_hit = is_hit & (Float4::load(solved.is_hit) == Float4::all(1));
  }
  return {inside.t, inside.u, inside.v, is_hit};
}
