// SPDX-License-Identifier: GPL-3.0-or-later
// Rays per second of the tracer beside Embree, where that is installed: the same rays in the same process, in turns. The
// options are in `usage`.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel_for.h"
#include "base/worker_pool.h"
#include "bvh/kernels/chosen_kernel.h"
#include "bvh/tracer.h"
#include "ray_sets.h"
#include "report.h"
#include "scenes.h"

#if defined(BASICRT_WITH_EMBREE)
#include "embree.h"
#endif

namespace {

using namespace basicrt;
using namespace basicrt::benchmark;

constexpr const char* usage =
    R"(rays [options] [FILE.obj...]   the scenes that the program makes itself, and those of the files
  --scenes NAME,...  only these (files are always traced): cornell, terrain, soup, overlap, hall, hair, instances
  --rays NAME,...    only these: primary, shadow, tile (diffuse, in tile order), shuffled (diffuse)
  --size full|small  of the scenes
  --side N           pixels along a side of the picture, rounded up to a power of two; 512
  --runs N           medians of so many; 5
  --threads N        1, timed by the processor's clock; 0 for one on each processor. Several are timed by the wall's, and
                     compared with one
  --call N           rays in one call of the tracer; 512, as in renders
  --kernel NAME      avx512, avx2, sse42 or scalar instead of the machine's best
)";

struct Options {
  std::vector<std::string> scenes, rays;  // empty: all
  std::string kernel;
  bool is_small = false;
  int side = 512, runs = 5, threads = 1;
  std::size_t call = 512;
  std::vector<std::string> files;
};

std::vector<std::string> split(const std::string& text) {
  std::istringstream words(text);
  std::vector<std::string> result;
  for (std::string word; std::getline(words, word, ',');) result.push_back(word);
  return result;
}

bool is_wanted(const std::vector<std::string>& list, const std::string& name) {
  return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
}

Options parse(int argc, char** argv) {
  Options options;
  const auto number = [](const std::string& text, int least) { return std::max(least, std::atoi(text.c_str())); };
  const std::map<std::string_view, std::function<void(const std::string&)>> setters{
      {"--scenes", [&](const std::string& value) { options.scenes = split(value); }},
      {"--rays", [&](const std::string& value) { options.rays = split(value); }},
      {"--kernel", [&](const std::string& value) { options.kernel = value; }},
      {"--size", [&](const std::string& value) { options.is_small = value == "small"; }},
      {"--side", [&](const std::string& value) { options.side = number(value, 16); }},
      {"--runs", [&](const std::string& value) { options.runs = number(value, 1); }},
      {"--threads", [&](const std::string& value) { options.threads = resolve_thread_count(number(value, 0)); }},
      {"--call", [&](const std::string& value) { options.call = static_cast<std::size_t>(number(value, 1)); }}};
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto setter = setters.find(word);
    if (setter != setters.end() && i + 1 < argc)
      setter->second(argv[++i]);
    else if (word.starts_with("-"))
      throw std::runtime_error(usage);
    else
      options.files.push_back(word);
  }
  options.side = static_cast<int>(std::bit_ceil(static_cast<unsigned>(options.side)));
  return options;
}

// What is measured on one set of rays: it gets ready untimed, and traces any part of the rays on any thread.
struct Tracing {
  std::function<void()> prepare;
  std::function<void(std::size_t begin, std::size_t end)> trace;
  WorkerPool* pool;
  std::vector<double> rates;  // rays per second
};

void measure(Tracing& tracing, std::size_t ray_count) {
  constexpr std::size_t chunk_size = 4096;
  if (tracing.prepare) tracing.prepare();
  const double begin = now(tracing.pool->thread_count());
  tracing.pool->for_each((ray_count + chunk_size - 1) / chunk_size, [&](std::size_t chunk) {
    tracing.trace(chunk * chunk_size, std::min(ray_count, (chunk + 1) * chunk_size));
  });
  tracing.rates.push_back(static_cast<double>(ray_count) / (now(tracing.pool->thread_count()) - begin));
}

double median_ratio(const Tracing& a, const Tracing& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.rates.size(); ++i) ratios.push_back(a.rates[i] / b.rates[i]);
  return median(ratios);
}

