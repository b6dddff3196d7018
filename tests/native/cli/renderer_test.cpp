// SPDX-License-Identifier: GPL-3.0-or-later
// The renderer as a shell sees it: files, messages, exit status.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "io/exr.h"
#include "io/file.h"
#include "io/temporary_folder.h"

extern char** environ;

namespace basicrt {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

const char* const small_scene = R"({
  "integrator": {"type": "path", "spp": 4, "max_depth": 4}, "film": {"resolution": [12, 8]},
  "camera": {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 40},
  "environment": {"radiance": [1, 1, 1]},
  "materials": {"grey": {"type": "diffuse", "color": [0.5, 0.5, 0.5]}},
  "objects": [{"type": "sphere", "material_name": "grey"}]})";

class Renderer : public testing::Test {
 protected:
  // Starts it in the folder, its messages going to messages.txt there.
  pid_t start(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {BASICRT_RENDERER};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    const std::string messages = messages_path().string();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, work_.path().c_str());
    posix_spawn_file_actions_addopen(&actions, 2, messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, 1, messages.c_str(), O_WRONLY | O_APPEND, 0600);
    pid_t process = 0;
    EXPECT_EQ(posix_spawn(&process, BASICRT_RENDERER, &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    return process;
  }
  // The exit status, or minus the signal that ended it.
  static int wait_for(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::vector<std::string>& arguments) const { return wait_for(start(arguments)); }

  [[nodiscard]] std::filesystem::path messages_path() const { return logs_.path() / "messages.txt"; }
  [[nodiscard]] std::string messages() const { return read_file(messages_path()); }
  void write_scene(std::string_view json) const { work_.write("scene.json", json); }
  // One error in one line, exit status 1, and nothing written.
  void expect_failure(const std::vector<std::string>& arguments, const std::string& message) const {
    const std::vector<std::string> files = work_.files();
    EXPECT_EQ(run(arguments), 1);
    EXPECT_TRUE(messages().starts_with("renderer: " + message)) << messages();
    EXPECT_EQ(messages().find('\n'), messages().size() - 1) << messages();
    EXPECT_EQ(work_.files(), files);
  }

  const TemporaryFolder work_, logs_;
};

TEST_F(Renderer, the_default_output_is_the_scene_s_name_in_the_current_folder) {
  write_scene(small_scene);
  std::filesystem::create_directory(work_.path() / "deep");
  std::filesystem::rename(work_.path() / "scene.json", work_.path() / "deep/ball.json");
  ASSERT_EQ(run({"deep/ball.json", "-q"}), 0) << messages();
  EXPECT_EQ(messages(), "");
  EXPECT_EQ(work_.files(), (std::vector<std::string>{"ball.exr", "deep"}));
  const Image image = read_exr(work_.path() / "ball.exr");
  EXPECT_EQ(image.width, 12);
  EXPECT_EQ(image.height, 8);
}

TEST_F(Renderer, the_same_bytes_come_from_any_number_of_threads_and_any_tile_size) {
  write_scene(small_scene);
  ASSERT_EQ(run({"scene.json", "-q", "-o", "a.exr", "--threads", "1", "--tile-size", "64"}), 0) << messages();
  ASSERT_EQ(run({"scene.json", "-q", "-o", "b.exr", "--threads", "5", "--tile-size", "3"}), 0) << messages();
  EXPECT_EQ(read_file(work_.path() / "a.exr"), read_file(work_.path() / "b.exr"));
}

TEST_F(Renderer, options_change_the_scene) {
  write_scene(small_scene);
  ASSERT_EQ(run({"-q", "--override", R"({"film": {"resolution": [6, 4]}, "objects": []})", "--spp=2", "scene.json",
                 "--output=a.exr"}),
            0)
      << messages();
  const Image image = read_exr(work_.path() / "a.exr");
  EXPECT_EQ(image.width, 6);
  for (const float value : image.pixels) EXPECT_TRUE(value == 1 || value == 0) << value;  // all environment
  // The header's attribute: name, type, size, text.
  const std::string attribute = "samples\0string\0\1\0\0\0"s + "2";
  EXPECT_NE(read_file(work_.path() / "a.exr").find(attribute), std::string::npos);
}

TEST_F(Renderer, progress_and_warnings_go_to_stderr_unless_quiet) {
  write_scene(small_scene);
  ASSERT_EQ(run({"scene.json", "--override", R"({"integrator": {"type": "bdpt"}})"}), 0);
  EXPECT_TRUE(messages().starts_with("warning: integrator: there is no \"bdpt\" yet")) << messages();
  EXPECT_NE(messages().find("100.0 %"), std::string::npos) << messages();
}

TEST_F(Renderer, an_empty_scene_renders_its_environment_with_a_warning) {
  write_scene(R"({"camera": {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 40},
                  "settings": {"width": 4, "height": 4, "samples": 1}, "environment": {"radiance": [0.5, 0.25, 2]}})");
  ASSERT_EQ(run({"scene.json"}), 0) << messages();
  EXPECT_TRUE(messages().starts_with("warning: objects: the scene has none\n")) << messages();
  const Image image = read_exr(work_.path() / "scene.exr");
  EXPECT_EQ(std::vector<float>(image.pixel(1, 2), image.pixel(1, 2) + 3), (std::vector<float>{0.5f, 0.25f, 2}));
}

