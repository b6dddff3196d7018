// SPDX-License-Identifier: GPL-3.0-or-later
// Options by the C library's getopt_long.
#include "arguments.h"

#include <getopt.h>

#include <charconv>
#include <string_view>

namespace basicrt {
namespace {

int parse_count(const char* option, std::string_view text, int maximum, int minimum = 1) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < minimum || count > maximum)
    throw UsageError(std::string(option) + " needs a whole number from " + std::to_string(minimum) + " to " +
                     std::to_string(maximum) + ", not \"" + std::string(text) + "\"");
  return count;
}

}  // namespace

Arguments parse_arguments(int argc, char** argv) {
  enum LongOption { spp = 256, samples_from, samples_to, threads, tile_size, override_json };
  const option options[] = {{"output", required_argument, nullptr, 'o'},
                            {"quiet", no_argument, nullptr, 'q'},
                            {"help", no_argument, nullptr, 'h'},
                            {"spp", required_argument, nullptr, spp},
                            {"samples-from", required_argument, nullptr, samples_from},
                            {"samples-to", required_argument, nullptr, samples_to},
                            {"threads", required_argument, nullptr, threads},
                            {"tile-size", required_argument, nullptr, tile_size},
                            {"override", required_argument, nullptr, override_json},
                            {}};
  Arguments arguments;
  opterr = 0;  // we say it ourselves
  for (int key; (key = getopt_long(argc, argv, ":o:qh", options, nullptr)) != -1;) {
    switch (key) {
      case 'o':
        arguments.output = optarg;
        break;
      case 'q':
        arguments.is_quiet = true;
        break;
      case 'h':
        arguments.wants_help = true;
        break;
      case spp:
        arguments.samples = parse_count("--spp", optarg, 1 << 24);
        break;
      case samples_from:
        arguments.samples_from = parse_count("--samples-from", optarg, 1 << 24, 0);
        break;
      case samples_to:
        arguments.samples_to = parse_count("--samples-to", optarg, 1 << 24);
        break;
      case threads:
        arguments.threads = parse_count("--threads", optarg, 1024);
        break;
      case tile_size:
        arguments.tile_size = parse_count("--tile-size", optarg, 65536);
        break;
      case override_json:
        arguments.override_json = optarg;
        break;
      case ':':
        throw UsageError(std::string(argv[optind - 1]) + " needs a value");
      default:
        throw UsageError(std::string("unknown option ") + argv[optind - 1]);
    }
  }
  if (arguments.wants_help) return arguments;
  if (optind + 1 != argc) throw UsageError(optind == argc ? "no scene is named" : "more than one scene is named");
  arguments.scene = argv[optind];
  if (arguments.output.empty()) arguments.output = arguments.scene.stem().concat(".exr");
  return arguments;
}

}  // namespace basicrt
