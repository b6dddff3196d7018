// SPDX-License-Identifier: GPL-3.0-or-later
// Scene, its tables and Instance.
#include "scene/scene.h"

#include <pybind11/typing.h>

#include "base/error.h"
#include "bsdf/draw_environment.h"
#include "described.h"
#include "io/sample_range.h"
#include "io/scene_json.h"
#include "path_argument.h"
#include "register.h"
#include "scene/mattes.h"
#include "scene/memory.h"
#include "scene_lease.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

// One of a scene's tables, looked at from Python.
template <class T>
struct TableView {
  BoundScene* scene;
  Table<T> Scene::* table;

  [[nodiscard]] const Table<T>& read() const { return scene->scene().*table; }
  [[nodiscard]] Table<T>& edit() const { return scene->edit().*table; }
  // An index as Python has them, negative ones from the end.
  [[nodiscard]] Id<T> id(std::int64_t index) const {
    const std::int64_t size = read().size();
    if (index < -size || index >= size)
      throw py::index_error("index " + std::to_string(index) + ", but there are " + std::to_string(size) + " entries");
    return Id<T>{static_cast<std::uint32_t>(index < 0 ? index + size : index)};
  }
};

template <class T>
void bind_table(py::module_& m, const char* name) {
  using View = TableView<T>;
  py::class_<View>(m, name, "Entries of a scene by index. Reading gives a copy; assign it back to change the scene.")
      .def(
          "append", [](const View& self, T value) { return self.edit().append(std::move(value)).index; },
          py::arg("value"), "Adds an entry and returns its index.")
      .def(
          "clear", [](const View& self) { self.edit().clear(); }, "Takes all entries away.")
      .def("__len__", [](const View& self) { return self.read().size(); })
      .def("__getitem__", [](const View& self, std::int64_t index) -> T { return self.read()[self.id(index)]; })
      .def("__setitem__",
           [](const View& self, std::int64_t index, T value) { self.edit().set(self.id(index), std::move(value)); })
      .def("__iter__", [](const py::object& self) -> py::typing::Iterator<T> {
        // Calls __getitem__ until it raises IndexError.
        return py::reinterpret_steal<py::typing::Iterator<T>>(PySeqIter_New(self.ptr()));
      });
}

template <class T>
auto table_getter(Table<T> Scene::* table) {
  return py::cpp_function([table](BoundScene& self) { return TableView<T>{&self, table}; }, py::keep_alive<0, 1>());
}
template <class Value>
Attribute<Instance> info_attribute(const char* name, const char* doc, Value ObjectInfo::* member) {
  using Python = PythonValue<Value>;
  return {name,
          doc,
          Python::accepts,
          Python::returns,
          [member](const Instance& self) { return Python::write(self.info.*member); },
          [member](Instance& self, py::handle value, const std::string& item) {
            self.info.*member = Python::read(value, item);
          }};
}

Image draw_environment_in(BoundScene& self, const Material& material, int width, int height, bool is_camera_ray) {
  constexpr int largest = 1 << 14;
  for (const auto& [name, size] : {std::pair{"width", width}, std::pair{"height", height}})
    if (size < 1 || size > largest)
      throw SceneError(std::string("Scene.draw_environment.") + name,
                       "must be in [1, " + std::to_string(largest) + "], is " + std::to_string(size));
  const SceneLease lease(self);
  Scene alone;
  alone.textures = lease.scene().textures;
  alone.materials.append(material);
  const py::gil_scoped_release release;
  validate_description(alone);
  return draw_environment(material, alone.textures, {.width = width, .height = height, .is_camera_ray = is_camera_ray},
                          0);
}

