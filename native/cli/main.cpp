// SPDX-License-Identifier: GPL-3.0-or-later
// The command line: renderer scene.json -o out.exr
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "base/error.h"
#include "io/exr.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/sample_range.h"
#include "io/scene_json.h"
#include "render/session.h"
#include "scene/mattes.h"

namespace basicrt {
namespace {

constexpr int exit_interrupted = 128 + SIGINT;

volatile std::sig_atomic_t is_interrupted = 0;

// On a terminal one line that is written over and over, else a single line at the end.
void show_progress(const Progress& progress, bool is_last) {
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  if (!is_terminal && !is_last) return;
  std::fprintf(stderr, "%s%5.1f %%  %.2f Msamples/s  %.1f s, %.1f s left%s", is_terminal ? "\r\033[K" : "",
               100 * progress.fraction, progress.samples_per_second * 1e-6, progress.elapsed_seconds,
               progress.remaining_seconds, is_last ? "\n" : "");
  std::fflush(stderr);
}

Image read_image(const std::filesystem::path& path) {
  return path.extension() == ".exr" ? read_exr(path) : read_image_file(path);
}

struct Loaded {
  PreparedScene scene;
  std::vector<std::pair<std::string, std::string>> metadata;
};

Loaded load(const Arguments& arguments) {
  Report report;
  Scene scene =
      load_scene(arguments.scene, report, {.override_json = arguments.override_json, .read_image = read_image});
  if (arguments.samples) scene.settings.samples = *arguments.samples;
  scene.settings.samples_from = arguments.samples_from.value_or(scene.settings.samples_from);
  scene.settings.samples_to = arguments.samples_to.value_or(scene.settings.samples_to);
  PreparedScene prepared =
      prepare_watched(scene, report, arguments.threads, [](double) { return is_interrupted == 0; });
  if (!arguments.is_quiet)
    for (const std::string& warning : report.warnings()) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  std::vector<std::pair<std::string, std::string>> metadata = matte_metadata(scene);
  if (scene.settings.has_sample_range()) metadata.emplace_back(range_metadata_key, range_metadata(scene));
  return {std::move(prepared), std::move(metadata)};
}

// The exit status.
int run(const Arguments& arguments) {
  check_writable(arguments.output);
  Loaded loaded = load(arguments);
  Session session(std::move(loaded.scene), {.threads = arguments.threads, .tile_size = arguments.tile_size});
  const RenderSettings& settings = session.scene().settings;
  Film film(settings.width, settings.height, settings.passes);
  while (!session.is_done() && !is_interrupted) {
    if (const auto tile = session.next_tile(std::chrono::milliseconds(100))) film.write(*tile);
    if (!arguments.is_quiet) show_progress(session.progress(), false);
  }
  session.stop();
  if (!arguments.is_quiet) show_progress(session.progress(), true);
  if (is_interrupted) throw Cancelled();
  std::vector<std::pair<std::string, std::string>> metadata = loaded.metadata;
  metadata.emplace_back("software", "BasicRT " BASICRT_VERSION);
  metadata.emplace_back("samples", std::to_string(settings.samples));
  write_exr(arguments.output, film, metadata);
  return 0;
}

}  // namespace
}  // namespace basicrt

int main(int argc, char** argv) {
  using namespace basicrt;
  std::signal(SIGINT, [](int) { is_interrupted = 1; });
  try {
    const Arguments arguments = parse_arguments(argc, argv);
    if (!arguments.wants_help) return run(arguments);
    std::fputs(usage, stdout);
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "renderer: %s\n%s", error.what(), usage);
    return 2;
  } catch (const Cancelled&) {
    std::fprintf(stderr, "renderer: interrupted, no picture is written\n");
    return exit_interrupted;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "renderer: there is not enough memory for this scene\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "renderer: %s\n", error.what());
  }
  return 1;
}
