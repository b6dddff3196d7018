// SPDX-License-Identifier: GPL-3.0-or-later
// Cells around random points (Worley 1996, "A cellular texture basis function").
#pragma once

#include <array>
#include <string_view>

#include "base/describe.h"
#include "shading/inputs.h"

namespace basicrt {

class Evaluator;

enum class VoronoiFeature : std::uint8_t { f1, f2, smooth_f1, distance_to_edge, n_sphere_radius };
template <>
inline constexpr std::array enum_names<VoronoiFeature> =
    std::to_array<std::string_view>({"f1", "f2", "smooth_f1", "distance_to_edge", "n_sphere_radius"});
enum class VoronoiMetric : std::uint8_t { euclidean, manhattan, chebychev, minkowski };
template <>
inline constexpr std::array enum_names<VoronoiMetric> =
    std::to_array<std::string_view>({"euclidean", "manhattan", "chebychev", "minkowski"});
enum class VoronoiOutput : std::uint8_t { distance, color, position, w };
template <>
inline constexpr std::array enum_names<VoronoiOutput> =
    std::to_array<std::string_view>({"distance", "color", "position", "w"});
enum class CellHash : std::uint8_t { pcg, lookup3 };
template <>
inline constexpr std::array enum_names<CellHash> = std::to_array<std::string_view>({"pcg", "lookup3"});

struct VoronoiOperation {
  VoronoiFeature feature = VoronoiFeature::f1;
  VoronoiMetric metric = VoronoiMetric::euclidean;
  VoronoiOutput output = VoronoiOutput::distance;
  CellHash hash = CellHash::pcg;
  int dimensions = 3;
  ColorInput vector{Vec3f(0.0f)};
  NumberInput w = 0.0f, scale = 5.0f, detail = 0.0f, roughness = 0.5f, lacunarity = 2.0f, smoothness = 1.0f,
              exponent = 0.5f, randomness = 1.0f;
  bool is_normalized = false;

  bool operator==(const VoronoiOperation&) const = default;
  static constexpr std::string_view kind = "voronoi";
  static constexpr auto fields() {
    using V = VoronoiOperation;
    return fields_of(field("feature", &V::feature, "f1, f2, smooth_f1, distance_to_edge or n_sphere_radius"),
                     field("metric", &V::metric, "euclidean, manhattan, chebychev or minkowski"),
                     field("output", &V::output, "distance (also the edge's, or the radius), color, position or w"),
                     field("hash", &V::hash, "where points are: pcg as from Blender 5.0 on, or lookup3 as before"),
                     field("dimensions", &V::dimensions, "of w alone, of the vector, or of both", within(1, 4)),
                     field("vector", &V::vector, "where"), field("w", &V::w, "of one and of four dimensions"),
                     field("scale", &V::scale, "multiplies both"), field("detail", &V::detail, "octaves, less one"),
                     field("roughness", &V::roughness, "an octave's share of the one before"),
                     field("lacunarity", &V::lacunarity, "an octave's frequency over that of the one before"),
                     field("smoothness", &V::smoothness, "of smooth_f1"),
                     field("exponent", &V::exponent, "of minkowski"),
                     field("randomness", &V::randomness, "0 is a grid"),
                     field("normalize", &V::is_normalized, "distances about within [0, 1]"));
  }
};

[[nodiscard]] Vec3f eval(const VoronoiOperation& node, const Evaluator& in);

}  // namespace basicrt
