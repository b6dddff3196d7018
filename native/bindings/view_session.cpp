// SPDX-License-Identifier: GPL-3.0-or-later
// ViewSession: Python sets scenes and views, and asks now and then for the newest picture.
#include "render/view_session.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "base/error.h"
#include "described.h"
#include "register.h"
#include "scene_lease.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

Pass pass_named(const std::string& place, const std::string& name) {
  for (const PassInfo& info : passes)
    if (info.name == name) return info.pass;
  throw SceneError("ViewSession.set_view." + place, "there is no pass \"" + name + "\"");
}

// The session, and the lease of the scene that it prepares. All members are guarded by the GIL.
class BoundViewSession {
 public:
  explicit BoundViewSession(int threads) : session_(std::make_unique<ViewSession>(threads)) {}
  ~BoundViewSession() { close(); }
  BoundViewSession(const BoundViewSession&) = delete;
  BoundViewSession& operator=(const BoundViewSession&) = delete;

  void set_scene(const py::object& scene) {
    if (status().is_preparing) throw std::runtime_error("ViewSession: it is still preparing a scene");
    lease_.emplace(scene.cast<BoundScene&>());
    scene_ = scene;
    open().set_scene(lease_->scene());
  }
  void set_view(const Camera& camera, const RenderSettings& settings, const std::string& pass_name,
                const std::vector<std::string>& further_passes) {
    View view{.camera = camera, .settings = settings, .pass = pass_named("pass_name", pass_name)};
    for (std::size_t i = 0; i < further_passes.size(); ++i)
      view.further_passes.push_back(pass_named("further_passes[" + std::to_string(i) + "]", further_passes[i]));
    open().set_view(std::move(view));
  }
  void set_paused(bool is_paused) { open().set_paused(is_paused); }

  [[nodiscard]] std::optional<ViewPicture> take_picture() { return open().take_picture(); }
  [[nodiscard]] bool has_picture() { return open().has_picture(); }
  [[nodiscard]] std::uint64_t revision() { return open().revision(); }
  // Ends the lease where the scene has been read.
  [[nodiscard]] ViewStatus status() {
    try {
      const ViewStatus status = open().status();
      if (!status.is_preparing) lease_.reset();
      return status;
    } catch (const std::exception&) {
      lease_.reset();
      throw;
    }
  }
  [[nodiscard]] std::optional<SceneMemory> memory() { return open().memory(); }
  [[nodiscard]] std::vector<std::string> take_warnings() { return open().take_warnings().warnings(); }

  void close() {
    if (!session_) return;
    std::unique_ptr<ViewSession> session = std::move(session_);
    {
      const py::gil_scoped_release release;
      session.reset();
    }
    lease_.reset();
    scene_ = py::none();
  }

 private:
  ViewSession& open() {
    if (!session_) throw std::runtime_error("ViewSession: it is closed");
    return *session_;
  }

  py::object scene_;
  std::optional<SceneLease> lease_;
  std::unique_ptr<ViewSession> session_;  // none after close()
};

// A view of the pixels, which live as long as the array does.
py::array_t<float> pixels_of(const py::object& self) {
  const auto& picture = self.cast<const ViewPicture&>();
  return py::array_t<float>(std::vector<py::ssize_t>{picture.rect.height, picture.rect.width, 4}, picture.rgba.data(),
                            self);
}

py::array_t<float> pass_of(const py::object& self, const std::string& name) {
  const auto& picture = self.cast<const ViewPicture&>();
  for (const ViewPass& made : picture.further) {
    const PassInfo& info = pass_info(made.pass);
    if (info.name == name)
      return py::array_t<float>(std::vector<py::ssize_t>{picture.rect.height, picture.rect.width,
                                                         static_cast<py::ssize_t>(info.channels.size())},
                                made.values.data(), self);
  }
  throw py::key_error(name);
}

std::vector<std::string> pass_names(const ViewPicture& picture) {
  std::vector<std::string> names;
  for (const ViewPass& made : picture.further) names.emplace_back(pass_info(made.pass).name);
  return names;
}

