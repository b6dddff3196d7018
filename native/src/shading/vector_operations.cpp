// SPDX-License-Identifier: GPL-3.0-or-later
// Points and directions moved, turned and taken to other spaces as in Blender's nodes.
#include "shading/vector_operations.h"

#include <cmath>

#include "shading/evaluator.h"

namespace basicrt {
namespace {

Vec3f normalized(Vec3f a) {
  const float size = length(a);
  return size > 0 ? a / size : Vec3f(0.0f);
}

Vec3f divide(Vec3f a, Vec3f b) {
  return {b.x != 0 ? a.x / b.x : 0, b.y != 0 ? a.y / b.y : 0, b.z != 0 ? a.z / b.z : 0};
}

// About x, then y, then z.
Transform euler_rotation(Vec3f angles) {
  const float cx = std::cos(angles.x), cy = std::cos(angles.y), cz = std::cos(angles.z);
  const float sx = std::sin(angles.x), sy = std::sin(angles.y), sz = std::sin(angles.z);
  return Transform({{{cy * cz, sy * sx * cz - cx * sz, sy * cx * cz + sx * sz, 0},
                     {cy * sz, sy * sx * sz + cx * cz, sy * cx * sz - sx * cz, 0},
                     {-sy, cy * sx, cy * cx, 0}}});
}

// Rodrigues' formula.
Vec3f rotate_about(Vec3f v, Vec3f axis, float angle) {
  const float cosine = std::cos(angle), sine = std::sin(angle);
  return v * cosine + cross(axis, v) * sine + axis * (dot(axis, v) * (1 - cosine));
}

Vec3f axis_of(const RotateOperation& node, const Evaluator& in) {
  switch (node.about) {
    case RotateKind::x_axis:
      return {1, 0, 0};
    case RotateKind::y_axis:
      return {0, 1, 0};
    case RotateKind::z_axis:
      return {0, 0, 1};
    default:
      return normalized(in(node.axis));
  }
}

// To the world and back; what is not known leaves vectors as they are.
struct Both {
  TransformD to_world, from_world;
};

Both both(Space space, const ShadingContext& context) {
  if (space == Space::object && context.placement)
    return {context.placement->object_to_world, context.placement->world_to_object};
  if (space == Space::camera && context.world_to_camera)
    return {inverse(*context.world_to_camera), *context.world_to_camera};
  return {};
}

}  // namespace

Vec3f eval(const MappingOperation& node, const Evaluator& in) {
  const Vec3f vector = in(node.vector), scale = in(node.scale);
  const Transform rotation = euler_rotation(in(node.rotation));
  switch (node.mapping) {
    case MappingKind::point:
      return rotation.vector(vector * scale) + in(node.location);
    case MappingKind::texture:
      return divide(rotation.transposed_vector(vector - in(node.location)), scale);
    case MappingKind::vector:
      return rotation.vector(vector * scale);
    case MappingKind::normal:
      return normalized(rotation.vector(divide(vector, scale)));
  }
  return vector;
}

Vec3f eval(const RotateOperation& node, const Evaluator& in) {
  const Vec3f center = in(node.center), vector = in(node.vector) - center;
  if (node.about == RotateKind::euler_xyz) {
    const Transform rotation = euler_rotation(in(node.rotation));
    return (node.is_inverted ? rotation.transposed_vector(vector) : rotation.vector(vector)) + center;
  }
  const Vec3f axis = axis_of(node, in);
  if (length_squared(axis) == 0) return vector + center;
  const float angle = in(node.angle);
  return rotate_about(vector, axis, node.is_inverted ? -angle : angle) + center;
}

Vec3f eval(const TransformOperation& node, const Evaluator& in) {
  const Vec3f vector = in(node.vector);
  switch (node.quantity) {
    case VectorKind::point:
      return node.transform.point(vector);
    case VectorKind::vector:
      return node.transform.vector(vector);
    case VectorKind::normal:
      return normalized(inverse(node.transform).transposed_vector(vector));
  }
  return vector;
}

Vec3f eval(const ChangeSpaceOperation& node, const Evaluator& in) {
  const Vec3f vector = in(node.vector);
  if (node.source == node.target) return node.quantity == VectorKind::normal ? normalized(vector) : vector;
  const Both from = both(node.source, in.context), to = both(node.target, in.context);
  switch (node.quantity) {
    case VectorKind::point:
      return to.from_world.point(from.to_world.point(vector));
    case VectorKind::vector:
      return to.from_world.vector(from.to_world.vector(vector));
    case VectorKind::normal:
      return normalized(to.to_world.transposed_vector(from.from_world.transposed_vector(vector)));
  }
  return vector;
}

}  // namespace basicrt
