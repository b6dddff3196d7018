// SPDX-License-Identifier: GPL-3.0-or-later
// Rays per second and build times on three meshes that the program makes itself.
//
// rays [--size small|full] [--runs N]      one thread; medians of N interleaved runs
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "bvh/tracer.h"
#include "geometry/surface_point.h"
#include "math/frame.h"
#include "math/warp.h"
#include "meshes.h"

namespace {

using namespace basicrt;
using namespace basicrt::benchmark;
using Clock = std::chrono::steady_clock;

std::vector<Ray> make_primary_rays(int side) {
  std::vector<Ray> rays;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Vec3f target{(2.0f * static_cast<float>(x) + 1) / static_cast<float>(side) - 1,
                         (2.0f * static_cast<float>(y) + 1) / static_cast<float>(side) - 1, 0};
      const Vec3f origin{0.1f, 0.6f, 2.8f};
      rays.push_back({.origin = origin, .direction = normalize(target * 0.8f - origin)});
    }
  return rays;
}

struct SecondaryRays {
  std::vector<Ray> shadow, diffuse;
};

// From where the primary rays hit: towards a light above, and in cosine-distributed directions.
SecondaryRays make_secondary_rays(const Shape& shape, std::span<const Ray> primary, std::span<const Hit> hits) {
  SecondaryRays rays;
  std::mt19937 rng(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (std::size_t i = 0; i < primary.size(); ++i) {
    if (!hits[i].is_hit()) continue;
    const SurfacePoint point = make_surface_point(shape, {}, primary[i], hits[i]);
    const Vec3f normal = point.is_backfacing ? -point.geometric_normal : point.geometric_normal;
    const Vec3f to_light = Vec3f{0.3f, 0.9f, 0.2f} - point.position;
    const float distance = length(to_light);
    rays.shadow.push_back(
        {.origin = offset_origin(point, to_light), .direction = to_light / distance, .t_max = distance});
    const Vec3f bounce = make_frame(normal).to_world(sample_cosine_hemisphere({uniform(rng), uniform(rng)}));
    rays.diffuse.push_back({.origin = offset_origin(point, bounce), .direction = bounce});
  }
  return rays;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

template <class Work>
double seconds(Work&& work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void run(const std::string& name, Mesh mesh, int runs, int side) {
  const double triangles = static_cast<double>(mesh.triangles.size());
  const Shape shape = std::move(mesh);

  std::map<BvhBuilder, std::vector<double>> builds;
  for (int i = 0; i < runs; ++i)
    for (const BvhBuilder builder : {BvhBuilder::median, BvhBuilder::binned_sah})
      builds[builder].push_back(seconds([&] { (void)build_shape_tree(shape, {.builder = builder}); }));

  const BvhConfig config;
  std::vector<ShapeTree> trees;
  trees.push_back(build_shape_tree(shape, config));
  const Tracer tracer(std::move(trees), {TracedInstance{}}, config);

  const std::vector<Ray> primary = make_primary_rays(side);
  std::vector<Hit> hits(primary.size());
  tracer.intersect(primary, hits);
  const SecondaryRays secondary = make_secondary_rays(shape, primary, hits);

  const auto closest = [&](const std::vector<Ray>& rays) {
    return static_cast<double>(rays.size()) /
           seconds([&] { tracer.intersect(rays, std::span(hits).first(rays.size())); });
  };
  std::vector<std::uint8_t> results(primary.size());
  const auto any = [&](const std::vector<Ray>& rays) {
    return static_cast<double>(rays.size()) /
           seconds([&] { tracer.occluded(rays, std::span(results).first(rays.size())); });
  };
  std::vector<double> rates[3];
  for (int i = 0; i < runs; ++i) {
    rates[0].push_back(closest(primary));
    rates[1].push_back(any(secondary.shadow));
    rates[2].push_back(closest(secondary.diffuse));
  }
  std::printf("| %s | %.0f | %.3f | %.3f | %.2f | %.2f | %.2f |\n", name.c_str(), triangles / 1000,
              median(builds[BvhBuilder::median]), median(builds[BvhBuilder::binned_sah]), median(rates[0]) / 1e6,
              median(rates[1]) / 1e6, median(rates[2]) / 1e6);
}

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

}  // namespace

int main(int argc, char** argv) {
  bool is_small = false;
  int runs = 5;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--size") is_small = argv[i + 1] == std::string_view("small");
    if (option == "--runs") runs = std::max(1, std::atoi(argv[i + 1]));
  }
  std::printf("%s, compiler %s, one thread, medians of %d runs\n\n", machine().c_str(), __VERSION__, runs);
  std::printf(
      "| mesh | thousand triangles | build, median split (s) | build, SAH (s) | primary (M/s) | shadow (M/s) "
      "| diffuse (M/s) |\n|---|---|---|---|---|---|---|\n");
  const int side = is_small ? 128 : 512;
  run("Cornell box with a sphere", make_cornell(is_small ? 32 : 380), runs, side);
  run("terrain", make_terrain(is_small ? 64 : 707), runs, side);
  run("soup", make_soup(is_small ? 10000 : 1000000), runs, side);
  return 0;
}