// The table: a line for each kind of rays and figure, a column for each scene.
class Table {
 public:
  void add_scene(const std::string& name) { scenes_.push_back(name); }
  void add(const std::string& rays, const std::string& figure, double value) {
    for (Line& line : lines_)
      if (line.rays == rays && line.figure == figure) return line.values.push_back(value);
    lines_.push_back({rays, figure, {value}});
  }
  void print() const {
    std::printf("| rays | figure |");
    for (const std::string& scene : scenes_) std::printf(" %s |", scene.c_str());
    std::printf(" geometric mean |\n|---|---|");
    for (std::size_t i = 0; i <= scenes_.size(); ++i) std::printf("---|");
    for (const Line& line : lines_) {
      std::printf("\n| %s | %s |", line.rays.c_str(), line.figure.c_str());
      for (const double value : line.values) std::printf(" %.2f |", value);
      std::printf(" %.2f |", geometric_mean(line.values));
    }
    std::printf("\n");
  }

 private:
  struct Line {
    std::string rays, figure;
    std::vector<double> values;
  };
  std::vector<std::string> scenes_;
  std::vector<Line> lines_;
};

class SceneBenchmark {
 public:
  SceneBenchmark(BenchmarkScene scene, const Options& options, Table& table)
      : options_(options), table_(table), one_thread_(1), threads_(options.threads), scene_(std::move(scene)) {
    std::vector<ShapeTree> trees;
    for (const Shape& shape : scene_.shapes) trees.push_back(build_shape_tree(shape, {}));
    tracer_ = Tracer(std::move(trees), scene_.instances, {});
    tracer_.use(*find_kernel(options.kernel.empty() ? chosen_kernel().name : options.kernel));
    table_.add_scene(scene_.name);
  }

  void run() {
#if defined(BASICRT_WITH_EMBREE)
    build_embree();
#endif
    for (const RaySet& set : make_ray_sets(scene_, tracer_, options_.side)) {
      const auto last_word = set.name.substr(set.name.rfind(' ') + 1);
      if (is_wanted(options_.rays, last_word == "order" ? "tile" : last_word)) run(set);
    }
  }

 private:
  void run(const RaySet& set) {
    const std::size_t count = set.rays.size();
    hits_.resize(count);
    is_occluded_.resize(count);
    Tracing calls{.prepare = {}, .trace = trace_in_calls(set, options_.call), .pool = &threads_, .rates = {}};
    Tracing alone{.prepare = {}, .trace = trace_in_calls(set, 1), .pool = &threads_, .rates = {}};
    std::vector<Tracing*> all{&calls, &alone};
    std::optional<Tracing> on_one_thread;
    if (options_.threads > 1) {
      on_one_thread = calls;
      on_one_thread->pool = &one_thread_;
      all.push_back(&*on_one_thread);
    }
#if defined(BASICRT_WITH_EMBREE)
    const EmbreeQuery query{.is_any = set.is_any, .is_coherent = false};
    const EmbreeQuery packet_query{.is_any = set.is_any, .is_coherent = true};
    EmbreeRays rays;
    EmbreePackets packets;
    Tracing embree{
        .prepare = [&] { rays.set(set.rays); },
        .trace = [&](std::size_t begin, std::size_t end) { rays.trace(embree_scenes_.back(), query, begin, end); },
        .pool = &threads_,
        .rates = {}};
    Tracing embree_packets{
        .prepare = [&] { packets.set(set.rays); },
        .trace = [&](std::size_t begin,
                     std::size_t end) { packets.trace(embree_scenes_.back(), packet_query, begin, end); },
        .pool = &threads_,
        .rates = {}};
    all.push_back(&embree);
    if (set.goes_together) all.push_back(&embree_packets);
#endif
    for (int i = 0; i < options_.runs; ++i)
      for (Tracing* tracing : all) measure(*tracing, count);

    table_.add(set.name, "million/s", median(calls.rates) / 1e6);
    if (on_one_thread)
      table_.add(set.name, "of linear in threads", median_ratio(calls, *on_one_thread) / options_.threads);
#if defined(BASICRT_WITH_EMBREE)
    table_.add(set.name, "over Embree", median_ratio(calls, embree));
    if (set.goes_together) table_.add(set.name, "over its packets", median_ratio(calls, embree_packets));
    table_.add(set.name, "one ray at a time, over Embree", median_ratio(alone, embree));
    report_differences(set, [&](std::size_t i) { return rays.distance(i, query); });
#else
    table_.add(set.name, "one ray at a time, million/s", median(alone.rates) / 1e6);
#endif
  }

