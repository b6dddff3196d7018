// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras against the geometry that defines them.
#include "camera/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

#include "support/chi_square.h"

namespace basicrt {
namespace {

constexpr Vec2i size{200, 100};

void expect_near(Vec3f a, Vec3f b, float tolerance) { EXPECT_LT(length(a - b), tolerance); }

TEST(Camera, the_picture_s_centre_looks_at_the_target) {
  const Vec3f position{3, 1, -2}, target{0, 2, 5};
  const Camera camera = make_look_at_camera(position, target, {0, 1, 0}, 0.7f, 2);
  const Ray ray = CameraView(camera, size).ray({100, 50});
  EXPECT_EQ(ray.origin, position);
  expect_near(ray.direction, normalize(target - position), 1e-6f);
}

TEST(Camera, the_field_of_view_is_the_full_vertical_angle_and_up_is_up) {
  const float fov = 0.7f;
  const Camera camera = make_look_at_camera({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, fov, 2);
  const Vec3f top = CameraView(camera, size).ray({100, 100}).direction;
  const Vec3f right = CameraView(camera, size).ray({200, 50}).direction;
  EXPECT_NEAR(std::atan2(top.y, -top.z), fov / 2, 1e-6);
  EXPECT_NEAR(right.x / -right.z, 2 * std::tan(fov / 2), 1e-6);
}

TEST(Camera, clipping_is_by_depth_and_not_by_distance) {
  PerspectiveCamera camera;
  camera.window_min = {-2, -1};
  camera.window_max = {2, 1};
  camera.clip_near = 0.5f;
  camera.clip_far = 10;
  const Ray corner = CameraView(camera, size).ray({0, 0});
  EXPECT_NEAR(corner.at(corner.t_min).z, -0.5, 1e-5);
  EXPECT_NEAR(corner.at(corner.t_max).z, -10, 1e-4);
  EXPECT_NEAR(CameraView(camera, size).depth(corner.at(corner.t_max)), 10, 1e-4);
}

TEST(Camera, orthographic_rays_are_parallel_and_start_on_the_window) {
  OrthographicCamera camera;
  camera.window_min = {-4, -2};
  camera.window_max = {4, 2};
  const Ray lower_left = CameraView(camera, size).ray({0, 0}), center = CameraView(camera, size).ray({100, 50});
  expect_near(lower_left.origin, {-4, -2, 0}, 1e-6f);
  expect_near(center.origin, {0, 0, 0}, 1e-6f);
  EXPECT_EQ(lower_left.direction, (Vec3f{0, 0, -1}));
  EXPECT_EQ(center.direction, lower_left.direction);
}

// Whatever the camera, and where its transform stretches too: what a ray meets is seen where the ray began.
TEST(Camera, a_point_is_seen_where_its_ray_begins) {
  Transform to_world;
  to_world.rows = {{{0.8f, 0.6f, 0, 1}, {-1.2f, 1.6f, 0, 2}, {0, 0, 0.5f, 3}}};
  PerspectiveCamera perspective;
  perspective.window_min = {-2, -0.5f};  // shifted
  OrthographicCamera orthographic;
  EquirectangularCamera equirectangular;
  equirectangular.window_min = {-1, -0.5f};
  FisheyePolynomialCamera polynomial;
  polynomial.k0 = 0.05f;
  polynomial.k1 = 0.9f;
  polynomial.k3 = 0.1f;
  FisheyeEquisolidCamera mirror_ball;
  mirror_ball.fov = 2 * pi;
  mirror_ball.focal_length = 0.5f;
  for (Camera camera : {Camera(perspective), Camera(orthographic), Camera(equirectangular),
                        Camera(FisheyeEquidistantCamera{}), Camera(FisheyeEquisolidCamera{}), Camera(mirror_ball),
                        Camera(polynomial), Camera(CubemapFaceCamera{}), Camera(CylindricalCamera{})}) {
    std::visit([&](auto& kind) { kind.to_world = to_world; }, camera);
    const CameraView view(camera, size);
    for (const Vec2f pixel : {Vec2f{100, 50}, Vec2f{70.25f, 40.5f}, Vec2f{130, 65}, Vec2f{101, 49}}) {
      const std::optional<Ray> ray = view.ray(pixel, {0.5f, 0.5f});
      ASSERT_TRUE(ray);
      const std::optional<Vec2f> seen = view.pixel_of(ray->at(7));
      ASSERT_TRUE(seen) << "kind " << camera.index();
      EXPECT_NEAR(seen->x, pixel.x, 2e-3f) << "kind " << camera.index();
      EXPECT_NEAR(seen->y, pixel.y, 2e-3f) << "kind " << camera.index();
    }
  }
}

TEST(Camera, what_is_infinitely_far_is_seen_where_rays_go_its_way) {
  const PerspectiveCamera perspective = make_look_at_camera({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 1, 2);
  EquirectangularCamera panorama;
  panorama.to_world = perspective.to_world;
  for (const Camera& camera : {Camera(perspective), Camera(panorama)}) {
    const CameraView view(camera, size);
    const std::optional<Vec2f> seen = view.pixel_of_direction(view.ray({130, 65}, {0.5f, 0.5f})->direction * 3);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, 130, 2e-3f);
    EXPECT_NEAR(seen->y, 65, 2e-3f);
  }
  EXPECT_FALSE(CameraView(perspective, size).pixel_of_direction({1, 2, 3}));
  EXPECT_FALSE(CameraView(OrthographicCamera{}, size).pixel_of_direction({0, 0, -1}));
}

TEST(Camera, what_no_place_shows_is_nowhere) {
  const Vec3f behind{1, 1, 2};
  EXPECT_FALSE(CameraView(PerspectiveCamera{}, size).pixel_of(behind));
  EXPECT_FALSE(CameraView(PerspectiveCamera{}, size).pixel_of({1, 1, 0}));
  EXPECT_FALSE(CameraView(CubemapFaceCamera{}, size).pixel_of(behind));
  EXPECT_FALSE(CameraView(EquirectangularCamera{}, size).pixel_of(Vec3f(0.0f)));
  EXPECT_FALSE(CameraView(CylindricalCamera{}, size).pixel_of({0, 1, 0}));
  FisheyePolynomialCamera limited;  // no angle above a half
  limited.k2 = -0.5f;
  EXPECT_FALSE(CameraView(limited, size).pixel_of(behind));
  EXPECT_TRUE(CameraView(OrthographicCamera{}, size).pixel_of(behind));
  EXPECT_TRUE(CameraView(EquirectangularCamera{}, size).pixel_of(behind));
}

TEST(Camera, panoramas_that_go_around_repeat_after_a_turn) {
  EquirectangularCamera half;
  half.window_min.x = 0;
  EXPECT_FLOAT_EQ(CameraView(half, size).period(), 400);
  EXPECT_FLOAT_EQ(CameraView(CylindricalCamera{}, size).period(), 200);
  EXPECT_EQ(CameraView(FisheyeEquidistantCamera{}, size).period(), 0);
  EXPECT_EQ(CameraView(PerspectiveCamera{}, size).period(), 0);
}

TEST(Camera, differentials_are_the_change_over_a_small_step_on_the_film) {
  constexpr float step = 1.0f / 16;
  const PerspectiveCamera perspective = make_look_at_camera({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 1, 2);
  OrthographicCamera orthographic;
  orthographic.to_world = perspective.to_world;
  for (const Camera& camera : {Camera(perspective), Camera(orthographic)}) {
    const Vec2f pixel{30.25f, 60.5f};
    const CameraView view(camera, size);
    const Ray ray = view.ray(pixel), right = view.ray(pixel + Vec2f{step, 0}), above = view.ray(pixel + Vec2f{0, step});
    const RayDifferentials change = view.differentials(pixel);
    expect_near(ray.direction + change.direction_dx * step, right.direction, 1e-6f);
    expect_near(ray.direction + change.direction_dy * step, above.direction, 1e-6f);
    expect_near(ray.origin + change.origin_dx * step, right.origin, 1e-5f);
    expect_near(ray.origin + change.origin_dy * step, above.origin, 1e-5f);
  }
}

// Where a ray from a point on the aperture goes, in pixels, for what is at one depth: the point seen through (x, y).
Vec3f point_at_depth(const CameraView& view, Vec2f pixel, float depth, Vec2f lens) {
  const Ray ray = *view.ray(pixel, lens);
  return ray.at(depth / dot(ray.direction, Vec3f{0, 0, -1}));
}

TEST(CameraLens, all_rays_of_a_place_meet_in_the_plane_of_focus_and_nowhere_else) {
  PerspectiveCamera perspective;
  perspective.window_min = {-2, -1};
  perspective.window_max = {2, 1};
  OrthographicCamera orthographic;
  const auto set_lens = [](auto& camera) {
    camera.aperture_radius = 0.25f;
    camera.focus_distance = 4;
    return CameraView(camera, size);
  };
  for (const CameraView& view : {set_lens(perspective), set_lens(orthographic)}) {
    const Vec2f pixel{150.5f, 20.25f};
    test::Rng rng(1);
    const Vec3f sharp = point_at_depth(view, pixel, 4, {0.5f, 0.5f});
    float widest = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec2f lens = test::next_unit_vec2(rng);
      expect_near(point_at_depth(view, pixel, 4, lens), sharp, 1e-5f);
      // A point n times as deep is blurred to a disc of the aperture's size times n - 1.
      const float blur = length(point_at_depth(view, pixel, 12, lens) - point_at_depth(view, pixel, 12, {0.5f, 0.5f}));
      widest = std::max(widest, blur);
    }
    EXPECT_LE(widest, 0.5f + 1e-5f);
    EXPECT_GT(widest, 0.48f);
  }
}

TEST(CameraLens, the_middle_of_the_aperture_is_the_pinhole) {
  PerspectiveCamera camera = make_look_at_camera({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 1, 2);
  camera.clip_near = 0.1f;
  camera.clip_far = 7;
  const CameraView pinhole(camera, size);
  camera.aperture_radius = 0.1f;
  const CameraView lens(camera, size);
  EXPECT_TRUE(pinhole.is_pinhole());
  EXPECT_FALSE(lens.is_pinhole());
  const Ray a = pinhole.ray({20, 70}), b = *lens.ray({20, 70}, {0.5f, 0.5f});
  expect_near(a.origin, b.origin, 1e-6f);
  expect_near(a.direction, b.direction, 1e-6f);
  EXPECT_NEAR(a.t_min, b.t_min, 1e-6);
  EXPECT_NEAR(a.t_max, b.t_max, 1e-5);
}

TEST(CameraLens, clipping_is_by_depth_from_anywhere_on_the_aperture) {
  PerspectiveCamera camera;
  camera.clip_near = 0.5f;
  camera.clip_far = 10;
  camera.aperture_radius = 0.3f;
  const Ray ray = *CameraView(camera, size).ray({13, 77}, {0.9f, 0.2f});
  EXPECT_NEAR(ray.at(ray.t_min).z, -0.5, 1e-5);
  EXPECT_NEAR(ray.at(ray.t_max).z, -10, 1e-4);
}

TEST(CameraLens, the_camera_s_scale_does_not_change_the_aperture) {
  PerspectiveCamera camera;
  camera.aperture_radius = 0.25f;
  camera.to_world.rows = {{{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}}};
  float widest = 0;
  for (int i = 0; i < 100; ++i)
    widest =
        std::max(widest, length(CameraView(camera, size).ray({0, 0}, {0.999f, 0.01f * static_cast<float>(i)})->origin));
  EXPECT_NEAR(widest, 0.25f, 1e-3);
}

struct ApertureCase {
  int blades;
  float rotation, ratio;
};
class Aperture : public testing::TestWithParam<ApertureCase> {
 protected:
  Aperture() {
    camera_.aperture_radius = 0.2f;
    camera_.aperture_blades = GetParam().blades;
    camera_.aperture_rotation = GetParam().rotation;
    camera_.aperture_ratio = GetParam().ratio;
  }
  // As it is before the ratio squeezes it, of radius 1.
  [[nodiscard]] Vec2d unsqueezed(Vec2d p) const {
    return Vec2d{p.x * camera_.aperture_ratio, p.y} * (1.0 / camera_.aperture_radius);
  }
  // Of an area before.
  [[nodiscard]] double squeezed_area(double area) const {
    return area * camera_.aperture_radius * camera_.aperture_radius / camera_.aperture_ratio;
  }
  PerspectiveCamera camera_;
};
class RoundAperture : public Aperture {};

TEST_P(Aperture, is_sampled_with_its_density) {
  const auto is_inside = [&](Vec2d q) {  // of each side
    for (int i = 0; i < camera_.aperture_blades; ++i) {
      const double angle = camera_.aperture_rotation + 2 * std::numbers::pi * i / camera_.aperture_blades;
      if (q.x * std::cos(angle) + q.y * std::sin(angle) > std::cos(std::numbers::pi / camera_.aperture_blades))
        return false;
    }
    return true;
  };
  constexpr double reach = 1.01;
  const auto result = test::chi_square_square(
      [&](test::Rng& rng) -> std::optional<Vec2d> {
        const Vec2d q = unsqueezed(Vec2d(sample_aperture(camera_, test::next_unit_vec2(rng))));
        return Vec2d{(q.x / reach + 1) / 2, (q.y / reach + 1) / 2};
      },
      [&](Vec2d u) {
        const bool is_seen = is_inside({(2 * u.x - 1) * reach, (2 * u.y - 1) * reach});
        return is_seen ? squeezed_area(4 * reach * reach) * pdf_aperture(camera_) : 0.0;
      });
  EXPECT_GT(result.p_value, test::sidak_threshold(5)) << result.describe();
  EXPECT_NEAR(result.mass, 1, 1e-3);
}

// In polar coordinates, for the sake of its edge.
TEST_P(RoundAperture, is_sampled_with_its_density) {
  const auto result = test::chi_square_square(
      [&](test::Rng& rng) -> std::optional<Vec2d> {
        const Vec2d q = unsqueezed(Vec2d(sample_aperture(camera_, test::next_unit_vec2(rng))));
        const double turn = std::atan2(q.y, q.x) / (2 * std::numbers::pi);
        return Vec2d{std::min(q.x * q.x + q.y * q.y, 1.0), turn < 0 ? turn + 1 : turn};
      },
      [&](Vec2d) { return squeezed_area(std::numbers::pi) * pdf_aperture(camera_); });
  EXPECT_GT(result.p_value, test::sidak_threshold(5)) << result.describe();
  EXPECT_NEAR(result.mass, 1, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Aperture,
                         testing::Values(ApertureCase{3, 0.4f, 1}, ApertureCase{6, -0.3f, 0.5f},
                                         ApertureCase{5, 0, 3}));
INSTANTIATE_TEST_SUITE_P(Shapes, RoundAperture, testing::Values(ApertureCase{0, 0, 1}, ApertureCase{2, 1, 2}));

Vec3f direction_in(const Camera& camera, Vec2f pixel) { return CameraView(camera, size).ray(pixel, {})->direction; }

TEST(Panorama, equirectangular_pixels_are_longitude_and_latitude) {
  EquirectangularCamera camera;
  expect_near(direction_in(camera, {100, 50}), {0, 0, -1}, 1e-6f);
  expect_near(direction_in(camera, {150, 50}), {1, 0, 0}, 1e-6f);
  expect_near(direction_in(camera, {100, 100}), {0, 1, 0}, 1e-6f);
  camera.window_min = {-1, -0.5f};
  camera.window_max = {2, 0.25f};
  const Vec3f corner = direction_in(camera, {200, 100});
  EXPECT_NEAR(std::atan2(corner.x, -corner.z), 2, 1e-6);
  EXPECT_NEAR(std::asin(corner.y), 0.25, 1e-6);
}

TEST(Panorama, an_equidistant_fisheye_s_radius_is_the_angle) {
  FisheyeEquidistantCamera camera;
  camera.fov = 2;
  camera.window_min = {-1, -1};
  camera.window_max = {1, 1};
  const Vec3f direction = direction_in(camera, {100 + 30, 50 + 20});  // (0.3, 0.4) of the radius
  EXPECT_NEAR(std::acos(-direction.z), 0.5, 1e-6);
  EXPECT_NEAR(direction.y / direction.x, 4.0 / 3, 1e-5);
  const CameraView view(camera, size);
  EXPECT_TRUE(view.ray({100 + 59, 50 + 39}, {})) << "just within the circle";
  EXPECT_FALSE(view.ray({100 + 61, 50 + 41}, {})) << "just outside";
}

TEST(Panorama, an_equisolid_fisheye_sees_equal_solid_angles_in_equal_areas) {
  FisheyeEquisolidCamera camera;
  camera.fov = 5;
  camera.focal_length = 0.6f;
  const CameraView view(camera, size);
  // Over a pixel: the area spanned by the direction's changes.
  const auto solid_angle = [&](Vec2f pixel) {
    const RayDifferentials change = view.differentials(pixel);
    return length(cross(change.direction_dx, change.direction_dy));
  };
  const float center = solid_angle({100, 50});
  EXPECT_NEAR(solid_angle({160, 60}) / center, 1, 1e-4);
  EXPECT_NEAR(solid_angle({80, 10}) / center, 1, 1e-4);
  const float edge = 2 * 0.6f * std::sin(5.0f / 4);
  EXPECT_TRUE(camera.sees({edge * 0.999f, 0}));
  EXPECT_FALSE(camera.sees({edge * 1.001f, 0}));
}

TEST(Panorama, a_mirror_ball_is_an_equisolid_fisheye) {
  FisheyeEquisolidCamera camera;
  camera.focal_length = 0.5f;
  camera.fov = 2 * pi;
  for (const Vec2f place : {Vec2f{0, 0}, Vec2f{0.3f, -0.2f}, Vec2f{-0.7f, 0.6f}}) {
    const Vec3f normal{place.x, place.y, std::sqrt(1 - place.x * place.x - place.y * place.y)};
    const Vec3f view{0, 0, -1};
    Vec3f reflected = view - normal * (2 * dot(view, normal));
    reflected.z = -reflected.z;  // as Blender has it: the ball's middle shows what is ahead
    expect_near(camera.bearing(place).direction, reflected, 1e-6f);
  }
}

TEST(Panorama, a_polynomial_fisheye_bends_by_its_polynomial) {
  FisheyePolynomialCamera camera;
  camera.k0 = 0.1f;
  camera.k1 = 0.7f;
  camera.k2 = -0.2f;
  camera.k3 = 0.3f;
  camera.k4 = 0.05f;
  camera.fov = 1.6f;
  const float r = 0.5f, angle = 0.1f + 0.7f * r - 0.2f * r * r + 0.3f * r * r * r + 0.05f * r * r * r * r;
  const Vec3f direction = camera.bearing({0.3f, 0.4f}).direction;
  EXPECT_NEAR(std::acos(-direction.z), angle, 1e-6);
  EXPECT_TRUE(camera.sees({0.6f, 0.6f}));
  EXPECT_FALSE(camera.sees({1, 1}));
}

TEST(Panorama, a_face_of_a_cube_map_is_even_in_angle_and_a_cylinder_in_height) {
  const Vec3f face = direction_in(CubemapFaceCamera{}, {150, 25});
  EXPECT_NEAR(face.x / -face.z, std::tan(pi / 8), 1e-6);
  EXPECT_NEAR(face.y / -face.z, -std::tan(pi / 8), 1e-6);
  const Vec3f side = direction_in(CylindricalCamera{}, {150, 75});
  EXPECT_NEAR(std::atan2(side.x, -side.z), pi / 2, 1e-6);
  EXPECT_NEAR(side.y / std::hypot(side.x, side.z), 0.5, 1e-6);
}

std::vector<Camera> panoramas() {
  FisheyeEquidistantCamera equidistant;
  equidistant.fov = 6;
  FisheyeEquisolidCamera equisolid;
  equisolid.fov = 6;
  FisheyePolynomialCamera polynomial;
  polynomial.fov = 6;
  polynomial.k2 = 0.2f;
  std::vector<Camera> cameras{EquirectangularCamera{}, equidistant,        equisolid, polynomial,
                              CubemapFaceCamera{},     CylindricalCamera{}};
  const Transform turned = make_look_at_camera({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 1, 2).to_world;
  for (Camera& camera : cameras) std::visit([&](CameraBase& base) { base.to_world = turned; }, camera);
  return cameras;
}

TEST(Panorama, differentials_are_the_change_over_a_small_step_on_the_film) {
  constexpr float step = 1.0f / 16;
  for (const Camera& camera : panoramas()) {
    const CameraView view(camera, size);
    for (const Vec2f pixel : {Vec2f{100, 50}, Vec2f{120.25f, 60.5f}, Vec2f{70, 33}}) {
      const Vec3f here = view.ray(pixel, {})->direction;
      const RayDifferentials change = view.differentials(pixel);
      expect_near(here + change.direction_dx * step, view.ray(pixel + Vec2f{step, 0}, {})->direction, 2e-5f);
      expect_near(here + change.direction_dy * step, view.ray(pixel + Vec2f{0, step}, {})->direction, 2e-5f);
    }
  }
}

TEST(Panorama, clipping_focus_and_depth_are_distances) {
  for (Camera camera : panoramas()) {
    const auto set = [](CameraBase& base) {
      base.clip_near = 0.5f;
      base.clip_far = 20;
      base.focus_distance = 3;
      base.aperture_radius = 0.1f;
    };
    std::visit(set, camera);
    const CameraView view(camera, size);
    const Vec2f pixel{130, 40};
    const Ray middle = *view.ray(pixel, {0.5f, 0.5f});
    EXPECT_EQ(middle.t_min, 0.5f);
    EXPECT_EQ(middle.t_max, 20.0f);
    EXPECT_NEAR(view.depth(middle.at(7)), 7, 1e-5);
    const Ray edge = *view.ray(pixel, {0.999f, 0.5f});
    EXPECT_NEAR(length(edge.origin - middle.origin), 0.1f, 1e-3);
    EXPECT_NEAR(dot(edge.origin - middle.origin, middle.direction), 0, 1e-6);
    const Vec3f focus = middle.at(3);
    expect_near(edge.at(length(focus - edge.origin)), focus, 1e-5f);
  }
}

}  // namespace
}  // namespace basicrt