TEST_F(Renderer, triangles_without_area_are_left_out_with_a_warning) {
  write_scene(R"({"camera": {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 40},
    "settings": {"width": 4, "height": 4, "samples": 1},
    "objects": [{"type": "mesh", "positions": [0,0,0, 1,0,0, 2,0,0], "triangles": [0,1,2, 0,0,1]}]})");
  ASSERT_EQ(run({"scene.json"}), 0) << messages();
  EXPECT_TRUE(messages().starts_with("warning: ")) << messages();
  EXPECT_EQ(work_.files(), (std::vector<std::string>{"scene.exr", "scene.json"}));
}

TEST_F(Renderer, an_empty_mesh_is_skipped_with_a_warning) {
  write_scene(R"({"camera": {"position": [0, 0, 4], "look_at": [0, 0, 0], "fov": 40},
    "settings": {"width": 4, "height": 4, "samples": 1},
    "objects": [{"type": "mesh", "positions": [], "triangles": []}, {"type": "sphere"}]})");
  ASSERT_EQ(run({"scene.json"}), 0) << messages();
  EXPECT_TRUE(messages().starts_with("warning: objects[0]: skipped: the mesh has no triangles\n")) << messages();
  EXPECT_EQ(messages().find("warning", 1), std::string::npos) << messages();
}

TEST_F(Renderer, bad_scenes_are_one_error_each) {
  expect_failure({"none.json"}, "none.json: can't be opened: No such file or directory");
  write_scene("{\"film\": ");
  expect_failure({"scene.json"}, "scene.json:1:10: ");
  write_scene(R"({"materials": {"glas": {"type": "glass", "etta": 2}}})");
  expect_failure({"scene.json"}, "materials.glas.etta: unknown key; did you mean \"eta\"?");
  write_scene("{}");
  expect_failure({"scene.json", "-q"}, "camera: the scene has none");
  write_scene(small_scene);
  expect_failure({"scene.json", "--override", R"({"film": {"resolution": [0, 8]}})"},
                 "film.resolution[0]: must be in [1, 65536], is 0");
  expect_failure({"scene.json", "--override", "{"}, "override:1:2: ");
  expect_failure({"scene.json", "--override",
                  R"({"objects": [{"type": "sphere", "transform": [1,0,0,0, 0,0,0,0, 0,0,1,0, 0,0,0,1]}]})"},
                 "instances[0].transform: is singular");
  expect_failure({"scene.json", "--override", R"({"objects": [{"type": "mesh", "path": "none.obj"}]})"},
                 "none.obj: can't be opened");
}

TEST_F(Renderer, an_output_that_can_t_be_written_is_found_before_rendering) {
  write_scene(small_scene);
  const std::vector<std::string> slow = {"scene.json", "--spp", "16777216", "-o"};  // would take hours
  std::vector<std::string> arguments = slow;
  arguments.emplace_back("none/a.exr");
  expect_failure(arguments, "none/a.exr: can't be written: No such file or directory");
  std::filesystem::create_directory(work_.path() / "folder.exr");
  arguments.back() = "folder.exr";
  expect_failure(arguments, "folder.exr: can't be written: Is a directory");
}

TEST_F(Renderer, a_picture_larger_than_memory_is_an_error) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve more addresses than the limit allows";
#endif
  write_scene(small_scene);
  // A limit of its own, lest the machine tries.
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  const rlimit limited{.rlim_cur = rlim_t{2} << 30, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_AS, &limited);
  expect_failure({"scene.json", "-q", "--override", R"({"film": {"resolution": [65536, 65536]}})"},
                 "there is not enough memory");
  setrlimit(RLIMIT_AS, &before);
}

TEST_F(Renderer, wrong_arguments_show_the_usage) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"a.json", "b.json"},
                                                    {"a.json", "--fast"},
                                                    {"a.json", "--spp"},
                                                    {"a.json", "--spp", "-3"},
                                                    {"a.json", "--spp", "2x"},
                                                    {"a.json", "--threads", "99999999999"}}) {
    EXPECT_EQ(run(arguments), 2);
    EXPECT_TRUE(messages().starts_with("renderer: ")) << messages();
    EXPECT_NE(messages().find("\nusage: renderer scene.json"), std::string::npos) << messages();
  }
  EXPECT_EQ(run({"--help"}), 0);
  EXPECT_TRUE(messages().starts_with("usage: ")) << messages();
}

TEST_F(Renderer, an_interrupt_ends_it_soon_and_writes_nothing) {
  write_scene(small_scene);
  const pid_t process = start({"scene.json", "--spp", "16777216", "-q"});
  // Until it catches SIGINT (bit 1 of SigCgt), and then until it renders.
  const std::filesystem::path status = "/proc/" + std::to_string(process) + "/status";
  if (!std::filesystem::exists(status)) GTEST_SKIP() << "there is no /proc here";
  for (int i = 0; i < 600; ++i) {
    const std::string text = read_file(status);
    const std::size_t mask = text.find("SigCgt:");
    if (std::stoull(text.substr(mask + 7), nullptr, 16) & (1u << (SIGINT - 1))) break;
    std::this_thread::sleep_for(100ms);
  }
  std::this_thread::sleep_for(300ms);
  const auto begin = std::chrono::steady_clock::now();
  kill(process, SIGINT);
  EXPECT_EQ(wait_for(process), 130);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  EXPECT_EQ(messages(), "renderer: interrupted, no picture is written\n");
  EXPECT_EQ(work_.files(), std::vector<std::string>{"scene.json"});
}

}  // namespace
}  // namespace basicrt
