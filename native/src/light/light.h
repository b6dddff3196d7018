// SPDX-License-Identifier: GPL-3.0-or-later
// The lamps as they are described, in radiometric units, and what comes of sampling them.
#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

#include "base/describe.h"
#include "base/id.h"
#include "geometry/hit.h"
#include "light/light_group.h"
#include "light/link_sets.h"
#include "math/color.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt {

struct Material;

// What every lamp has, whatever its kind: a switch for each way in which light may reach the camera, and a material
// that its light varies by.
template <class Lamp>
constexpr auto lamp_switches() {
  return fields_of(
      field("camera_visible", &Lamp::is_camera_visible, "camera rays see the lamp"),
      field("diffuse_visible", &Lamp::is_diffuse_visible, "it lights by diffuse reflection"),
      field("glossy_visible", &Lamp::is_glossy_visible, "it lights by glossy reflection, and mirrors see it"),
      field("transmission_visible", &Lamp::is_transmission_visible, "it lights through glass, and is seen through it"),
      field("volume_visible", &Lamp::is_volume_visible, "it lights volumes"),
      field("casts_shadows", &Lamp::casts_shadows, "what is in the way dims its light"),
      field("max_bounces", &Lamp::max_bounces, "scatterings behind which surfaces aren't lit by it", within(0, 1024)),
      field("light_group", &Lamp::light_group, "its light is in the pass Light Group of this number too; 0: in none",
            within(0, light_groups)),
      field("material", &Lamp::material, "whose emission multiplies the lamp's light, place by place; none: by 1"),
      field("object_transform", &Lamp::object_to_world, "local to world, of what the material takes for its object"),
      field("lit_sets", &Lamp::lit_sets, "the sets of receivers that it lights, 0 to 63; not given: all"),
      field("blocker_sets", &Lamp::blocker_sets, "the sets of blockers that dim its light, 0 to 63; not given: all"));
}

// A sphere of the given radius, or a point where that is 0. With soft falloff a disc that faces the lit point stands
// in for the sphere, as Blender's lamps have it by default.
struct PointLight {
  Vec3f position;
  Color intensity{1.0f};  // W / sr; a sphere has the radiance intensity / (pi radius^2)
  float radius = 0;
  bool is_soft = false;
  bool is_camera_visible = true, is_diffuse_visible = true, is_glossy_visible = true;
  bool is_transmission_visible = true, is_volume_visible = true;
  bool casts_shadows = true;
  int max_bounces = 1024;
  int light_group = 0;
  Id<Material> material;
  Transform object_to_world;
  LinkSets lit_sets, blocker_sets;
  static constexpr std::string_view kind = "point";
  static constexpr auto fields() {
    return joined(fields_of(field("position", &PointLight::position, "world space, metres"),
                            field("intensity", &PointLight::intensity, "W / sr", at_least(0)),
                            field("radius", &PointLight::radius, "metres", at_least(0)),
                            field("soft", &PointLight::is_soft, "a disc that faces the lit point instead of a sphere")),
                  lamp_switches<PointLight>());
  }
};

struct SpotLight {
  Transform to_world;  // shines along local -z; the cone is measured in local space
  Color intensity{1.0f};
  float radius = 0;
  bool is_soft = false;
  float angle = 0.785398f;  // full angle of the cone, radians
  float blend = 0.15f;      // share of the cone in which it fades
  bool is_camera_visible = true, is_diffuse_visible = true, is_glossy_visible = true;
  bool is_transmission_visible = true, is_volume_visible = true;
  bool casts_shadows = true;
  int max_bounces = 1024;
  int light_group = 0;
  Id<Material> material;
  Transform object_to_world;
  LinkSets lit_sets, blocker_sets;
  static constexpr std::string_view kind = "spot";
  static constexpr auto fields() {
    return joined(fields_of(field("transform", &SpotLight::to_world, "local to world; shines along local -z"),
                            field("intensity", &SpotLight::intensity, "W / sr on the axis", at_least(0)),
                            field("radius", &SpotLight::radius, "metres", at_least(0)),
                            field("soft", &SpotLight::is_soft, "a disc that faces the lit point instead of a sphere"),
                            field("angle", &SpotLight::angle, "full angle of the cone, radians", above(0)),
                            field("blend", &SpotLight::blend, "share of the cone in which it fades", within(0, 1))),
                  lamp_switches<SpotLight>());
  }
};

