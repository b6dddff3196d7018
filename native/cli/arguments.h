// SPDX-License-Identifier: GPL-3.0-or-later
// What the command line says.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace basicrt {

inline constexpr const char* usage =
    "usage: renderer scene.json [-o out.exr] [--spp N] [--samples-from N] [--samples-to N]\n"
    "                [--threads N] [--tile-size N] [--override JSON] [-q]\n"
    "\n"
    "  -o, --output PATH   the picture, OpenEXR; otherwise the scene's name with .exr, in the current folder\n"
    "  --spp N             paths for each pixel, instead of the scene's\n"
    "  --samples-from N    leaves out the samples before this one, a multiple of 64, for another machine to render:\n"
    "  --samples-to N      and from this one on; \"basicrt merge\" makes one picture of such files\n"
    "  --threads N         otherwise one for each processor\n"
    "  --tile-size N       pixels along the side of a tile (64)\n"
    "  --override JSON     merged into the scene (RFC 7386), as in '{\"film\": {\"resolution\": [64, 64]}}'\n"
    "  -q, --quiet         no progress, no warnings\n"
    "  -h, --help          this text\n";

// Arguments that make no sense; what() says why.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Arguments {
  std::filesystem::path scene, output;
  std::optional<int> samples, samples_from, samples_to;
  int threads = 0, tile_size = 64;
  std::string override_json;
  bool is_quiet = false, wants_help = false;
};

// Throws UsageError.
[[nodiscard]] Arguments parse_arguments(int argc, char** argv);

}  // namespace basicrt