void bind_picture(py::module_& m) {
  py::class_<ViewPicture>(m, "ViewPicture", "What a view shows at some time.")
      .def_property_readonly("pixels", &pixels_of,
                             "(height, width, 4) float32, row 0 at the bottom, alpha associated. Not a copy.")
      .def_property_readonly(
          "rect",
          [](const ViewPicture& self) {
            return std::tuple(self.rect.x, self.rect.y, self.rect.width, self.rect.height);
          },
          "(x, y, width, height) among the film's pixels, which are larger in a first picture")
      .def_property_readonly(
          "film_size", [](const ViewPicture& self) { return std::tuple(self.film_width, self.film_height); },
          "(width, height) of all that the view could show, in this picture's pixels")
      .def_readonly("samples", &ViewPicture::samples, "of each pixel; 0 where pixels are larger than the view's")
      .def_readonly("revision", &ViewPicture::revision, "of the session when this picture was begun")
      .def_property_readonly("further_passes", &pass_names,
                             "those that the view has; none where pixels are larger than its own")
      .def("__getitem__", &pass_of, py::arg("name"),
           "The further pass as (height, width, channels) float32, row 0 at the bottom. Not a copy.");
}

void bind_status(py::module_& m) {
  py::class_<ViewStatus>(m, "ViewStatus", "How far a view is.")
      .def_readonly("is_preparing", &ViewStatus::is_preparing, "the scene that was set last is being read")
      .def_readonly("prepared_fraction", &ViewStatus::prepared_fraction)
      .def_readonly("samples", &ViewStatus::samples, "of each pixel of the newest picture")
      .def_readonly("samples_end", &ViewStatus::samples_end, "where refinement ends")
      .def_readonly("elapsed_seconds", &ViewStatus::elapsed_seconds, "since the view was set")
      .def_readonly("is_done", &ViewStatus::is_done, "nothing more comes until something is set");
}

}  // namespace

void register_view_session(py::module_& m) {
  bind_picture(m);
  bind_status(m);
  py::class_<BoundViewSession>(m, "ViewSession", R"(Shows a scene that is being worked on.

Works on native threads of its own, and no call waits for them. Pictures are of the whole view: coarse ones at once,
then ones of more and more samples. A picture of up to 64 samples has the values of a render with so many. One thread
makes the calls.)")
      .def(py::init([](int threads) {
             if (threads < 0)
               throw SceneError("ViewSession.threads", "must be at least 0, is " + std::to_string(threads));
             return std::make_unique<BoundViewSession>(threads);
           }),
           py::arg("threads") = 0)
      .def("set_scene", &BoundViewSession::set_scene, py::arg("scene"),
           "Shows this scene; of the same object as before only what has changed is prepared again. Until status says "
           "that it is no longer preparing, the scene can't be changed, nor this be called.")
      .def("set_view", &BoundViewSession::set_view, py::arg("camera"), py::arg("settings"),
           py::arg("pass_name") = "Combined", py::arg("further_passes") = std::vector<std::string>(),
           "Looks at the scene with this camera; settings.samples is where refinement ends. Pictures bring the values "
           "of "
           "further passes along. Raises SceneError.")
      .def("set_paused", &BoundViewSession::set_paused, py::arg("is_paused"),
           "Takes no more samples, or goes on with them.")
      .def("take_picture", &BoundViewSession::take_picture,
           "The newest picture, None where it was taken already or there is none yet.")
      .def_property_readonly("has_picture", &BoundViewSession::has_picture, "there is one to take")
      .def_property_readonly("revision", &BoundViewSession::revision,
                             "how often scenes and views were set; a picture of another one shows what was to be seen "
                             "before")
      .def_property_readonly("status", &BoundViewSession::status,
                             "Raises SceneError, once, where the scene can't be rendered.")
      .def_property_readonly("memory", &BoundViewSession::memory,
                             "SceneMemory of the scene that was prepared last, None until one was")
      .def("take_warnings", &BoundViewSession::take_warnings,
           "What preparing the scene had to say since the last call.")
      .def("close", &BoundViewSession::close, "Stops and joins the threads.");
}

}  // namespace basicrt::bindings
