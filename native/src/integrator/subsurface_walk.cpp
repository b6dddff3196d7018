// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/subsurface_walk.h"

#include <cmath>

#include "bsdf/phase.h"
#include "integrator/batch.h"
#include "math/constants.h"
#include "math/frame.h"

namespace basicrt {
namespace {

constexpr int most_steps = 256;  // what is left then is lost, as in Cycles: up to a few percent in the brightest bodies
// After so many steps directions no longer matter: light that turns little is as good as less light that turns evenly.
constexpr int steps_before_similarity = 10;
constexpr float least_throughput = 1e-6f;
// Within so many mean free paths the surface opposite is looked for.
constexpr float opposite_reach = 10;

Color exp(Color c) { return {std::exp(c.x), std::exp(c.y), std::exp(c.z)}; }
float min_component(Color c) { return std::min({c.x, c.y, c.z}); }

// Of passing through to the surface, or of a collision there.
Color distance_pdf(Color extinction, float length, bool is_out) {
  const Color passed = exp(extinction * -length);
  return is_out ? passed : extinction * passed;
}

// The length over which light fades in an endless body, in mean free paths: the fit of d'Eon and Křivánek 2020,
// "Zero-Variance Theory for Efficient Subsurface Scattering", equation 67.
float diffusion_length(float albedo) {
  return 1 / std::sqrt(1 - std::pow(albedo, 2.44294f - 0.0215813f * albedo + 0.578637f / albedo));
}

Vec3f around(Vec3f axis, float cosine, float turn) {
  const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f)), phi = 2 * pi * turn;
  return make_frame(axis).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine});
}

// The same transport for light that turns evenly.
SubsurfaceMedium even_medium(const SubsurfaceMedium& medium) {
  SubsurfaceMedium even = medium;
  const Color scattering = medium.extinction * medium.albedo;
  even.extinction = medium.extinction - scattering * medium.anisotropy;
  even.albedo = scattering * (1 - medium.anisotropy) / even.extinction;
  even.anisotropy = 0;
  return even;
}

}  // namespace

SubsurfaceWalk::SubsurfaceWalk(const Subsurface& subsurface, const SurfacePoint& entry, Vec3f normal, Vec3f direction,
                               float time, Color throughput, const Sampler& sampler)
    : medium_(make_medium(subsurface)),
      start_(entry.position),
      normal_(normal),
      diffusion_length_(diffusion_length(max_component(medium_.albedo))),
      log_ratio_(std::log((diffusion_length_ + 1) / (diffusion_length_ - 1))),
      throughput_(throughput * medium_.weight),
      sampler_(sampler),
      instance_(entry.instance),
      ray_(spawn_ray(entry, direction, ray_all, time)) {
  for (std::size_t i = 0; i < 3; ++i)  // the colour comes of the scattering
    if (throughput_[i] > 0) throughput_[i] /= subsurface.color()[i];
  begin_step();
}

// Draws the next step, from where the ray starts; that of the first goes on as the light entered.
void SubsurfaceWalk::begin_step() {
  const Color shares = throughput_ * medium_.albedo;
  const float sum = shares.x + shares.y + shares.z;
  if (steps_ >= most_steps || !(max_component(throughput_) >= least_throughput) || !(sum > 0) ||
      !std::isfinite(log_ratio_)) {
    state_ = State::lost;
    return;
  }
  if (steps_ == steps_before_similarity) medium_ = even_medium(medium_);
  channel_shares_ = shares * (1 / sum);
  const float choice = sampler_.next_1d();
  const std::size_t channel = choice < channel_shares_.x ? 0 : choice < channel_shares_.x + channel_shares_.y ? 1 : 2;
  float stretching = 1;
  guide_ = steps_ > 0 ? pick_direction(stretching) : Guide();
  step_length_ = -std::log(1 - sampler_.next_1d()) / (medium_.extinction[channel] * stretching);
  ray_.t_min = 0;
  ray_.t_max = steps_ > 0 ? step_length_ : std::max(step_length_, opposite_reach / min_component(medium_.extinction));
}

