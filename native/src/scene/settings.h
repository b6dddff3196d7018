// SPDX-License-Identifier: GPL-3.0-or-later
// How a picture is made: nothing here says what it is of.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/describe.h"
#include "bvh/bvh.h"
#include "film/channels.h"
#include "film/film.h"
#include "math/color.h"
#include "sampling/filter.h"
#include "sampling/sampler.h"

namespace basicrt {

enum class IntegratorKind : std::uint8_t { path, intersection_test };
template <>
inline constexpr std::array enum_names<IntegratorKind> = std::to_array<std::string_view>({"path", "intersection_test"});

template <>
inline constexpr std::array enum_names<BvhBuilder> =
    std::to_array<std::string_view>({"median", "binned_sah", "split_sah"});

struct RenderSettings {
  int width = 512, height = 512;
  // The rectangle to render, in pixels, (0, 0) at the lower left; of no size: all of it. Tiles' coordinates are the
  // whole picture's.
  int border_x = 0, border_y = 0, border_width = 0, border_height = 0;
  // Of the samples only those from the first up to before the second, multiples of sample_block; 0 and 0: all of them.
  int samples_from = 0, samples_to = 0;
  int samples = 64;              // where sampling is adaptive or the time is limited, the most
  float adaptive_threshold = 0;  // the noise at which a pixel has enough samples; 0 gives all pixels all
  int adaptive_min_samples = 0;  // before that is asked; 0 chooses by the threshold
  float time_limit = 0;          // seconds after which no more samples are started; 0 is none
  std::int64_t seed = 0;
  SamplerKind sampler = SamplerKind::sobol;
  FilterSettings filter;
  PassLayout passes;
  bool is_film_transparent = false;
  bool is_glass_transparent = false;         // and what is seen of the background through glass is so too
  float transparent_glass_roughness = 0.1f;  // of the roughest such glass
  float exposure = 1;                        // multiplies radiance
  // The pass Mist: it begins and is complete so many metres from the camera; the power of the share between them.
  float mist_start = 5, mist_depth = 25, mist_falloff = 2;
  float ao_distance = 10;  // metres within which the pass Ambient Occlusion looks for surfaces; 0 is no limit
  bool has_background_vectors = true;  // the pass Vector shows how what is behind everything moves as the camera turns
  // How far the shutter is open at equally spaced times from 0 to 1, linear between them; none: wide open throughout.
  std::vector<float> shutter_curve;

  IntegratorKind integrator = IntegratorKind::path;
  // Path: scatterings of each kind after which a path ends, counted as Blender does.
  int max_bounces = 12, diffuse_bounces = 4, glossy_bounces = 4, transmission_bounces = 12, transparent_bounces = 8;
  int volume_bounces = 0;
  float roulette_threshold = 0.2f;  // paths with less throughput than this are ended by chance
  float light_threshold = 0;        // light samples that would add less than this are left out by chance; 0 is none
  float clamp_direct = 0, clamp_indirect = 0;  // the most that a path adds, as the mean of r, g and b; 0 is none
  float blur_glossy = 0;                       // see PathIntegrator::soften; 0 is none
  bool has_reflective_caustics = true, has_refractive_caustics = true;
  // Intersection test: the assignment's integrator with one point light.
  Vec3f point_light_position{0, 0, 0};
  Color point_light_flux{1.0f};
  int max_depth = 16;

  BvhBuilder bvh_builder = BvhBuilder::binned_sah;

  // A part of the picture's samples is rendered: others have the rest, or will.
  [[nodiscard]] bool has_sample_range() const { return samples_from > 0 || samples_to > 0; }
  [[nodiscard]] int samples_end() const { return samples_to > 0 ? samples_to : samples; }

