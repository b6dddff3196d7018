// SPDX-License-Identifier: GPL-3.0-or-later
// How the picture is made: the assignment's integrator and film, and our settings.
#include <array>

#include "io/described_json.h"
#include "io/scene_reader.h"

namespace basicrt {
namespace {

using Settings = RenderSettings;

void read_intersection_test(SceneReader& reader, const JsonValue& integrator) {
  integrator.check_keys(
      std::array<std::string_view, 5>{"type", "point_light_position", "point_light_flux", "max_depth", "spp"});
  Settings& settings = reader.scene.settings;
  settings.integrator = IntegratorKind::intersection_test;
  settings.samples = 8;
  read_optional_field(integrator, "spp", settings, &Settings::samples);
  read_optional_field(integrator, "max_depth", settings, &Settings::max_depth);
  read_optional_field(integrator, "point_light_position", settings, &Settings::point_light_position);
  read_optional_field(integrator, "point_light_flux", settings, &Settings::point_light_flux);
}

// `max_depth` is the number of surfaces that a path may meet: it is scattered once less than that between them, and
// no kind of scattering has a limit of its own.
void set_path_depth(const JsonValue& max_depth, Settings& settings) {
  int surfaces = 0;
  read(max_depth, surfaces);
  validate_field(surfaces, within(1, 1024), max_depth.path(), "");
  settings.max_bounces = surfaces - 1;
  settings.diffuse_bounces = settings.glossy_bounces = settings.max_bounces;
  settings.transmission_bounces = settings.transparent_bounces = settings.max_bounces;
  settings.volume_bounces = settings.max_bounces;
}

void read_path(SceneReader& reader, const JsonValue& integrator) {
  Settings& settings = reader.scene.settings;
  settings.integrator = IntegratorKind::path;
  settings.roulette_threshold = 0.1f;
  read_optional_field(integrator, "spp", settings, &Settings::samples);
  read_optional_field(integrator, "rr_threshold", settings, &Settings::roulette_threshold);
  if (const auto max_depth = integrator.find("max_depth")) set_path_depth(*max_depth, settings);
  if (const auto profile = integrator.find("profile")) {
    constexpr std::array<std::string_view, 3> profiles = {"MIS", "NEE", "RW"};
    if (read_choice(*profile, profiles, "profile") != 0)
      profile->warn(reader.report, "rendered as MIS: the same picture with less noise");
  }
}

void check_path_keys(const JsonValue& integrator) {
  integrator.check_keys(std::array<std::string_view, 5>{"type", "profile", "rr_threshold", "max_depth", "spp"});
}

void warn_of_path(SceneReader& reader, const JsonValue& integrator) {
  std::string name;
  read(integrator.require("type"), name);
  integrator.warn(reader.report, "there is no \"" + name + "\" yet: the scene is rendered with \"path\"");
}

struct IntegratorReader {
  std::string_view name;
  void (*read)(SceneReader&, const JsonValue&);
};

constexpr std::array integrators = {
    IntegratorReader{"path",
                     [](SceneReader& reader, const JsonValue& integrator) {
                       check_path_keys(integrator);
                       read_path(reader, integrator);
                     }},
    IntegratorReader{"intersection_test", read_intersection_test},
    IntegratorReader{"bdpt",
                     [](SceneReader& reader, const JsonValue& integrator) {
                       check_path_keys(integrator);
                       warn_of_path(reader, integrator);
                       read_path(reader, integrator);
                     }},
    IntegratorReader{"photon",  // may have keys that mean nothing to us
                     [](SceneReader& reader, const JsonValue& integrator) {
                       warn_of_path(reader, integrator);
                       read_path(reader, integrator);
                     }},
};

void read_filter(const JsonValue& json, FilterSettings& filter) {
  json.check_keys(known_keys<FilterSettings>());
  read_fields(json, filter);
}

void read_passes(const JsonValue& names, PassLayout& layout) {
  std::array<std::string_view, passes.size()> known;
  for (const PassInfo& info : passes) known[static_cast<std::size_t>(info.pass)] = info.name;
  names.expect_array();
  for (std::size_t i = 0; i < names.size(); ++i)
    layout.enable(static_cast<Pass>(read_choice(names.item(i), known, "pass")));
}

}  // namespace

void read_integrator(SceneReader& reader, const JsonValue& integrator) {
  std::array<std::string_view, integrators.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = integrators[i].name;
  integrators[read_choice(integrator.require("type"), names, "integrator")].read(reader, integrator);
}

void read_film(SceneReader& reader, const JsonValue& film) {
  film.check_keys(std::array<std::string_view, 2>{"resolution", "filter"});
  Settings& settings = reader.scene.settings;
  if (const auto resolution = film.find("resolution")) {
    if (!resolution->json().is_array() || resolution->size() != 2) resolution->fail_type("an array of 2 integers");
    read_field(resolution->item(0), settings, &Settings::width);
    read_field(resolution->item(1), settings, &Settings::height);
  }
  if (const auto filter = film.find("filter")) read_filter(*filter, settings.filter);
}

void read_settings(SceneReader& reader, const JsonValue& json) {
  Settings& settings = reader.scene.settings;
  json.check_keys(known_keys<Settings>({"filter", "passes"}));
  read_fields(json, settings);
  if (const auto filter = json.find("filter")) read_filter(*filter, settings.filter);
  if (const auto passes_json = json.find("passes")) read_passes(*passes_json, settings.passes);
}

}  // namespace basicrt