// A dictionary of vectors.
Attribute<Instance> properties_attribute() {
  return {"properties",
          "for materials that ask by name; reading gives a copy, assign to change them",
          "collections.abc.Mapping[str, collections.abc.Sequence[float]]",
          "dict[str, tuple[float, float, float]]",
          [](const Instance& self) {
            py::dict properties;
            for (const ObjectProperty& property : self.info.properties)
              properties[py::str(property.name)] = PythonValue<Vec3f>::write(property.value);
            return py::object(properties);
          },
          [](Instance& self, py::handle value, const std::string& item) {
            if (!py::isinstance<py::dict>(value)) refuse_type(item, "must be a dictionary", value);
            std::vector<ObjectProperty> properties;
            for (const auto& [key, number] : py::reinterpret_borrow<py::dict>(value)) {
              const std::string name = PythonValue<std::string>::read(key, item);
              properties.push_back({name, PythonValue<Vec3f>::read(number, item + "[" + name + "]")});
            }
            self.info.properties = std::move(properties);
          }};
}

void bind_instance(py::module_& m) {
  std::vector<Attribute<Instance>> attributes = {
      make_attribute(field("shape", &Instance::shape, "index into Scene.shapes")),
      make_attribute(field("transform", &Instance::object_to_world, "object to world")),
      make_attribute(field("materials", &Instance::materials,
                           "for each material slot an index into Scene.materials; None is a diffuse grey of 0.8")),
      make_attribute(field("name", &Instance::name, "for messages and the passes CryptoObject")),
      {"visibility", "RayKind bits: the rays that see it", "int", "int",
       [](const Instance& self) { return py::int_(self.visibility); },
       [](Instance& self, py::handle value, const std::string& item) {
         const auto bits = PythonValue<std::int64_t>::read(value, item);
         if (bits < 0 || bits > ray_all) refuse_value(item, "must be RayKind bits", value);
         self.visibility = static_cast<std::uint32_t>(bits);
       }},
      make_attribute(
          field("motion_transforms", &Instance::motion_transforms,
                "object to world at further times, equally spaced: `transform` is when the shutter opens, the "
                "last when it closes; matrices are linear between them")),
      make_attribute(field("adjacent_transforms", &Instance::adjacent_transforms,
                           "for the pass Vector: object to world one frame before and one frame after, or none")),
      make_attribute(field("holdout", &Instance::is_holdout, "a hole in the picture, for camera rays")),
      make_attribute(field("shadow_catcher", &Instance::is_shadow_catcher,
                           "the camera sees through it, darkened by the shadows of what is none")),
      info_attribute("color", "for materials that ask", &ObjectInfo::color),
      info_attribute("alpha", "of the colour, for materials that ask", &ObjectInfo::alpha),
      info_attribute("random", "in [0, 1], for materials that ask", &ObjectInfo::random),
      properties_attribute(),
      make_attribute(field("shadow_terminator_offset", &Instance::shadow_terminator_offset,
                           "cosine under which light that grazes a smooth-shaded mesh meets the smooth surface, not "
                           "the facets",
                           within(0, 1))),
      make_attribute(field("shadow_terminator_shading_offset", &Instance::shadow_terminator_shading_offset,
                           "how much light is dimmed that grazes the object", within(0, 1))),
      make_attribute(field("pass_index", &Instance::pass_index, "for the pass Object Index and materials that ask")),
      make_attribute(field("light_group", &Instance::light_group,
                           "the light of its materials is in the pass Light Group of this number too; 0: in none",
                           within(0, light_groups))),
      make_attribute(
          field("asset_name", &Instance::asset_name, "what it is part of, for the passes CryptoAsset; none: `name`")),
      make_attribute(field("receiver_set", &Instance::receiver_set, "by which lights know whether they light it",
                           within(0, LinkSets::count - 1))),
      make_attribute(field("blocker_set", &Instance::blocker_set, "by which lights know whether it dims them",
                           within(0, LinkSets::count - 1))),
      make_attribute(field("lit_sets", &Instance::lit_sets,
                           "the sets of receivers that its materials' light lights, 0 to 63; None: all")),
      make_attribute(field("blocker_sets", &Instance::blocker_sets,
                           "the sets of blockers that dim its materials' light, 0 to 63; None: all"))};
  bind_fields<Instance>(m, "Instance", "A shape placed in the world.", attributes);
}

}  // namespace

