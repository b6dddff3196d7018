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

void check_channels(const py::array& array) {
  if (array.size() == 0) throw SceneError("pixels", "must not be empty");
  if (array.shape(2) > 4)
    throw SceneError("pixels", "must have 1 to 4 channels, has " + std::to_string(array.shape(2)));
}

bool is_byte_array(const ArrayLike& value) {
  return py::isinstance<py::array>(value) && value.cast<py::array>().dtype().is(py::dtype::of<std::uint8_t>());
}

Image make_image(const ArrayLike& pixels, ByteEncoding encoding) {
  Image image;
  const auto fill = [&](const auto& array, auto& numbers) {
    check_channels(array);
    image.height = static_cast<int>(array.shape(0));
    image.width = static_cast<int>(array.shape(1));
    image.channels = static_cast<int>(array.shape(2));
    numbers = std::vector(array.data(), array.data() + array.size());
  };
  image.encoding = encoding;
  if (!is_byte_array(pixels)) {
    fill(float_array(pixels, "pixels", {{any_length, any_length, any_length}}), image.pixels);
    return image;
  }
  const py::array_t<std::uint8_t, py::array::c_style> bytes(pixels);
  if (bytes.ndim() != 3)
    throw SceneError("pixels", "must have the shape (N, N, N), has " + std::to_string(bytes.ndim()) + " dimensions");
  fill(bytes, image.bytes);
  return image;
}

// What an argument that stands for an image is one of: an Image, or an array of pixels.
Image read_image(py::handle value) {
  if (py::isinstance<Image>(value)) return value.cast<const Image&>();
  return make_image(py::reinterpret_borrow<ArrayLike>(value), ByteEncoding::srgb);
}

py::object pixels_of(const py::object& self) {
  const auto& image = self.cast<const Image&>();
  const ArrayShape shape{image.height, image.width, image.channels};
  if (image.bytes.empty()) return read_only_view(image.pixels.data(), shape, self);
  return read_only_view(image.bytes.data(), shape, self);
}

std::string to_text(const Image& image) {
  return "<Image of " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels>";
}

void register_image(py::module_& m) {
  py::class_<Image>(m, "Image",
                    "A picture, which textures and the environment share.\n\n"
                    "pixels: (height, width, 1 to 4), row 0 at the bottom: float32, scene-linear; or uint8, where 255\n"
                    "is 1, as `encoding` says: \"srgb\" or \"linear\". Copied.")
      .def(py::init([](const ArrayLike& pixels, const std::string& encoding) {
             return make_image(pixels, PythonValue<ByteEncoding>::read(py::str(encoding), "Image.encoding"));
           }),
           py::arg("pixels"), py::arg("encoding") = "srgb")
      .def_property_readonly("pixels", &pixels_of,
                             "(height, width, channels), row 0 at the bottom: float32 or uint8; read-only")
      .def_property_readonly(
          "encoding", [](const Image& self) { return enum_names<ByteEncoding>[static_cast<int>(self.encoding)]; },
          "what uint8 pixels mean")
      .def("__repr__", &to_text);
}

void register_image_texture(py::module_& m) {
  std::vector<Attribute<ImageTexture>> attributes = attributes_of<ImageTexture>();
  attributes.insert(attributes.begin(),
                    {"image", "an Image, or its pixels", "basicrt._native.Image | numpy.typing.ArrayLike",
                     "basicrt._native.Image", [](const ImageTexture& self) { return py::cast(self.image); },
                     [](ImageTexture& self, py::handle value, const std::string&) { self.image = read_image(value); }});
  bind_fields<ImageTexture>(m, "ImageTexture", "A picture over uv.", attributes);
}

}  // namespace

void register_textures(py::module_& m) {
  py::class_<TextureRef>(m, "TextureRef",
                         "Stands for Scene.textures[index] where a colour or a share may vary. As a share it is the\n"
                         "texture's luminance or, with `alpha`, its alpha.")
      .def(py::init([](std::uint32_t index, bool is_alpha) { return TextureRef{index, is_alpha}; }), py::arg("index"),
           py::arg("alpha") = false)
      .def_readonly("index", &TextureRef::index)
      .def_readonly("alpha", &TextureRef::is_alpha)
      .def("__eq__",
           [](const TextureRef& self, const py::object& other) {
             return py::isinstance<TextureRef>(other) && other.cast<const TextureRef&>() == self;
           })
      .def("__hash__", [](const TextureRef& self) { return py::hash(py::make_tuple(self.index, self.is_alpha)); })
      .def("__repr__", [](const TextureRef& self) {
        return "TextureRef(" + std::to_string(self.index) + (self.is_alpha ? ", alpha=True)" : ")");
      });

  bind_described<ConstantTexture>(m, "ConstantTexture", "The same colour everywhere.");
  bind_described<CheckerboardTexture>(m, "CheckerboardTexture", "Squares of two colours over uv.");
  register_image(m);
  register_image_texture(m);
}

}  // namespace basicrt::bindings
