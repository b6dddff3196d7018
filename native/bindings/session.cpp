// SPDX-License-Identifier: GPL-3.0-or-later
// Session: Python pulls finished tiles; native threads never enter Python.
#include "render/session.h"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "base/error.h"
#include "described.h"
#include "register.h"
#include "scene/memory.h"
#include "scene_lease.h"

namespace basicrt::bindings {
namespace py = pybind11;

namespace {

using Seconds = std::chrono::duration<double>;

// How long a wait may go without asking Python for signals (Ctrl-C).
constexpr Seconds signal_interval{0.1};

// A session as Python holds it: what can still be asked of it once its threads are joined stays here. All members
// are guarded by the GIL.
class BoundSession {
 public:
  BoundSession(PreparedScene scene, SessionOptions options, std::optional<Baking> baking)
      : memory_(memory_of(scene)),
        session_(std::make_unique<Session>(std::move(scene), options, std::move(baking))),
        rect_(session_->rect()) {}

  // Waits for a tile with the GIL released. Nothing: the time is up. Ends the iteration where there are no more.
  std::optional<Tile> next_tile(Seconds timeout) {
    const auto end = std::chrono::steady_clock::now() + std::min(timeout, Seconds(1e6));
    while (true) {
      if (!session_ || session_->is_done()) throw py::stop_iteration();
      const Seconds remaining = end - std::chrono::steady_clock::now();
      if (std::optional<Tile> tile = wait(std::clamp(remaining, Seconds(0), signal_interval))) return tile;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (remaining <= signal_interval && session_ && !session_->is_done()) return std::nullopt;
    }
  }

  void stop() {
    if (session_) session_->stop();
  }

  // Stops and joins the threads, with the GIL released.
  void close() {
    if (!session_) return;
    was_stopped_ = is_stopped() || !session_->is_done();
    stop();
    while (waiting_ > 0) {
      const py::gil_scoped_release release;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!session_) return;  // another thread closed it meanwhile
    last_progress_ = session_->progress();
    std::unique_ptr<Session> session = std::move(session_);
    const py::gil_scoped_release release;
    session.reset();
  }

  [[nodiscard]] bool is_stopped() const { return session_ ? session_->is_stopped() : was_stopped_; }
  [[nodiscard]] Progress progress() const { return session_ ? session_->progress() : last_progress_; }
  [[nodiscard]] PixelRect rect() const { return rect_; }
  [[nodiscard]] SceneMemory memory() const { return memory_; }

 private:
  std::optional<Tile> wait(Seconds timeout) {
    struct Waiting {
      int& count;
      explicit Waiting(int& count_) : count(count_) { ++count; }
      ~Waiting() { --count; }
    } const waiting(waiting_);
    const py::gil_scoped_release release;
    return session_->next_tile(timeout);
  }

  SceneMemory memory_;
  std::unique_ptr<Session> session_;  // none after close()
  PixelRect rect_;
  Progress last_progress_;
  bool was_stopped_ = false;
  int waiting_ = 0;  // threads in wait(): the session must outlive them
};

using PreparingCallback = std::optional<py::typing::Callable<void(double)>>;

// Builds the trees with the GIL released, but for asking Python for signals and telling `preparing` how far it is.
PreparedScene prepare_for_python(const Scene& scene, Report& report, int threads, const PreparingCallback& preparing) {
  const auto watch = [&](double fraction) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (preparing) (*preparing)(fraction);
    return true;
  };
  const py::gil_scoped_release release;
  return prepare_watched(scene, report, threads, watch);
}

// Baking needs no camera, but the scene does: one stands in for it.
class StandInCamera {
 public:
  StandInCamera(BoundScene& scene, bool is_needed) : scene_(scene), is_needed_(is_needed && !scene.scene().camera) {
    if (is_needed_) scene_.edit().camera = OrthographicCamera{};
  }
  ~StandInCamera() {
    if (is_needed_) scene_.edit().camera.reset();
  }
  StandInCamera(const StandInCamera&) = delete;
  StandInCamera& operator=(const StandInCamera&) = delete;