void register_scene(py::module_& m) {
  bind_instance(m);
  bind_table<Shape>(m, "ShapeTable");
  bind_table<Texture>(m, "TextureTable");
  bind_table<Material>(m, "MaterialTable");
  bind_table<Instance>(m, "InstanceTable");
  bind_table<Light>(m, "LightTable");

  py::class_<BoundScene>(m, "Scene",
                         "The description of a scene. No other thread may change it while a Session prepares it.")
      .def(py::init<>())
      .def_property_readonly("shapes", table_getter(&Scene::shapes), "Mesh, Sphere, PointCloud and Curves")
      .def_property_readonly("textures", table_getter(&Scene::textures))
      .def_property_readonly("materials", table_getter(&Scene::materials))
      .def_property_readonly("instances", table_getter(&Scene::instances))
      .def_property_readonly("lights", table_getter(&Scene::lights), "lamps; they don't block rays")
      .def_readwrite("environment", &BoundScene::environment)
      .def_property(
          "world_volume",
          [](const BoundScene& self) -> std::optional<std::uint32_t> {
            const Id<Material> id = self.scene().world_volume;
            return id.is_valid() ? std::optional(id.index) : std::nullopt;
          },
          [](BoundScene& self, std::optional<std::uint32_t> index) {
            self.edit().world_volume = index ? Id<Material>{*index} : Id<Material>{};
          },
          "The index of the material whose volume fills all space; None is empty space.")
      .def_readwrite("settings", &BoundScene::settings)
      .def_property(
          "camera", [](const BoundScene& self) { return self.scene().camera; },
          [](BoundScene& self, std::optional<Camera> camera) { self.edit().camera = std::move(camera); },
          "A copy of the camera, or None; assign to change it.")
      .def_property(
          "adjacent_cameras", [](const BoundScene& self) { return self.scene().adjacent_cameras; },
          [](BoundScene& self, std::vector<Camera> cameras) { self.edit().adjacent_cameras = std::move(cameras); },
          "For the pass Vector: copies of the cameras one frame before and one frame after, or none; assign to change "
          "them.")
      .def(
          "validate", [](BoundScene& self) { validate(SceneLease(self).scene()); },
          "Raises SceneError naming the first item that can't be rendered, the rule and the value.")
      .def(
          "save",
          [](BoundScene& self, const PathArgument& argument) {
            const std::filesystem::path path = argument.read();
            const SceneLease lease(self);
            const py::gil_scoped_release release;
            save_scene(lease.scene(), path);
          },
          py::arg("path"),
          "Writes one JSON file with everything in it, by way of a temporary name. Loading it gives the same picture.")
      .def(
          "matte_metadata",
          [](const BoundScene& self, const std::string& prefix) {
            py::typing::Dict<py::str, py::str> entries;
            for (const auto& [key, value] : matte_metadata(self.scene(), prefix))
              entries[py::str(key)] = py::str(value);
            return entries;
          },
          py::arg("prefix") = "",
          "Entries of an EXR header for the Cryptomatte passes among settings.passes; `prefix` comes before the "
          "layers' "
          "names.")
      .def(
          "range_metadata", [](BoundScene& self) { return range_metadata(SceneLease(self).scene()); },
          "JSON with which samples of which picture settings.samples_from and samples_to choose, for merging.")
      .def(
          "memory", [](BoundScene& self) { return expected_memory(SceneLease(self).scene()); },
          "SceneMemory that rendering will take, before anything is built: trees are the smallest that there could be.")
      .def("draw_environment", &draw_environment_in, py::arg("material"), py::arg("width") = 1024,
           py::arg("height") = 512, py::arg("is_camera_ray") = true,
           "What a material that emits shows in each direction, as an Image for an EnvironmentLayer, equirectangular. "
           "Its operations, with textures of this scene, run at the points one metre away. Raises SceneError.")
      .def(
          "to_json", [](BoundScene& self) { return scene_to_json(SceneLease(self).scene()); },
          "The text that save() writes.")
      .def("__repr__", [](const BoundScene& self) {
        return "<Scene of " + std::to_string(self.scene().instances.size()) + " instances, " +
               std::to_string(self.scene().lights.size()) + " lights>";
      });
}

}  // namespace basicrt::bindings