  // Calls the tracer for `size` rays at a time.
  std::function<void(std::size_t, std::size_t)> trace_in_calls(const RaySet& set, std::size_t size) {
    return [this, &set, size](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; i += size) {
        const std::size_t count = std::min(size, end - i);
        const auto rays = std::span(set.rays).subspan(i, count);
        if (set.is_any)
          tracer_.occluded(rays, std::span(is_occluded_).subspan(i, count));
        else
          tracer_.intersect(rays, std::span(hits_).subspan(i, count));
      }
    };
  }

#if defined(BASICRT_WITH_EMBREE)
  void build_embree() {
    device_.emplace(options_.threads);
    for (Shape& shape : scene_.shapes) {
      Mesh& mesh = std::get<Mesh>(shape);
      mesh.positions.reserve(mesh.positions.size() + 1);
      embree_scenes_.emplace_back(*device_).add(mesh);
      embree_scenes_.back().build();
    }
    if (scene_.instances.size() == 1 && scene_.instances[0].object_to_world == TransformD{}) return;
    EmbreeScene top(*device_);
    for (const TracedInstance& instance : scene_.instances)
      top.add_instance(embree_scenes_[instance.shape], instance.object_to_world);
    top.build();
    embree_scenes_.push_back(std::move(top));
  }

  // Both should see the same: this says on how many rays they don't.
  void report_differences(const RaySet& set, const std::function<float(std::size_t)>& embree_distance) const {
    std::size_t misses = 0, distances = 0;
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
      const float other = embree_distance(i);
      const bool is_hit = set.is_any ? is_occluded_[i] != 0 : hits_[i].is_hit();
      if (is_hit != (set.is_any ? other < 0 : other < infinity))
        ++misses;
      else if (!set.is_any && is_hit)
        distances += std::abs(hits_[i].t - other) > 1e-4f * other;
    }
    std::fprintf(stderr, "%s, %s: of %zu rays %zu hit with one and miss with the other, %zu differ in distance\n",
                 scene_.name.c_str(), set.name.c_str(), set.rays.size(), misses, distances);
  }

  std::optional<EmbreeDevice> device_;
  std::vector<EmbreeScene> embree_scenes_;  // the last is to be traced, the others are in it
#endif

  const Options& options_;
  Table& table_;
  WorkerPool one_thread_, threads_;
  BenchmarkScene scene_;
  Tracer tracer_;
  std::vector<Hit> hits_;
  std::vector<std::uint8_t> is_occluded_;
};

void run(const Options& options) {
  const std::string kernel = options.kernel.empty() ? chosen_kernel().name : options.kernel;
  if (find_kernel(kernel) == nullptr) throw std::runtime_error("--kernel: this machine has no '" + kernel + "'\n");
  std::printf("%s, commit %s, compiler %s, kernel %s, %d threads, %zu rays a call, medians of %d runs, ",
              machine().c_str(), commit().c_str(), __VERSION__, kernel.c_str(), options.threads, options.call,
              options.runs);
#if defined(BASICRT_WITH_EMBREE)
  std::printf("beside Embree %s robust\n\n", RTC_VERSION_STRING);
#else
  std::printf("without Embree, which was not found\n\n");
#endif
  Table table;
  for (const SceneMaker& maker : scene_makers(options.is_small))
    if (is_wanted(options.scenes, maker.name)) SceneBenchmark(maker.make(), options, table).run();
  for (const std::string& file : options.files) SceneBenchmark(read_obj_scene(file), options, table).run();
  table.print();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse(argc, argv));
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 2;
  }
  return 0;
}
