// SPDX-License-Identifier: GPL-3.0-or-later
// What a program reads of the surface, the object and the ray.
#include "shading/surface_operations.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/frame.h"
#include "math/ray.h"
#include "shading/evaluator.h"

namespace basicrt {
namespace {

Vec3f normalized(Vec3f a) {
  const float size = length(a);
  return size > 0 ? a / size : Vec3f(0.0f);
}

float side(const Evaluator& in) { return in.point.is_backfacing ? -1.0f : 1.0f; }

Vec3f object_position(const Evaluator& in) {
  const Placement* placement = in.context.placement;
  return placement ? Vec3f(placement->world_to_object.point(Vec3d(in.point.position))) : in.point.position;
}

// Where the place would be if the mesh were not displaced.
Vec3f rest_position(const Evaluator& in) {
  const Mesh* mesh = in.context.mesh;
  if (mesh == nullptr || mesh->rest_positions.empty()) return object_position(in);
  const auto corner = [&](int i) { return mesh->rest_positions[mesh->triangles[in.point.primitive][i]]; };
  const Vec2f share = in.point.barycentrics;
  return corner(0) * (1 - share.x - share.y) + corner(1) * share.x + corner(2) * share.y;
}

// In the mesh's texture space, which Blender lets run from 0 to 1 over the undeformed mesh.
Vec3f generated(const Evaluator& in) {
  const Vec3f place = rest_position(in);
  if (!in.context.mesh) return place * 0.5f + Vec3f(0.5f);
  const Vec3f size = in.context.mesh->texture_space_size, from = place - in.context.mesh->texture_space_min;
  return {size.x != 0 ? from.x / size.x : 0, size.y != 0 ? from.y / size.y : 0, size.z != 0 ? from.z / size.z : 0};
}

Vec3f camera_position(const Evaluator& in) {
  return in.context.world_to_camera ? in.context.world_to_camera->point(in.point.position) : in.point.position;
}

// From 0 to 1 over the picture.
Vec3f window_position(const Evaluator& in) {
  if (!in.context.window) return Vec3f(0.0f);
  const CameraWindow& window = *in.context.window;
  const Vec3f place = camera_position(in);
  const float scale = window.is_perspective ? 1 / place.z : 1;
  return {(place.x * scale - window.min.x) / window.size.x, (place.y * scale - window.min.y) / window.size.y, 0};
}

Vec3f mirrored(Vec3f normal, Vec3f wo) { return normal * (2 * dot(normal, wo)) - wo; }

Vec3f flag(bool is_set) { return Vec3f(is_set ? 1.0f : 0.0f); }
Vec3f number(float value) { return Vec3f(value); }

// Dielectric reflectance; of no light behind.
float fresnel(float cosine, float eta) {
  const float c = std::abs(cosine), g_squared = eta * eta - 1 + c * c;
  if (g_squared <= 0) return 1;
  const float g = std::sqrt(g_squared), a = (g - c) / (g + c), b = ((g + c) * c - 1) / ((g - c) * c + 1);
  return 0.5f * a * a * (1 + b * b);
}

Vec3f interpolate(const MeshAttribute& attribute, const Mesh& mesh, const SurfacePoint& point) {
  const std::uint32_t triangle = point.primitive;
  if (attribute.domain == AttributeDomain::face) return attribute.values[triangle];
  const auto value = [&](std::uint32_t corner) {
    const bool is_per_corner = attribute.domain == AttributeDomain::corner;
    return attribute.values[is_per_corner ? triangle * 3 + corner : mesh.triangles[triangle][corner]];
  };
  const Vec2f share = point.barycentrics;
  return value(0) * (1 - share.x - share.y) + value(1) * share.x + value(2) * share.y;
}

// On curves and points.
Vec3f interpolate(const MeshAttribute& attribute, const ShadingContext& context, const SurfacePoint& point) {
  if (context.curves == nullptr) return attribute.values[point.primitive];
  if (attribute.domain == AttributeDomain::face) return attribute.values[context.curves->curve_of(point.primitive)];
  const Vec3f from = attribute.values[point.primitive], to = attribute.values[point.primitive + 1];
  return from + (to - from) * point.barycentrics.x;
}

// Of the side that the viewer sees, across the strand.
Vec3f strand_tangent_normal(const Evaluator& in) {
  if (!in.point.derivatives) return Vec3f(0.0f);
  const Vec3f along = normalized(in.point.derivatives->dpdu);
  return normalized(in.wo - along * dot(along, in.wo));
}

// What Blender's Curves Info and Point Info ask of curves and points; zero elsewhere.
Vec3f round_shape_value(SurfaceValue value, const Evaluator& in) {
  const SurfacePoint& point = in.point;
  if (const Curves* curves = in.context.curves) {
    const std::uint32_t segment = point.primitive;
    const float u = point.barycentrics.x;
    switch (value) {
      case SurfaceValue::is_strand:
        return number(1);
      case SurfaceValue::strand_intercept:
        return number(curves->intercept_at(segment, u));
      case SurfaceValue::strand_length:
        return number(curves->length_of(curves->curve_of(segment)));
      case SurfaceValue::strand_thickness:
        return number(2 * curves->radius_at(segment, u));
      case SurfaceValue::strand_tangent_normal:
        return strand_tangent_normal(in);
      case SurfaceValue::strand_random:
        return number(curves->randoms.empty() ? 0 : curves->randoms[curves->curve_of(segment)]);
      default:
        return {};
    }
  }
  if (const PointCloud* cloud = in.context.points) {
    const Vec3f center = cloud->positions[point.primitive];
    switch (value) {
      case SurfaceValue::point_position:
        return in.context.placement ? Vec3f(in.context.placement->object_to_world.point(Vec3d(center))) : center;
      case SurfaceValue::point_radius:
        return number(cloud->radii[point.primitive]);
      case SurfaceValue::point_random:
        return number(cloud->randoms.empty() ? 0 : cloud->randoms[point.primitive]);
      default:
        return {};
    }
  }
  return {};
}

Vec3f normal_to_world(Vec3f normal, const Evaluator& in) {
  if (!in.context.placement) return normalized(normal);
  return normalized(Vec3f(in.context.placement->world_to_object.transposed_vector(Vec3d(normal))));
}

Vec3f normal_to_object(Vec3f normal, const Evaluator& in) {
  if (!in.context.placement) return normal;
  return normalized(Vec3f(in.context.placement->object_to_world.transposed_vector(Vec3d(normal))));
}

// In object space, of the length that interpolation leaves it: shorter between normals that differ.
Vec3f interpolated_normal(const Evaluator& in) {
  const SurfacePoint& point = in.point;
  if (!in.context.mesh || in.context.mesh->corner_normals.empty()) return normal_to_object(point.geometric_normal, in);
  const auto corner = [&](std::size_t i) {
    return in.context.mesh->corner_normal_at(std::size_t{point.primitive} * 3 + i, point.time);
  };
  const Vec2f share = point.barycentrics;
  return corner(0) * (1 - share.x - share.y) + corner(1) * share.x + corner(2) * share.y;
}

// How long a metre of the object's is in the world, along the normal.
float stretch(const Evaluator& in) {
  if (!in.context.placement) return 1;
  const Vec3f normal = in.point.shading_normal, local = normal_to_object(normal, in);
  return dot(Vec3f(in.context.placement->object_to_world.vector(Vec3d(local))), normal);
}

// Of a pixel on the surface, as it is seen.
float pixel_size(const Evaluator& in) {
  const Vec3f normal = in.point.geometric_normal * side(in);
  const Frame frame = make_frame(normal, cross(Vec3f(1.0f), normal));
  const auto seen = [&](Vec3f along) { return length(along - in.wo * dot(along, in.wo)); };
  return in.context.footprint * 0.5f * (seen(frame.tangent) + seen(frame.bitangent));
}

// Zero where there are no tangents.
Vec3f from_tangents(Vec3f encoded, Vec3f tangent, float sign, const Evaluator& in) {
  if (length_squared(tangent) == 0) return Vec3f(0.0f);
  const Vec3f normal = interpolated_normal(in), across = cross(normal, tangent) * sign;
  return normal_to_world(tangent * encoded.x + across * encoded.y + normal * encoded.z, in);
}

Vec3f from_uv_tangents(Vec3f encoded, const Evaluator& in) {
  const auto& derivatives = in.point.derivatives;
  if (!derivatives || length_squared(derivatives->dpdu) == 0) return Vec3f(0.0f);
  const Vec3f own = in.point.shading_normal;
  const Vec3f tangent = normalized(derivatives->dpdu - own * dot(own, derivatives->dpdu)), across = cross(own, tangent);
  const float sign = dot(across, derivatives->dpdv) < 0 ? -1.0f : 1.0f;
  return normalized(tangent * encoded.x + across * (sign * encoded.y) + own * encoded.z);
}

}  // namespace

Vec3f viewed_normal(const Evaluator& in) { return in.point.shading_normal * side(in); }

Vec3f undisplaced_normal(const Evaluator& in) {
  if (!in.context.mesh || in.context.mesh->corner_normals.empty()) return in.point.shading_normal;
  const Vec3f normal = normal_to_world(interpolated_normal(in), in);
  return length_squared(normal) > 0 ? normal : in.point.shading_normal;
}

Vec3f eval(const SurfaceOperation& node, const Evaluator& in) {
  const SurfacePoint& point = in.point;
  const ShadingContext& context = in.context;
  const auto is_ray = [&](std::uint32_t kinds) { return flag((context.ray_kinds & kinds) != 0); };
  static const ObjectInfo no_object;
  const ObjectInfo& object = context.object ? *context.object : no_object;
  switch (node.value) {
    case SurfaceValue::position:
      return point.position;
    case SurfaceValue::normal:
      return viewed_normal(in);
    case SurfaceValue::true_normal:
      return point.geometric_normal * side(in);
    case SurfaceValue::incoming:
      return in.wo;
    case SurfaceValue::parametric:
      return {1 - point.barycentrics.x - point.barycentrics.y, point.barycentrics.x, 0};
    case SurfaceValue::backfacing:
      return flag(point.is_backfacing);
    case SurfaceValue::uv:
      return {point.uv.x, point.uv.y, 0};
    case SurfaceValue::generated:
      return generated(in);
    case SurfaceValue::object_position:
      return object_position(in);
    case SurfaceValue::object_normal:
      return normal_to_object(viewed_normal(in), in);
    case SurfaceValue::camera_position:
      return camera_position(in);
    case SurfaceValue::window:
      return window_position(in);
    case SurfaceValue::reflection:
      return mirrored(viewed_normal(in), in.wo);
    case SurfaceValue::tangent:
      return point.derivatives ? normalized(point.derivatives->dpdu) : Vec3f(0.0f);
    case SurfaceValue::object_location:
      return context.placement ? Vec3f(context.placement->object_to_world.column(3)) : Vec3f(0.0f);
    case SurfaceValue::object_color:
      return object.color;
    case SurfaceValue::object_alpha:
      return number(object.alpha);
    case SurfaceValue::object_index:
      return number(static_cast<float>(context.object_index));
    case SurfaceValue::object_random:
      return number(object.random);
    case SurfaceValue::material_index:
      return number(static_cast<float>(context.material_index));
    case SurfaceValue::view_vector:
      return normalized(camera_position(in));
    case SurfaceValue::view_depth:
      return number(camera_position(in).z);
    case SurfaceValue::view_distance:
      return number(length(camera_position(in)));
    case SurfaceValue::is_camera_ray:
      return is_ray(ray_camera);
    case SurfaceValue::is_shadow_ray:
      return is_ray(ray_shadow);
    case SurfaceValue::is_diffuse_ray:
      return flag((context.ray_kinds & ray_diffuse) != 0 || context.is_translucent_ray);
    case SurfaceValue::is_glossy_ray:
      return flag((context.ray_kinds & (ray_glossy | ray_transmission)) != 0 && !context.is_translucent_ray);
    case SurfaceValue::is_transmission_ray:
      return is_ray(ray_transmission);
    case SurfaceValue::is_reflection_ray:
      return is_ray(ray_diffuse | ray_glossy);
    case SurfaceValue::is_volume_ray:
      return is_ray(ray_volume);
    case SurfaceValue::is_singular_ray:
      return flag(context.is_singular_ray);
    case SurfaceValue::ray_length:
      return number(point.t);
    case SurfaceValue::ray_depth:
      return number(static_cast<float>(context.bounces));
    case SurfaceValue::diffuse_depth:
      return number(static_cast<float>(context.diffuse_bounces));
    case SurfaceValue::glossy_depth:
      return number(static_cast<float>(context.glossy_bounces));
    case SurfaceValue::transmission_depth:
      return number(static_cast<float>(context.transmission_bounces));
    case SurfaceValue::transparent_depth:
      return number(static_cast<float>(context.transparent_bounces));
    default:
      return round_shape_value(node.value, in);
  }
}

Vec3f eval(const AttributeOperation& node, const Evaluator& in) {
  const ShadingContext& context = in.context;
  const auto in_shape = [&](const std::vector<MeshAttribute>& attributes, const auto& shape) {
    const auto found = std::ranges::find(attributes, node.name, &MeshAttribute::name);
    return found == attributes.end() ? Vec3f(node.missing) : interpolate(*found, shape, in.point);
  };
  if (context.mesh) return in_shape(context.mesh->attributes, *context.mesh);
  if (context.curves) return in_shape(context.curves->attributes, context);
  if (context.points) return in_shape(context.points->attributes, context);
  return Vec3f(node.missing);
}

Vec3f eval(const ObjectPropertyOperation& node, const Evaluator& in) {
  if (!in.context.object) return Vec3f(node.missing);
  const std::vector<ObjectProperty>& properties = in.context.object->properties;
  const auto found = std::ranges::find(properties, node.name, &ObjectProperty::name);
  return found == properties.end() ? Vec3f(node.missing) : found->value;
}

Vec3f eval(const FresnelOperation& node, const Evaluator& in) {
  Vec3f normal = in(node.normal);
  if (length_squared(normal) == 0) normal = viewed_normal(in);
  const float cosine = dot(in.wo, normal), value = in(node.value);
  const bool is_back = in.point.is_backfacing;
  switch (node.of) {
    case FresnelKind::fresnel: {
      const float ior = std::max(value, 1e-5f);
      return Vec3f(fresnel(cosine, is_back ? 1 / ior : ior));
    }
    case FresnelKind::layer_fresnel: {
      const float eta = std::max(1 - value, 1e-5f);
      return Vec3f(fresnel(cosine, is_back ? eta : 1 / eta));
    }
    case FresnelKind::facing:
      break;
  }
  const float blend = std::clamp(value, 0.0f, 1 - 1e-5f), facing = std::abs(cosine);
  if (blend == 0.5f) return Vec3f(1 - facing);
  return Vec3f(1 - std::pow(facing, blend < 0.5f ? 2 * blend : 0.5f / (1 - blend)));
}

Vec3f eval(const NormalMapOperation& node, const Evaluator& in) {
  Vec3f encoded = in(node.color) * 2 - Vec3f(1.0f);
  float strength = std::max(in(node.strength), 0.0f);
  if (node.space == NormalMapSpace::tangent) {
    encoded = {encoded.x * strength, encoded.y * strength, lerp(1.0f, encoded.z, std::min(strength, 1.0f))};
    strength = 1;
  }
  Vec3f normal;
  switch (node.space) {
    case NormalMapSpace::tangent:
      normal = node.tangent.is_varying() ? from_tangents(encoded, in(node.tangent), in(node.tangent_sign), in)
                                         : from_uv_tangents(encoded, in);
      break;
    case NormalMapSpace::object:
      normal = normal_to_world(encoded, in);
      break;
    case NormalMapSpace::world:
      normal = normalized(encoded);
      break;
  }
  const Vec3f own = viewed_normal(in);
  if (length_squared(normal) == 0) return own;
  const Vec3f mixed = normalized(lerp(own, normal * side(in), strength));
  return length_squared(mixed) == 0 ? own : mixed;
}

Vec3f eval(const TangentOperation& node, const Evaluator& in) {
  const Vec3f normal = viewed_normal(in);
  return cross(normal, normalized(cross(normal_to_world(in(node.direction), in), normal)));
}

Vec3f eval(const WireframeOperation& node, const Evaluator& in) {
  const Mesh* mesh = in.context.mesh;
  const Placement* placement = in.context.placement;
  if (!mesh || !placement) return Vec3f(0.0f);
  const float width = in(node.size) * 0.5f * (node.is_in_pixels ? pixel_size(in) : 1);
  const auto corner = [&](int i) {
    return Vec3f(placement->object_to_world.point(Vec3d(mesh->position_at(in.point.primitive, i, in.point.time))));
  };
  const std::array corners = {corner(0), corner(1), corner(2)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f edge = corners[(i + 1) % 3] - corners[i];
    const Vec3f area = cross(edge, in.point.position - corners[i]);
    if (length_squared(area) < length_squared(edge) * width * width) return Vec3f(1.0f);
  }
  return Vec3f(0.0f);
}

Vec3f bumped_normal(const BumpOperation& node, const Evaluator& in, const HeightChange& height) {
  Vec3f normal = in(node.normal);
  if (length_squared(normal) == 0) normal = viewed_normal(in);
  Vec3f dpdx = height.dpdx, dpdy = height.dpdy;
  const bool is_in_object = node.is_undisplaced && in.context.placement;
  if (is_in_object) {
    const TransformD& to_object = in.context.placement->world_to_object;
    normal = normal_to_object(normal, in);
    dpdx = Vec3f(to_object.vector(Vec3d(dpdx)));
    dpdy = Vec3f(to_object.vector(Vec3d(dpdy)));
  }
  const Vec3f along_x = cross(dpdy, normal), along_y = cross(normal, dpdx);
  const float area = dot(dpdx, along_x);
  const Vec3f gradient = along_x * (height.at_dx - height.here) + along_y * (height.at_dy - height.here);
  const float scale = in(node.distance) * (node.is_inverted ? -1.0f : 1.0f) * (node.is_local ? stretch(in) : 1.0f),
              strength = std::max(in(node.strength), 0.0f);
  const float sign = area < 0 ? -1.0f : 1.0f;
  const Vec3f raised = normalized(normal * std::abs(area) - gradient * (sign * scale));
  const Vec3f blended = normalized(raised * strength + normal * (1 - strength));
  const Vec3f bumped = length_squared(blended) == 0 ? normal : blended;
  return is_in_object ? normal_to_world(bumped, in) : bumped;
}

}  // namespace basicrt
