// SPDX-License-Identifier: GPL-3.0-or-later
// Blender's Voronoi texture of one to four dimensions. Edges by Quilez 2012, "Voronoi edges"; smooth cells by his
// smooth minimum.
#include "shading/voronoi_operation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shading/evaluator.h"
#include "shading/lattice.h"

namespace basicrt {
namespace {

constexpr float far_away = std::numeric_limits<float>::max();

struct Settings {
  VoronoiFeature feature;
  VoronoiMetric metric;
  CellHash hash;
  float exponent, randomness, smoothness;
};

template <int N>
struct CellSample {
  float distance = 0;
  Color color{0.0f};
  Lattice<N> position{};
};

template <int N>
float size(const Lattice<N>& a) {
  return N == 1 ? std::abs(a[0]) : std::sqrt(inner<N>(a, a));
}

template <int N>
float distance(const Lattice<N>& a, const Lattice<N>& b, const Settings& settings) {
  const Lattice<N> between = minus<N>(a, b);
  if (N == 1 || settings.metric == VoronoiMetric::euclidean) return size<N>(between);
  float sum = 0, largest = 0, powers = 0;
  for (const float number : between) {
    sum += std::abs(number);
    largest = std::max(largest, std::abs(number));
    if (settings.metric == VoronoiMetric::minkowski) powers += std::pow(std::abs(number), settings.exponent);
  }
  switch (settings.metric) {
    case VoronoiMetric::manhattan:
      return sum;
    case VoronoiMetric::chebychev:
      return largest;
    default:
      return std::pow(powers, 1 / settings.exponent);
  }
}

// The cell that a point is in.
template <int N>
struct Cell {
  Lattice<N> corner, local;  // the point is corner + local
  float randomness;
  CellHash hash;

  Cell(const Lattice<N>& p, const Settings& settings) : randomness(settings.randomness), hash(settings.hash) {
    for (int i = 0; i < N; ++i) corner[i] = std::floor(p[i]), local[i] = p[i] - corner[i];
  }
  // Of the cell at that offset, from this one's corner.
  [[nodiscard]] Lattice<N> feature_point(const Lattice<N>& offset) const {
    const Lattice<N> point = hash == CellHash::pcg ? hash_cell(corner, offset) : hash_to_point(corner + offset);
    return offset + scaled<N>(point, randomness);
  }
  [[nodiscard]] Color color(const Lattice<N>& offset) const {
    return hash == CellHash::pcg ? hash_cell_to_color(corner, offset) : hash_to_color(corner + offset);
  }
};

// The nearest point, or the second nearest.
template <int N>
CellSample<N> nearest(const Lattice<N>& p, const Settings& settings) {
  const Cell<N> cell(p, settings);
  struct Found {
    float distance = far_away;
    Lattice<N> offset{}, point{};
  } first, second;
  for_each_cell<N>(1, [&](const Lattice<N>& offset) {
    const Lattice<N> point = cell.feature_point(offset);
    const float away = distance<N>(point, cell.local, settings);
    if (away < first.distance) {
      second = first;
      first = {away, offset, point};
    } else if (away < second.distance) {
      second = {away, offset, point};
    }
  });
  const Found& found = settings.feature == VoronoiFeature::f2 ? second : first;
  return {found.distance, cell.color(found.offset), cell.corner + found.point};
}

template <int N>
CellSample<N> nearest_smoothly(const Lattice<N>& p, const Settings& settings) {
  const Cell<N> cell(p, settings);
  const float width = settings.smoothness;
  CellSample<N> sum;
  bool is_first = true;
  for_each_cell<N>(2, [&](const Lattice<N>& offset) {
    const Lattice<N> point = cell.feature_point(offset);
    const float away = distance<N>(point, cell.local, settings);
    const float t = std::clamp(0.5f + 0.5f * (sum.distance - away) / width, 0.0f, 1.0f);
    const float share = is_first ? 1 : t * t * (3 - 2 * t);
    is_first = false;
    float correction = width * share * (1 - share);
    sum.distance = lerp(sum.distance, away, share) - correction;
    correction /= 1 + 3 * width;
    sum.color = lerp(sum.color, cell.color(offset), share) - Color(correction);
    for (int i = 0; i < N; ++i) sum.position[i] = lerp(sum.position[i], point[i], share) - correction;
  });
  sum.position = cell.corner + sum.position;
  return sum;
}

template <int N>
float distance_to_edge(const Lattice<N>& p, const Settings& settings) {
  const Cell<N> cell(p, settings);
  if constexpr (N == 1) {
    const float own = hash_to_unit(cell.corner[0]) * cell.randomness;  // with the sign of a zero
    const auto edge = [&](float neighbour) {
      return std::abs((own + cell.feature_point(Lattice<1>{neighbour})[0]) / 2 - cell.local[0]);
    };
    return std::min(edge(-1), edge(1));
  }
  Lattice<N> closest{};
  float least = far_away;
  const auto to_point = [&](const Lattice<N>& offset) { return minus<N>(cell.feature_point(offset), cell.local); };
  for_each_cell<N>(1, [&](const Lattice<N>& offset) {
    const Lattice<N> towards = to_point(offset);
    if (const float away = inner<N>(towards, towards); away < least) least = away, closest = towards;
  });
  least = far_away;
  for_each_cell<N>(1, [&](const Lattice<N>& offset) {
    const Lattice<N> towards = to_point(offset), across = minus<N>(towards, closest);
    if (inner<N>(across, across) > 0.0001f)
      least = std::min(least, inner<N>(closest + towards, across) / (2 * size<N>(across)));
  });
  return least;
}

// Half the distance from the nearest point to the one that is nearest to that.
template <int N>
float sphere_radius(const Lattice<N>& p, const Settings& settings) {
  const Cell<N> cell(p, settings);
  Lattice<N> closest{}, closest_offset{};
  float least = far_away;
  for_each_cell<N>(1, [&](const Lattice<N>& offset) {
    const Lattice<N> point = cell.feature_point(offset);
    if (const float away = size<N>(minus<N>(point, cell.local)); away < least)
      least = away, closest = point, closest_offset = offset;
  });
  least = far_away;
  for_each_cell<N>(1, [&](const Lattice<N>& offset) {
    if (inner<N>(offset, offset) == 0) return;
    least = std::min(least, size<N>(minus<N>(closest, cell.feature_point(offset + closest_offset))));
  });
  return least / 2;
}

// Octaves of cells, each weighted by the roughness.
struct Layers {
  float detail, roughness, lacunarity;
  bool is_normalized;
  float largest_distance;

