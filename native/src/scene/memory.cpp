// SPDX-License-Identifier: GPL-3.0-or-later
// Adds up the arrays that grow with a scene.
#include "scene/memory.h"

#include <algorithm>
#include <set>
#include <vector>

#include "base/overloaded.h"
#include "bvh/kernels/kernel.h"
#include "film/channels.h"

namespace basicrt {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

template <class T>
std::size_t bytes_of(const std::vector<std::vector<T>>& keys) {
  std::size_t bytes = 0;
  for (const std::vector<T>& key : keys) bytes += bytes_of(key);
  return bytes;
}

std::size_t bytes_of(const std::vector<MeshAttribute>& attributes) {
  std::size_t bytes = 0;
  for (const MeshAttribute& attribute : attributes) bytes += bytes_of(attribute.values);
  return bytes;
}

std::size_t bytes_of(const Shape& shape) {
  return std::visit(Overloaded{[](const Mesh& mesh) {
                                 return bytes_of(mesh.positions) + bytes_of(mesh.triangles) +
                                        bytes_of(mesh.corner_normals) + bytes_of(mesh.uvs) +
                                        bytes_of(mesh.material_slots) + bytes_of(mesh.motion_positions) +
                                        bytes_of(mesh.adjacent_positions) + bytes_of(mesh.motion_corner_normals) +
                                        bytes_of(mesh.attributes) + bytes_of(mesh.rest_positions);
                               },
                               [](const Sphere&) { return sizeof(Sphere); },
                               [](const PointCloud& cloud) {
                                 return bytes_of(cloud.positions) + bytes_of(cloud.radii) + bytes_of(cloud.randoms) +
                                        bytes_of(cloud.attributes);
                               },
                               [](const Curves& curves) {
                                 return bytes_of(curves.points) + bytes_of(curves.radii) + bytes_of(curves.firsts) +
                                        bytes_of(curves.intercepts) + bytes_of(curves.randoms) + bytes_of(curves.uvs) +
                                        bytes_of(curves.attributes);
                               }},
                    shape);
}

// Of a tree without a gap: each node but the root is one of eight children, and so is each leaf.
std::size_t least_tree(std::size_t leaves, std::size_t leaf_bytes) {
  const std::size_t nodes = leaves > 1 ? (leaves - 1 + 6) / 7 : 0;
  return leaves * leaf_bytes + nodes * sizeof(TreeNode);
}

std::size_t least_tree(const Shape& shape) {
  constexpr std::size_t leaf_size = 4;
  const auto leaves = [](std::size_t count) { return (count + leaf_size - 1) / leaf_size; };
  return std::visit(
      Overloaded{[&](const Mesh& mesh) {
                   const std::size_t count = leaves(mesh.triangles.size());
                   return mesh.is_deforming() ? mesh.motion_intervals() * least_tree(count, sizeof(MovingTriangleBlock))
                                              : least_tree(count, sizeof(TriangleBlock));
                 },
                 [](const Sphere&) -> std::size_t { return 0; },
                 [&](const PointCloud& cloud) {
                   const std::size_t count = cloud.positions.size();
                   return count * sizeof(PointTree::Point) + least_tree(leaves(count), sizeof(std::uint32_t));
                 },
                 [&](const Curves& curves) {
                   // Segments, each of one part.
                   const std::size_t count =
                       std::max(curves.points.size(), curves.firsts.size()) - curves.firsts.size();
                   return count * sizeof(CurveTree::Part) + bytes_of(curves.points) + bytes_of(curves.radii) +
                          least_tree(leaves(count), sizeof(std::uint32_t));
                 }},
      shape);
}

// With what the tracer has of each.
constexpr std::size_t instance_bytes = sizeof(Instance) + sizeof(PreparedScene::PreparedInstance) +
                                       sizeof(TracedInstance) + sizeof(KernelInstance) + sizeof(Bounds3f);

// Copies of one image count once.
class ImageBytes {
 public:
  void add(const Image& image) {
    add(image.pixels.data(), image.pixels.size() * sizeof(float));
    add(image.bytes.data(), image.bytes.size());
  }
  void add(const Environment& environment) {
    for (const EnvironmentLayer& layer : environment.layers) add(layer.image);
  }
  void add(const Table<Texture>& textures) {
    for (std::uint32_t i = 0; i < textures.size(); ++i)
      if (const auto* texture = std::get_if<ImageTexture>(&textures[Id<Texture>{i}])) add(texture->image);
  }
  [[nodiscard]] std::size_t total() const { return total_; }

 private:
  void add(const void* data, std::size_t bytes) {
    if (bytes > 0 && seen_.insert(data).second) total_ += bytes;
  }

  std::set<const void*> seen_;
  std::size_t total_ = 0;
};

std::size_t picture_bytes(const RenderSettings& settings) {
  const auto width = static_cast<std::size_t>(settings.border_width > 0 ? settings.border_width : settings.width);
  const auto height = static_cast<std::size_t>(settings.border_height > 0 ? settings.border_height : settings.height);
  std::size_t channels = 0;
  for (const PassInfo& info : passes)
    if (settings.passes.has(info.pass)) channels += info.channels.size();
  return width * height * channels * sizeof(float);
}

}  // namespace

SceneMemory expected_memory(const Scene& scene) {
  SceneMemory memory{.picture = picture_bytes(scene.settings)};
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const Shape& shape = scene.shapes[Id<Shape>{i}];
    memory.shapes += 2 * bytes_of(shape);
    memory.trees += least_tree(shape);
  }
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::size_t keys = scene.instances[Id<Instance>{i}].motion_transforms.size();
    memory.instances +=
        instance_bytes + (keys > 0 ? keys * sizeof(Transform) + 2 * (keys + 1) * sizeof(TransformD) : 0);
  }
  memory.trees += least_tree(scene.instances.size(), 0);
  ImageBytes images;
  images.add(scene.textures);
  images.add(scene.environment);
  memory.images = images.total();
  return memory;
}

SceneMemory memory_of(const PreparedScene& scene) {
  SceneMemory memory{.trees = scene.tracer.memory(), .picture = picture_bytes(scene.settings)};
  for (const Shape& shape : scene.shapes) memory.shapes += 2 * bytes_of(shape);
  for (const PreparedScene::PreparedInstance& instance : scene.instances)
    memory.instances += instance_bytes + 3 * bytes_of(instance.motion);
  ImageBytes images;
  images.add(scene.textures);
  images.add(scene.environment);
  memory.images = images.total();
  return memory;
}

}  // namespace basicrt