 private:
  BoundScene& scene_;
  bool is_needed_;
};

std::unique_ptr<BoundSession> start_session(BoundScene& scene, int threads, int tile_size,
                                            const PreparingCallback& preparing,
                                            const std::optional<BakeTarget>& bake_target,
                                            const BakeSettings& bake_settings) {
  if (threads < 0) throw SceneError("Session.threads", "must be at least 0, is " + std::to_string(threads));
  if (tile_size < 1) throw SceneError("Session.tile_size", "must be at least 1, is " + std::to_string(tile_size));
  Report report;
  PreparedScene prepared;
  std::optional<Baking> baking;
  if (bake_target) validate(*bake_target, bake_settings, SceneLease(scene).scene());
  {
    const StandInCamera camera(scene, bake_target.has_value());
    const SceneLease lease(scene);
    prepared = prepare_for_python(lease.scene(), report, threads, preparing);
    if (bake_target) baking.emplace(*bake_target, bake_settings, lease.scene(), prepared);
  }
  issue_warnings(report, 1);
  return std::make_unique<BoundSession>(std::move(prepared), SessionOptions{.threads = threads, .tile_size = tile_size},
                                        std::move(baking));
}

struct TileIterator {
  BoundSession* session;
  Seconds poll_time;
};

py::array_t<float> pass_of(const py::object& self, const std::string& name) {
  Tile& tile = self.cast<Tile&>();
  for (const PassInfo& info : passes)
    if (info.name == name && tile.layout.has(info.pass))
      return py::array_t<float>(
          std::vector<py::ssize_t>{tile.rect.height, tile.rect.width, static_cast<py::ssize_t>(info.channels.size())},
          tile.values.data() + tile.pass_begin(info.pass), self);
  throw py::key_error(name);
}

std::vector<std::string> pass_names(const Tile& tile) {
  std::vector<std::string> names;
  for (const PassInfo& info : passes)
    if (tile.layout.has(info.pass)) names.emplace_back(info.name);
  return names;
}

std::optional<py::array_t<std::uint32_t>> sums_of(const py::object& self) {
  Tile& tile = self.cast<Tile&>();
  if (tile.sums.empty()) return std::nullopt;
  const std::size_t pixels = static_cast<std::size_t>(tile.rect.width) * tile.rect.height;
  return py::array_t<std::uint32_t>(
      std::vector<py::ssize_t>{tile.rect.height, tile.rect.width, static_cast<py::ssize_t>(tile.sums.size() / pixels)},
      tile.sums.data(), self);
}

Tile merge_sums(const std::vector<py::array_t<std::uint32_t, py::array::c_style>>& parts,
                const std::vector<std::string>& names, int samples, float negative_mass, bool has_shadow_catchers) {
  if (parts.empty()) throw SceneError("merge_sums.parts", "there are none");
  PassLayout layout;
  for (const PassInfo& info : passes)
    if (std::ranges::find(names, info.name) != names.end()) layout.enable(info.pass);
  const auto& first = parts.front();
  if (first.ndim() != 3) throw SceneError("merge_sums.parts", "must have the shape (height, width, words)");
  TileAccumulator accumulator(
      {0, 0, static_cast<int>(first.shape(1)), static_cast<int>(first.shape(0))}, layout,
      {.negative_mass = negative_mass, .has_shadow_catchers = has_shadow_catchers, .samples = samples});
  for (const auto& part : parts) {
    if (part.ndim() != 3 || part.shape(0) != first.shape(0) || part.shape(1) != first.shape(1) ||
        static_cast<std::size_t>(part.shape(2)) != accumulator.words_per_pixel())
      throw SceneError("merge_sums.parts", "are not of the same picture");
    accumulator.add_words({part.data(), static_cast<std::size_t>(part.size())});
  }
  std::vector<std::uint32_t> sums = accumulator.take_words();
  Tile tile = accumulator.finish();
  tile.sums = std::move(sums);
  return tile;
}

void bind_tile(py::module_& m) {
  py::class_<Tile>(m, "Tile", "Finished pixels of a rectangle, in the whole picture's coordinates: (0, 0) lower left.")
      .def_property_readonly("x", [](const Tile& tile) { return tile.rect.x; })
      .def_property_readonly("y", [](const Tile& tile) { return tile.rect.y; })
      .def_property_readonly("width", [](const Tile& tile) { return tile.rect.width; })
      .def_property_readonly("height", [](const Tile& tile) { return tile.rect.height; })
      .def_property_readonly("passes", &pass_names)
      .def_property_readonly("sums", &sums_of,
                             "Of a range of the samples: (height, width, words) uint32, which merge_sums() adds up. "
                             "None where all samples "
                             "are rendered. Not a copy.")
      .def("__getitem__", &pass_of, py::arg("name"),
           "The pass as (height, width, channels) float32, C-contiguous, row 0 at the bottom. Not a copy.")
      .def("__repr__", [](const Tile& tile) {
        return "<Tile of " + std::to_string(tile.rect.width) + " x " + std::to_string(tile.rect.height) + " at (" +
               std::to_string(tile.rect.x) + ", " + std::to_string(tile.rect.y) + ")>";
      });
}

void bind_merging(py::module_& m) {
  m.def("merge_sums", &merge_sums, py::arg("parts"), py::arg("passes"), py::arg("samples"), py::arg("negative_mass"),
        py::arg("has_shadow_catchers"),
        "The picture of all samples that several Tile.sums, in their order, have together. The rest is as in "
        "Scene.range_metadata(). Raises SceneError.");
}

void bind_progress(py::module_& m) {
  py::class_<Progress>(m, "Progress", "How far a session is.")
      .def_readonly("fraction", &Progress::fraction, "of all samples, or of the time there is for them; never falls")
      .def_readonly("samples_per_second", &Progress::samples_per_second)
      .def_readonly("elapsed_seconds", &Progress::elapsed_seconds)
      .def_readonly("remaining_seconds", &Progress::remaining_seconds, "a guess from the rate so far")
      .def_readonly("samples_per_pixel", &Progress::samples_per_pixel, "the mean of those taken so far")
      .def_readonly("is_time_up", &Progress::is_time_up, "the time limit ended it before all samples were taken")
      .def_readonly("is_done", &Progress::is_done, "every tile was handed out, or it was stopped")
      .def("__repr__",
           [](const Progress& progress) { return "<Progress " + std::to_string(100 * progress.fraction) + " %>"; });
}

}  // namespace