  [[nodiscard]] bool is_single() const { return detail == 0 || roughness == 0; }
  [[nodiscard]] int count() const { return static_cast<int>(std::ceil(detail)); }
  // The share of octave i, which the last may have only in part.
  [[nodiscard]] float share(int i) const { return static_cast<float>(i) <= detail ? 1 : detail - std::floor(detail); }
};

template <int N>
CellSample<N> layered_cells(const Lattice<N>& p, const Settings& settings, const Layers& layers) {
  const auto octave = [&](const Lattice<N>& place) {
    const bool is_smooth = settings.feature == VoronoiFeature::smooth_f1 && settings.smoothness > 0;
    return is_smooth ? nearest_smoothly<N>(place, settings) : nearest<N>(place, settings);
  };
  CellSample<N> sum;
  float amplitude = 1, most = 0, scale = 1;
  if (layers.is_single()) sum = octave(p), most = 1;
  for (int i = 0; !layers.is_single() && i <= layers.count(); ++i) {
    const CellSample<N> cells = octave(scaled<N>(p, scale));
    const float share = layers.share(i) * amplitude;
    most += share;
    sum.distance += cells.distance * share;
    sum.color += cells.color * share;
    for (int k = 0; k < N; ++k) sum.position[k] = lerp(sum.position[k], cells.position[k] / scale, share);
    scale *= layers.lacunarity;
    amplitude *= layers.roughness;
  }
  if (layers.is_normalized) {
    sum.distance /= most * layers.largest_distance;
    sum.color = sum.color / most;
  }
  return sum;
}

template <int N>
float layered_edges(const Lattice<N>& p, const Settings& settings, const Layers& layers) {
  float amplitude = 1, most = layers.largest_distance, scale = 1, result = 8;
  if (layers.is_single()) result = distance_to_edge<N>(p, settings);
  for (int i = 0; !layers.is_single() && i <= layers.count(); ++i) {
    const float away = distance_to_edge<N>(scaled<N>(p, scale), settings), share = layers.share(i) * amplitude;
    most = lerp(most, layers.largest_distance / scale, share);
    result = lerp(result, std::min(result, away / scale), share);
    scale *= layers.lacunarity;
    amplitude *= layers.roughness;
  }
  return layers.is_normalized ? result / most : result;
}

template <int N>
Vec3f output_of(const CellSample<N>& cells, VoronoiOutput output, float scale) {
  const auto position = [&](int i) { return scale != 0 ? cells.position[i] / scale : 0; };
  switch (output) {
    case VoronoiOutput::color:
      return cells.color;
    case VoronoiOutput::position:
      if constexpr (N == 1) return Vec3f(0.0f);
      return {position(0), position(std::min(1, N - 1)), N > 2 ? position(std::min(2, N - 1)) : 0};
    case VoronoiOutput::w:
      return Vec3f(N == 1 || N == 4 ? position(N - 1) : 0);
    default:
      return Vec3f(cells.distance);
  }
}

}  // namespace

Vec3f eval(const VoronoiOperation& node, const Evaluator& in) {
  const auto unit = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
  const float scale = in(node.scale), randomness = unit(in(node.randomness));
  const Settings settings{node.feature,      node.metric, node.hash,
                          in(node.exponent), randomness,  std::clamp(in(node.smoothness) / 2, 0.0f, 0.5f)};
  Layers layers{std::clamp(in(node.detail), 0.0f, 15.0f), unit(in(node.roughness)), in(node.lacunarity),
                node.is_normalized, 0};
  return with_dimensions(node.dimensions, [&]<int N>(std::integral_constant<int, N>) {
    const Lattice<N> p = lattice_point<N>(in(node.vector) * scale, in(node.w) * scale);
    if (node.feature == VoronoiFeature::n_sphere_radius) return Vec3f(sphere_radius<N>(p, settings));
    const float half = 0.5f + 0.5f * randomness;
    if (node.feature == VoronoiFeature::distance_to_edge) {
      layers.largest_distance = half;
      return Vec3f(layered_edges<N>(p, settings, layers));
    }
    Lattice<N> corner;
    for (float& number : corner) number = half;
    layers.largest_distance =
        distance<N>(Lattice<N>{}, corner, settings) * (node.feature == VoronoiFeature::f2 ? 2.0f : 1.0f);
    return output_of<N>(layered_cells<N>(p, settings, layers), node.output, scale);
  });
}

}  // namespace basicrt