// `stretching` is what the extinction is multiplied by when the distance is drawn: guided light goes further.
SubsurfaceWalk::Guide SubsurfaceWalk::pick_direction(float& stretching) {
  const bool is_even = steps_ >= steps_before_similarity;
  Guide guide;
  guide.share = is_even ? 0.75f : 1 - std::max(0.5f, std::pow(std::abs(medium_.anisotropy), 0.125f));
  if (opposite_distance_ >= 0) {
    const float depth = std::clamp(dot(start_ - ray_.origin, normal_), 0.0f, opposite_distance_);
    guide.backward_share = 1 / (1 + std::exp((opposite_distance_ - 2 * depth) / diffusion_length_));
  }

  const HenyeyGreenstein phase(medium_.anisotropy);
  const float choice = sampler_.next_1d();
  const Vec2f u = sampler_.next_2d();
  const Vec3f old_direction = ray_.direction;
  if (choice < guide.share) {
    const float forward = diffusion_length_ - (diffusion_length_ + 1) * std::exp(-u.x * log_ratio_);
    const bool is_backward = choice < guide.share * guide.backward_share;
    guide.cosine = std::clamp(is_backward ? -forward : forward, -1.0f, 1.0f);
    ray_.direction = around(normal_, guide.cosine, u.y);
    stretching = 1 - forward / diffusion_length_;
  } else {
    ray_.direction = around(old_direction, phase.sample(u.x), u.y);
    guide.cosine = dot(ray_.direction, normal_);
  }
  guide.phase = phase.eval(dot(old_direction, ray_.direction));
  return guide;
}

// Of a direction at this cosine to the normal, per solid angle.
float SubsurfaceWalk::guide_density(float cosine) const {
  return 1 / (2 * pi * log_ratio_ * (diffusion_length_ - cosine));
}

// Of the direction and the distance together, over the phase function's for that direction, by each colour.
Color SubsurfaceWalk::guided_pdf(const Guide& guide, float length, bool is_out) const {
  const auto towards = [&](float cosine) {
    const Color stretched = medium_.extinction * (1 - cosine / diffusion_length_);
    return distance_pdf(stretched, length, is_out) * (guide_density(cosine) / guide.phase);
  };
  const Color forward = towards(guide.cosine);
  return guide.backward_share > 0 ? lerp(forward, towards(-guide.cosine), guide.backward_share) : forward;
}

void SubsurfaceWalk::advance(const PreparedScene& scene, const Hit& hit) {
  if (hit.is_hit() && hit.instance != instance_) {  // something else is in the body: it isn't seen
    continue_behind(ray_, hit, surface_point_at(scene, ray_, hit));
    return;
  }
  bool is_out = hit.is_hit();
  if (steps_ == 0) {
    if (is_out) opposite_distance_ = std::max(-dot(ray_.direction, normal_) * hit.t, 0.0f);
    is_out = is_out && hit.t < step_length_;
  }
  if (is_out) exit_ = hit;
  finish_step(is_out ? hit.t : step_length_, is_out);
}

void SubsurfaceWalk::finish_step(float length, bool is_out) {
  const Color passed = exp(medium_.extinction * -length);
  Color pdf = distance_pdf(medium_.extinction, length, is_out);
  if (steps_ > 0) pdf = lerp(pdf, guided_pdf(guide_, length, is_out), guide_.share);
  const Color reached = is_out ? passed : medium_.extinction * medium_.albedo * passed;
  throughput_ = throughput_ * reached * (1 / dot(channel_shares_, pdf));
  if (is_out) {
    state_ = std::isfinite(max_component(throughput_)) ? State::out : State::lost;
    return;
  }
  ++steps_;
  ray_.origin = ray_.at(length);
  ray_.from_instance = ray_.from_primitive = Hit::none;
  begin_step();
}

void SubsurfaceWalks::run(const PreparedScene& scene, std::span<SubsurfaceWalk> walks) {
  active_.clear();
  const auto is_walking = [&](std::uint32_t i) { return walks[i].state() == SubsurfaceWalk::State::walking; };
  for (std::uint32_t i = 0; i < walks.size(); ++i)
    if (is_walking(i)) active_.push_back(i);
  while (!active_.empty()) {
    rays_.clear();
    for (const std::uint32_t i : active_) rays_.push_back(walks[i].ray());
    find_hits(scene.tracer, rays_, hits_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      walks[active_[i]].advance(scene, hits_[i]);
      if (is_walking(active_[i])) active_[kept++] = active_[i];
    }
    active_.resize(kept);
  }
}

}  // namespace basicrt