void register_session(py::module_& m) {
  bind_tile(m);
  bind_progress(m);
  bind_merging(m);
  py::class_<TileIterator>(m, "TileIterator", "What Session.tiles() returns.")
      .def(
          "__iter__", [](TileIterator& self) -> TileIterator& { return self; }, py::return_value_policy::reference)
      .def("__next__", [](const TileIterator& self) { return self.session->next_tile(self.poll_time); });
  py::class_<BoundSession>(m, "Session", R"(Renders a scene with native threads, which start at once.

Prepares the scene first and keeps its own copy of it. threads: 0 is one for each processor. The values depend on
neither threads nor tile_size. preparing is called with the fraction done, from 0 to 1, several times in 100 ms while a
long preparation goes on; what it raises ends that and is raised again. Raises SceneError for a scene that can't be rendered, MemoryError where memory runs
out; warns with SceneWarning. With bake_target the picture is of places on a mesh instead of what the camera sees; see
bake(). As a context manager it stops and joins its threads at the end.)")
      .def(py::init(&start_session), py::arg("scene"), py::kw_only(), py::arg("threads") = 0, py::arg("tile_size") = 64,
           py::arg("preparing") = py::none(), py::arg("bake_target") = py::none(),
           py::arg("bake_settings") = BakeSettings{})
      .def(
          "tiles",
          [](BoundSession& self, double poll_seconds) {
            if (!(poll_seconds >= 0)) throw SceneError("poll_seconds", "must be at least 0");
            return TileIterator{&self, Seconds(poll_seconds)};
          },
          py::arg("poll_seconds") = 0.1, py::keep_alive<0, 1>(),
          "Iterates over tiles as they are finished. Yields None when poll_seconds pass without one, so that the "
          "caller\n"
          "can look at other things. Ends when all were handed out, or after stop().")
      .def("stop", &BoundSession::stop, "No further tile is finished. Any thread may call it, at any time.")
      .def_property_readonly("is_stopped", &BoundSession::is_stopped)
      .def_property_readonly("progress", &BoundSession::progress)
      .def_property_readonly("memory", &BoundSession::memory, "SceneMemory of what is rendered")
      .def_property_readonly(
          "tree_bytes", [](const BoundSession& self) { return self.memory().trees; },
          "memory of the trees that rays walk, with the triangles that they hold")
      .def_property_readonly(
          "rect",
          [](const BoundSession& self) {
            const PixelRect rect = self.rect();
            return std::tuple(rect.x, rect.y, rect.width, rect.height);
          },
          "(x, y, width, height) of the border or the whole picture, pixels, (0, 0) at the lower left")
      .def(
          "__enter__", [](BoundSession& self) -> BoundSession& { return self; }, py::return_value_policy::reference)
      .def("__exit__",
           [](BoundSession& self, const py::object&, const py::object&, const py::object&) { self.close(); });
}

}  // namespace basicrt::bindings
