// SPDX-License-Identifier: GPL-3.0-or-later
// Reading scene files; the package's load_scene() is the public face.
#include <pybind11/typing.h>

#include <algorithm>

#include "arrays.h"
#include "errors.h"
#include "io/image_file.h"
#include "io/scene_json.h"
#include "path_argument.h"
#include "register.h"
#include "scene_lease.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

using ExrReader = py::typing::Callable<ArrayLike(py::str)>;

bool is_exr(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".exr";
}

// EXR files are Python's business, so that the module carries no OpenEXR.
Image read_exr_in_python(const std::filesystem::path& path, const ExrReader& read_exr) {
  const py::gil_scoped_acquire acquire;
  const py::array_t<float> pixels =
      float_array(read_exr(path.string()), path.string(), {{any_length, any_length, any_length}});
  return {.width = static_cast<int>(pixels.shape(1)),
          .height = static_cast<int>(pixels.shape(0)),
          .channels = static_cast<int>(pixels.shape(2)),
          .pixels = std::vector<float>(pixels.data(), pixels.data() + pixels.size()),
          .path = path.string()};
}

BoundScene load(const PathArgument& argument, const std::string& override_json, const ExrReader& read_exr) {
  const std::filesystem::path path = argument.read();
  const SceneFileOptions options{.override_json = override_json,
                                 .read_image = [&read_exr](const std::filesystem::path& image) {
                                   return is_exr(image) ? read_exr_in_python(image, read_exr) : read_image_file(image);
                                 }};
  Report report;
  Scene scene;
  {
    const py::gil_scoped_release release;
    scene = load_scene(path, report, options);
  }
  issue_warnings(report, 2);
  return BoundScene(std::move(scene));
}

}  // namespace

void register_io(py::module_& m) {
  m.def("load_scene", &load, py::arg("path"), py::arg("override_json"), py::arg("read_exr"),
        "Reads a scene file; override_json is merged into it first. read_exr(path) gives (height, width, channels)\n"
        "float32, row 0 at the bottom.");
}

}  // namespace basicrt::bindings
