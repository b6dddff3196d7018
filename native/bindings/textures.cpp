// SPDX-License-Identifier: GPL-3.0-or-later
// Textures, and the reference to one that stands where a colour may vary.
#include "arrays.h"
#include "base/error.h"
#include "described.h"
#include "register.h"
#include "shading/texture.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

ImageTexture make_image_texture(const ArrayLike& pixels) {
  const py::array_t<float> array = float_array(pixels, "pixels", {{any_length, any_length, any_length}});
  if (array.size() == 0) throw SceneError("pixels", "must not be empty");
  if (array.shape(2) > 4)
    throw SceneError("pixels", "must have 1 to 4 channels, has " + std::to_string(array.shape(2)));
  ImageTexture texture;
  texture.image.width = static_cast<int>(array.shape(1));
  texture.image.height = static_cast<int>(array.shape(0));
  texture.image.channels = static_cast<int>(array.shape(2));
  texture.image.pixels.assign(array.data(), array.data() + array.size());
  return texture;
}

}  // namespace

void register_textures(py::module_& m) {
  py::class_<TextureRef>(m, "TextureRef", "Stands for Scene.textures[index] where a colour may vary.")
      .def(py::init([](std::uint32_t index) { return TextureRef{index}; }), py::arg("index"))
      .def_readonly("index", &TextureRef::index)
      .def("__eq__",
           [](const TextureRef& self, const py::object& other) {
             return py::isinstance<TextureRef>(other) && other.cast<const TextureRef&>().index == self.index;
           })
      .def("__hash__", [](const TextureRef& self) { return py::hash(py::int_(self.index)); })
      .def("__repr__", [](const TextureRef& self) { return "TextureRef(" + std::to_string(self.index) + ")"; });

  bind_described<ConstantTexture>(m, "ConstantTexture", "The same colour everywhere.");
  bind_described<CheckerboardTexture>(m, "CheckerboardTexture", "Squares of two colours over uv.");
  py::class_<ImageTexture>(m, "ImageTexture",
                           "A picture over uv, bilinear and repeated.\n\n"
                           "pixels: (height, width, 1 to 4) float32, scene-linear, row 0 at the bottom. Copied.")
      .def(py::init(&make_image_texture), py::arg("pixels"))
      .def_property_readonly(
          "pixels",
          [](const py::object& self) {
            const Image& image = self.cast<const ImageTexture&>().image;
            return read_only_view(image.pixels.data(), {image.height, image.width, image.channels}, self);
          },
          "(height, width, channels) float32, scene-linear, row 0 at the bottom; read-only")
      .def("__repr__", [](const ImageTexture& self) {
        return "<ImageTexture of " + std::to_string(self.image.width) + " x " + std::to_string(self.image.height) +
               " pixels>";
      });
}

}  // namespace basicrt::bindings