  static constexpr auto fields() {
    using S = RenderSettings;
    return fields_of(
        field("width", &S::width, "pixels", within(1, 65536)), field("height", &S::height, "pixels", within(1, 65536)),
        field("border_x", &S::border_x, "left edge of the rectangle to render, pixels", at_least(0)),
        field("border_y", &S::border_y, "lower edge of the rectangle to render, pixels", at_least(0)),
        field("border_width", &S::border_width, "pixels; 0 is the whole width", at_least(0)),
        field("border_height", &S::border_height, "pixels; 0 is the whole height", at_least(0)),
        field("samples", &S::samples, "paths for each pixel, the most where sampling is adaptive or time limited",
              within(1, 1 << 24)),
        field("samples_from", &S::samples_from, "the first of the samples to take, a multiple of 64", at_least(0)),
        field("samples_to", &S::samples_to, "the end of the samples to take, a multiple of 64 or all; 0 is all",
              at_least(0)),
        field("adaptive_threshold", &S::adaptive_threshold,
              "the noise at which a pixel has enough samples; 0 gives every pixel all samples", within(0, 1)),
        field("adaptive_min_samples", &S::adaptive_min_samples,
              "samples before the noise is looked at; 0 chooses by the threshold", within(0, 1 << 24)),
        field("time_limit", &S::time_limit, "seconds after which no more samples are started; 0 is no limit",
              at_least(0)),
        field("seed", &S::seed, "another seed, other noise"),
        field("sampler", &S::sampler, "how a pixel's samples are spread: evenly, or each by chance"),
        field("film_transparent", &S::is_film_transparent, "the background has alpha 0"),
        field("film_transparent_glass", &S::is_glass_transparent,
              "where the film is transparent, so is the background seen through glass"),
        field("film_transparent_roughness", &S::transparent_glass_roughness,
              "the largest alpha of microfacets that counts as such glass", within(0, 1)),
        field("exposure", &S::exposure, "multiplies radiance", at_least(0)),
        field("mist_start", &S::mist_start, "metres from the camera where the pass Mist begins", at_least(0)),
        field("mist_depth", &S::mist_depth, "metres from there to where the mist is complete", at_least(0)),
        field("mist_falloff", &S::mist_falloff, "power of the share of that distance", above(0)),
        field("background_vectors", &S::has_background_vectors,
              "the pass Vector shows how what is behind everything moves as the camera turns; otherwise it is not "
              "counted, and 0 where there is nothing else"),
        field("ao_distance", &S::ao_distance,
              "metres within which the pass Ambient Occlusion looks for surfaces; 0 is no limit", at_least(0)),
        field("shutter_curve", &S::shutter_curve,
              "how far the shutter is open at equally spaced times; none: wide open throughout", at_least(0)),
        field("integrator", &S::integrator, "how light is computed"),
        field("max_bounces", &S::max_bounces, "scatterings after which a path ends", within(0, 1024)),
        field("diffuse_bounces", &S::diffuse_bounces, "diffuse reflections after which a path ends", within(0, 1024)),
        field("glossy_bounces", &S::glossy_bounces, "glossy reflections after which a path ends", within(0, 1024)),
        field("transmission_bounces", &S::transmission_bounces, "transmissions after which a path ends",
              within(0, 1024)),
        field("volume_bounces", &S::volume_bounces, "scatterings in volumes after which a path ends", within(0, 1024)),
        field("transparent_bounces", &S::transparent_bounces, "transparent surfaces after which a ray ends",
              within(0, 1024)),
        field("rr_threshold", &S::roulette_threshold, "throughput under which Russian roulette begins", within(0, 1)),
        field("light_threshold", &S::light_threshold,
              "light samples that would add less than this are left out by chance, which changes no mean",
              within(0, 1)),
        field("clamp_direct", &S::clamp_direct,
              "the most light that a path adds from lights it meets at once; 0 is no limit", at_least(0)),
        field("clamp_indirect", &S::clamp_indirect,
              "the most light that a path adds after more scatterings; 0 is no limit", at_least(0)),
        field("blur_glossy", &S::blur_glossy, "roughens what paths meet after a blurred scattering; 0 is none",
              within(0, 10)),
        field("caustics_reflective", &S::has_reflective_caustics, "glossy reflection after a diffuse one"),
        field("caustics_refractive", &S::has_refractive_caustics, "transmission after a diffuse reflection"),
        field("point_light_position", &S::point_light_position, "intersection_test: the light, world space"),
        field("point_light_flux", &S::point_light_flux, "intersection_test: watts", at_least(0)),
        field("max_depth", &S::max_depth, "intersection_test: surfaces that a path may meet", within(1, 1024)),
        field("bvh_builder", &S::bvh_builder, "which builder makes the trees"));
  }
};

}  // namespace basicrt