struct SunLight {
  Vec3f direction{0, 0, -1};  // in which the light travels
  Color irradiance{1.0f};     // W / m^2 on a surface that faces it
  float angle = 0;            // full angle of the disc, radians
  bool is_camera_visible = true, is_diffuse_visible = true, is_glossy_visible = true;
  bool is_transmission_visible = true, is_volume_visible = true;
  bool casts_shadows = true;
  int max_bounces = 1024;
  int light_group = 0;
  Id<Material> material;
  Transform object_to_world;
  LinkSets lit_sets, blocker_sets;
  static constexpr std::string_view kind = "sun";
  static constexpr auto fields() {
    return joined(
        fields_of(field("direction", &SunLight::direction, "in which the light travels, world space"),
                  field("irradiance", &SunLight::irradiance, "W / m^2 on a surface that faces it", at_least(0)),
                  field("angle", &SunLight::angle, "full angle of the disc, radians", within(0, 3.141593))),
        lamp_switches<SunLight>());
  }
};

// Local [-1/2, 1/2]^2 in the plane z = 0, or the ellipse in it; shines along local -z, one-sided.
struct AreaLight {
  Transform to_world;
  Color radiance{1.0f};
  bool is_ellipse = false;
  float spread = 3.141593f;  // full angle, radians; pi shines everywhere alike
  bool is_camera_visible = true, is_diffuse_visible = true, is_glossy_visible = true;
  bool is_transmission_visible = true, is_volume_visible = true;
  bool casts_shadows = true;
  int max_bounces = 1024;
  int light_group = 0;
  Id<Material> material;
  Transform object_to_world;
  LinkSets lit_sets, blocker_sets;
  static constexpr std::string_view kind = "area";
  static constexpr auto fields() {
    return joined(fields_of(field("transform", &AreaLight::to_world, "local to world; a unit square or disc at z = 0"),
                            field("radiance", &AreaLight::radiance, "W / (m^2 sr) with full spread", at_least(0)),
                            field("ellipse", &AreaLight::is_ellipse, "an ellipse instead of a rectangle"),
                            field("spread", &AreaLight::spread, "full angle, radians", within(0, 3.141593))),
                  lamp_switches<AreaLight>());
  }
};

using Light = std::variant<PointLight, SpotLight, SunLight, AreaLight>;

// Light that arrives at a point from one direction.
struct LightSample {
  Vec3f wi;                   // towards the light, unit length
  float distance = infinity;  // to the light, where a shadow ray ends
  Color radiance{0.0f};       // along -wi; for a delta light, times what makes radiance / pdf the irradiance
  float pdf = 0;              // over solid angle; 1 for a delta light
  bool is_delta = false;      // no other ray can find it: no multiple importance sampling
  // A lamp's switches: the kinds of scattering that it lights, whether a shadow ray is needed, and the last bounce.
  std::uint32_t kinds = ray_all;
  bool casts_shadows = true;
  std::uint32_t shadow_kind = ray_shadow;  // RayKind bits of such a ray
  int max_bounces = 1024;
  int light_group = 0;
  // Of a surface that doesn't emit the same everywhere: whose it is. The radiance counts times what it emits there.
  std::uint32_t emitter_instance = Hit::none, emitter_primitive = Hit::none;
  // The same of a lamp: its number, else Hit::none.
  std::uint32_t varying_lamp = Hit::none;
};

// Light that a ray runs into.
struct LightHit {
  float t = infinity;
  Color radiance{0.0f};
  float pdf = 0;  // that sample_light() gives this direction, over solid angle
  int light_group = 0;
  std::uint32_t shadow_kind = ray_shadow;  // as of a LightSample
  std::uint32_t varying_lamp = Hit::none;  // the same
};

// A path that starts at the light.
struct EmissionSample {
  Ray ray;
  Vec3f normal;             // of the light's surface at the origin; the direction for a point or a sun
  Color weight;             // radiance * cosine / (pdf_position * pdf_direction)
  float pdf_position = 1;   // per area (1 for a point)
  float pdf_direction = 1;  // over solid angle (1 for a sun without angle)
};

// The two densities of sample_emission.
struct EmissionPdf {
  float position = 0, direction = 0;
};

}  // namespace basicrt
