// SPDX-License-Identifier: GPL-3.0-or-later
// Lights as a set: one density for whatever a direction meets, and closed forms of what emissive shapes shed.
#include "light/light_set.h"

#include <gtest/gtest.h>

#include <memory>

#include "light/closed_forms.h"
#include "light/lamp_checks.h"

namespace basicrt {
namespace {

using namespace test;

// A scene of one's own: shapes stay where the light set looks for them.
struct Scene {
  std::vector<std::unique_ptr<Shape>> shapes;
  std::vector<EmissiveInstance> emitters;
  std::vector<Light> lamps;
  Environment environment;

  void add(Shape shape, const TransformD& to_world, std::vector<Color> front, std::vector<Color> back) {
    shapes.push_back(std::make_unique<Shape>(std::move(shape)));
    // Instances that don't shine lie between those that do.
    emitters.push_back({.instance = static_cast<std::uint32_t>(2 * emitters.size() + 1),
                        .shape = shapes.back().get(),
                        .object_to_world = to_world,
                        .world_to_object = inverse(to_world),
                        .front = std::move(front),
                        .back = std::move(back)});
  }
  [[nodiscard]] LightSet lights() const {
    return {lamps, emitters, EnvironmentSampler(environment), {Vec3f(-5), Vec3f(5)}};
  }
};

Mesh triangle_mesh(Vec3f a, Vec3f b, Vec3f c) {
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

Mesh random_mesh(int triangles, Rng& rng) {
  Mesh mesh;
  for (int i = 0; i < 3 * triangles; ++i)
    mesh.positions.push_back(random_direction(rng) * (0.5f + next_unit_float(rng)));
  for (std::uint32_t i = 0; i < std::uint32_t(triangles); ++i) {
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh.material_slots.push_back(i % 3);
  }
  return mesh;
}

// Brute force: everything that the line from `origin` meets, however often.
template <class Visitor>
void for_each_surface_hit(const EmissiveInstance& emitter, Vec3d origin, Vec3d direction, Visitor&& visit) {
  const auto visit_at = [&](double t, std::uint32_t primitive) {
    if (!(t > 0)) return;
    SurfacePoint point;
    point.position = Vec3f(origin + direction * t);
    point.instance = emitter.instance;
    point.primitive = primitive;
    visit(point);
  };
  if (const auto* mesh = std::get_if<Mesh>(emitter.shape)) {
    for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
      const auto corner = [&](int c) { return emitter.object_to_world.point(Vec3d(mesh->position(i, c))) - origin; };
      const Vec3d a = corner(0), b = corner(1), c = corner(2);
      const double u = dot(direction, cross(b, c)), v = dot(direction, cross(c, a)), w = dot(direction, cross(a, b));
      if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) {
        const Vec3d normal = cross(b - a, c - a);
        visit_at(dot(a, normal) / dot(direction, normal), i);
      }
    }
    return;
  }
  // A sphere: only its nearest side is seen.
  const Sphere& sphere = std::get<Sphere>(*emitter.shape);
  const Vec3d o = emitter.world_to_object.point(origin) - Vec3d(sphere.center);
  const Vec3d d = emitter.world_to_object.vector(direction);
  const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - double(sphere.radius) * sphere.radius;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return;
  const double root = std::sqrt(discriminant), near = (-b - root) / a, far = (-b + root) / a;
  visit_at(near > 0 ? near : far, 0);
}

template <class Visitor>
void for_each_lamp_density(const LightSet& lights, const LitPoint& lit, Vec3f wi, Visitor&& visit) {
  const Ray ray{.origin = lit.position, .direction = wi};
  lights.for_each_lamp_hit(ray, lit, visit);
  lights.for_each_distant_hit(ray, lit, visit);
}

// `surfaces` are the emissive shapes, standing where they are at the time.
ChiSquareResult compare_with_density(const LightSet& lights, const std::vector<EmissiveInstance>& surfaces,
                                     Vec3f position, float time) {
  const auto sample = [&](Rng& rng) -> std::optional<Vec3f> {
    const float choice = next_unit_float(rng);
    const auto s = lights.sample(position, choice, next_unit_vec2(rng), time);
    if (!s) return std::nullopt;
    return s->wi;
  };
  const auto density = [&](Vec3f wi) {
    double sum = 0;
    for_each_lamp_density(lights, position, wi, [&](const LightHit& hit) { sum += hit.pdf; });
    for (const EmissiveInstance& surface : surfaces)
      for_each_surface_hit(surface, Vec3d(position), Vec3d(wi), [&](SurfacePoint point) {
        point.time = time;
        sum += lights.pdf_surface(point, position);
      });
    return sum;
  };
  return chi_square_sphere(sample, density, {.samples = 50000, .pilot_samples = 20000});
}
ChiSquareResult compare_with_density(const Scene& scene, Vec3f position) {
  return compare_with_density(scene.lights(), scene.emitters, position, 0);
}

// In the first channel, on a surface that faces `normal`.
double irradiance(const LightSet& lights, Vec3f position, Vec3f normal, int n = 300) {
  Rng rng(17);
  double sum = 0;
  for_each_stratum(n, rng, [&](Vec2f u) {
    if (const auto sample = lights.sample(position, next_unit_float(rng), u))
      sum += double(sample->radiance.x) * std::max(0.0f, dot(sample->wi, normal)) / sample->pdf;
  });
  return sum / (double(n) * n);
}

TEST(LightSet, samples_of_shapes_that_move_follow_their_density_at_each_time) {
  Rng rng(23);
  const Mesh mesh = random_mesh(5, rng);
  Mesh deforming = mesh;
  std::vector<Vec3f>& end = deforming.motion_positions.emplace_back(mesh.positions);
  for (Vec3f& position : end) position += Vec3f{0.5f, -1, 2};
  const std::vector<TransformD> keys{TransformD{}, TransformD({{{0, -2, 0, 3}, {2, 0, 0, 0}, {0, 0, 2, 1}}})};
  const std::vector<Color> front(3, Color(1.0f)), back(3, Color(0.5f));
  Scene moving;
  for (const Shape& shape : {Shape(deforming), Shape(Sphere{{1, 2, 3}, 0.5f})}) {
    moving.add(shape, keys[0], front, back);
    moving.emitters.back().motion = keys;
  }
  for (const float time : {0.0f, 0.3f, 1.0f}) {
    Mesh now = mesh;
    for (std::uint32_t i = 0; i < 15; ++i) now.positions[i] = deforming.position_at(i / 3, int(i % 3), time);
    Scene still;
    for (const Shape& shape : {Shape(now), Shape(Sphere{{1, 2, 3}, 0.5f})})
      still.add(shape, transform_at(keys, time), front, back);
    const auto result = compare_with_density(moving.lights(), still.emitters, {4, 3, -2}, time);
    EXPECT_GT(result.p_value, sidak_threshold(3)) << time << ": " << result.describe();
  }
}

TEST(LightSet, samples_of_triangles_of_any_size_follow_their_density) {
  const TransformD identity;
  for (const float size : {20.0f, 1.0f, 0.05f}) {
    Scene scene;
    scene.add(triangle_mesh(Vec3f{-1, -0.5f, 1} * size, Vec3f{1.5f, -0.7f, 1} * size, Vec3f{0, 1, 1.2f} * size),
              identity, {Color(1)}, {Color(1)});
    const auto result = compare_with_density(scene, {0.1f, 0, -0.2f});
    EXPECT_GT(result.p_value, sidak_threshold(3)) << size << ": " << result.describe();
  }
}

// Lamps and shapes of every kind, some with black sides, one mirrored and one stretched.
void add_a_bit_of_everything(Scene& scene, Rng& rng) {
  scene.lamps = {PointLight{.position = {2, 0, 1}, .intensity = Color(2), .radius = 0.3f},
                 SunLight{.direction = {0, 1, -1}, .irradiance = Color(0.2f), .angle = 0.4f},
                 AreaLight{.to_world = translation({-2, 1, 3}), .radiance = Color(3)}};
  const Color off(0.0f);
  scene.add(random_mesh(7, rng), TransformD(translation({0, 3, 0}) * random_rotation(rng)), {Color(1), off, Color(3)},
            {off, Color(2), Color(1)});
  scene.add(random_mesh(8, rng), TransformD(translation({0, -4, 0}) * scaling({-1, 2, 0.5f})), {Color(2), Color(1)},
            {off, off});
  scene.add(Sphere{{0.5f, 0, 0}, 0.5f},
            TransformD(translation({-3, 0, 0}) * random_rotation(rng) * scaling({1, 2, 0.3f})), {Color(1)}, {off});
}

// Calls visit(source, distance, pdf) for everything in a direction; shapes come after the lamps.
template <class Visitor>
void for_each_density(const Scene& scene, const LightSet& lights, const LitPoint& lit, Vec3f wi, Visitor&& visit) {
  for_each_lamp_density(lights, lit, wi, [&](const LightHit& hit) { visit(0u, hit.t, hit.pdf); });
  for (std::uint32_t i = 0; i < scene.emitters.size(); ++i)
    for_each_surface_hit(scene.emitters[i], Vec3d(lit.position), Vec3d(wi), [&](const SurfacePoint& point) {
      visit(i + 1, length(point.position - lit.position), lights.pdf_surface(point, lit));
    });
}

TEST(LightSet, each_sample_has_the_place_and_density_of_what_lies_in_its_direction) {
  Rng rng(21);
  Scene scene;
  add_a_bit_of_everything(scene, rng);
  const LightSet lights = scene.lights();
  std::vector<int> found(scene.emitters.size() + 1);
  for (const Vec3f place : {Vec3f{0, 0, 0}, Vec3f{1, 2, -1}, Vec3f{0.3f, -3, 0.2f}})
    for (int i = 0; i < 20000; ++i) {
      const float choice = next_unit_float(rng);
      const auto sample = lights.sample(place, choice, next_unit_vec2(rng));
      if (!sample) continue;
      double least_difference = infinity;
      std::uint32_t nearest_source = 0;
      for_each_density(scene, lights, place, sample->wi, [&](std::uint32_t source, float distance, float pdf) {
        const bool is_far = distance == infinity && sample->distance == infinity;
        const double difference =
            std::abs(pdf / sample->pdf - 1) + (is_far ? 0 : std::abs(distance / sample->distance - 1));
        if (!(difference < least_difference)) return;
        least_difference = difference;
        nearest_source = source;
      });
      ASSERT_LT(least_difference, 2e-3) << "seed 21";
      ++found[nearest_source];
    }
  // None of them is a bystander.
  for (const int count : found) EXPECT_GT(count, 500) << "seed 21";
}

TEST(LightSet, density_over_all_directions_is_the_share_of_choices_that_give_a_sample) {
  Rng rng(25);
  Scene scene;
  add_a_bit_of_everything(scene, rng);
  const LightSet lights = scene.lights();
  constexpr int n = 400000;
  for (const Vec3f place : {Vec3f{0, 0, 0}, Vec3f{0.3f, -3, 0.2f}}) {
    int accepted = 0;
    double sum = 0, sum_of_squares = 0;
    for (int i = 0; i < n; ++i) {
      const float choice = next_unit_float(rng);
      accepted += lights.sample(place, choice, next_unit_vec2(rng)).has_value();
      double density = 0;
      for_each_density(scene, lights, place, random_direction(rng),
                       [&](std::uint32_t, float, float pdf) { density += pdf; });
      density *= 4 * double(pi);
      sum += density;
      sum_of_squares += density * density;
    }
    const double mean = sum / n, deviation = std::sqrt((sum_of_squares / n - mean * mean + 0.25) / n);
    EXPECT_NEAR(mean, double(accepted) / n, 4 * deviation) << "seed 25";
    EXPECT_LT(4 * deviation, 0.05);  // or it would say little
  }
}

TEST(LightSet, samples_of_a_stretched_sphere_follow_their_density) {
  Rng rng(26);
  Scene scene;
  scene.add(Sphere{{0.5f, 0, 0}, 0.5f},
            TransformD(translation({-3, 0, 0}) * random_rotation(rng) * scaling({1, 2, 0.3f})), {Color(1)},
            {Color(0.0f)});
  const auto result = compare_with_density(scene, {0, 0, 0});
  EXPECT_GT(result.p_value, sidak_threshold(1)) << result.describe() << ", scene of seed 26";
}

TEST(LightSet, samples_from_within_an_ellipsoid_follow_their_density) {
  Rng rng(22);
  Scene scene;
  scene.add(Sphere{{0, 0, 0}, 1}, TransformD(random_rotation(rng) * scaling({3, 1, 2})), {Color(1)}, {Color(2)});
  const auto result = compare_with_density(scene, {0.1f, 0.2f, -0.3f});
  EXPECT_GT(result.p_value, sidak_threshold(1)) << result.describe();
  EXPECT_NEAR(irradiance(scene.lights(), {0.1f, 0.2f, -0.3f}, {0, 0, 1}), 2 * pi, 1e-2);
}

TEST(LightSet, triangles_shed_what_lamberts_formula_says) {
  Rng rng(23);
  for (int i = 0; i < 30; ++i) {
    // Over the receiver, near and far, small and large.
    const float size = std::pow(10.0f, 2 * next_unit_float(rng) - 1);
    const auto corner = [&] {
      const Vec3f d = random_direction(rng);
      return Vec3f{d.x * size, d.y * size, 0.1f + next_unit_float(rng)};
    };
    const Vec3f a = corner(), b = corner(), c = corner();
    Scene scene;
    scene.add(triangle_mesh(a, b, c), {}, {Color(1)}, {Color(1)});
    const double expected = polygon_irradiance({Vec3d(a), Vec3d(b), Vec3d(c)}, {0, 0, 1});
    EXPECT_NEAR(irradiance(scene.lights(), {0, 0, 0}, {0, 0, 1}) / expected, 1, 0.02)
        << "triangle " << i << ", seed 23";
  }
}

TEST(LightSet, a_sphere_sheds_pi_times_the_square_of_its_sine) {
  for (const float distance : {1.01f, 1.5f, 4.0f, 1000.0f}) {
    Scene scene;
    scene.add(Sphere{{0, 0, 0}, 0.5f}, TransformD(translation({0, 0, distance}) * scaling(Vec3f(2))), {Color(3)},
              {Color(0.0f)});
    const double expected = 3 * double(pi) / (double(distance) * distance);
    EXPECT_NEAR(irradiance(scene.lights(), {0, 0, 0}, {0, 0, 1}) / expected, 1, 2e-3) << distance;
  }
}

TEST(LightSet, each_side_has_its_own_radiance_under_mirrors_too) {
  const Color red{1, 0, 0}, blue{0, 0, 1};
  for (const float mirror : {1.0f, -1.0f}) {
    Scene scene;
    // Wound to face +z in object space, which the mirror along x leaves alone.
    scene.add(triangle_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), TransformD(scaling({mirror, 1, 1})), {red}, {blue});
    const LightSet lights = scene.lights();
    const auto above = lights.sample(Vec3f{0, 0, 2}, 0.5f, {0.3f, 0.3f}),
               below = lights.sample(Vec3f{0, 0, -2}, 0.5f, {0.3f, 0.3f});
    ASSERT_TRUE(above && below);
    EXPECT_EQ(above->radiance, red);
    EXPECT_EQ(below->radiance, blue);
  }
}

TEST(LightSet, a_side_that_does_not_shine_is_neither_sampled_nor_expected) {
  Scene scene;
  scene.add(triangle_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), {}, {Color(1)}, {Color(0.0f)});
  const LightSet lights = scene.lights();
  EXPECT_TRUE(lights.sample(Vec3f{0, 0, 1}, 0.5f, {0.5f, 0.5f}));
  EXPECT_FALSE(lights.sample(Vec3f{0, 0, -1}, 0.5f, {0.5f, 0.5f}));
  SurfacePoint point;
  point.position = {0.2f, 0.2f, 0};
  point.instance = 1;
  EXPECT_GT(lights.pdf_surface(point, Vec3f{0, 0, 1}), 0);
  EXPECT_EQ(lights.pdf_surface(point, Vec3f{0, 0, -1}), 0);
}

TEST(LightSet, shapes_do_not_light_their_own_points) {
  Rng rng(24);
  for (int i = 0; i < 200; ++i) {
    const float scale = std::pow(10.0f, 4 * next_unit_float(rng) - 2);
    const Vec3f away = random_direction(rng) * (100 * next_unit_float(rng));
    const Transform to_world = translation(away) * random_rotation(rng) * scaling(Vec3f(scale));
    Scene flat, round;
    flat.add(triangle_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), TransformD(to_world), {Color(1)}, {Color(1)});
    round.add(Sphere{{0, 0, 0}, 1}, TransformD(to_world), {Color(1)}, {Color(1)});
    const Vec2f u = next_unit_vec2(rng);
    const Vec3f on_triangle = to_world.point(Vec3f{u.x / 2, u.y / 2, 0});
    EXPECT_FALSE(flat.lights().sample(on_triangle, 0.5f, {0.4f, 0.7f})) << "seed 24";
    // A sphere's points see it through its inside at most, never right in front of them.
    if (length(away) > 20 * scale) continue;  // the place would be rounded to the other side
    const Vec3f on_sphere = to_world.point(random_direction(rng));
    const auto sample = round.lights().sample(on_sphere, 0.5f, next_unit_vec2(rng));
    if (sample) {
      EXPECT_GT(sample->distance, 1e-3f * scale) << "seed 24";
    }
  }
}

TEST(LightSet, probabilities_of_the_choice_sum_to_one) {
  // Every light at the same place, so that a ray through it has the density of all of them. A soft lamp's density is
  // one over its solid angle, whatever the lamp.
  const std::vector<float> intensities = {1, 10, 0.001f, 200};
  Scene scene;
  for (const float intensity : intensities)
    scene.lamps.push_back(PointLight{.position = {0, 0, 3}, .intensity = Color(intensity), .radius = 1});
  scene.lamps.push_back(PointLight{.position = {0, 0, 3}, .intensity = Color(0.0f), .radius = 1});
  const LightSet lights = scene.lights();
  double sum = 0;
  int hits = 0;
  for_each_lamp_density(lights, Vec3f{0, 0, 0}, {0, 0, 1}, [&](const LightHit& hit) {
    sum += hit.pdf;
    ++hits;
  });
  EXPECT_EQ(hits, 4);  // the black one is not there
  EXPECT_NEAR(sum / light_pdf(scene.lamps[0], {0, 0, 0}, {0, 0, 1}), 1, 1e-5);
}

TEST(LightSet, rays_meet_lamps_among_many_and_among_black_ones) {
  for (const int shining : {1, 2, 3, 40}) {
    Scene scene;
    for (int i = 0; i < 50; ++i)
      scene.lamps.push_back(
          PointLight{.position = {float(i), 0, 3}, .intensity = Color(i < shining ? 1.0f : 0.0f), .radius = 0.1f});
    scene.lamps.push_back(SunLight{.direction = {0, 0, -1}, .angle = 0.1f});
    const LightSet lights = scene.lights();
    for (int i = 0; i < 50; ++i) {
      int near = 0, distant = 0;
      const Ray ray{.origin = {float(i), 0, 0}, .direction = {0, 0, 1}, .t_max = 100};
      lights.for_each_lamp_hit(ray, ray.origin, [&](const LightHit& hit) {
        ++near;
        EXPECT_NEAR(hit.t, 2.9f, 1e-4);
      });
      lights.for_each_distant_hit(ray, ray.origin, [&](const LightHit&) { ++distant; });
      EXPECT_EQ(near, i < shining ? 1 : 0) << shining;
      EXPECT_EQ(distant, 1);  // whatever the ray's end
    }
  }
}

TEST(LightSet, one_light_alone_keeps_its_own_density) {
  const Light lamp = PointLight{.position = {0, 0, 3}, .radius = 1};
  Scene scene;
  scene.lamps = {lamp};
  const auto alone = sample_light(lamp, {0, 0, 0}, {0.2f, 0.3f});
  const auto in_set = scene.lights().sample(Vec3f{0, 0, 0}, 0.9f, {0.2f, 0.3f});
  ASSERT_TRUE(alone && in_set);
  EXPECT_EQ(alone->wi, in_set->wi);
  EXPECT_EQ(alone->pdf, in_set->pdf);
}

TEST(LightSet, irradiance_of_many_deltas_is_their_sum) {
  Scene scene;
  scene.lamps = {PointLight{.position = {0, 0, 2}, .intensity = Color(4)},
                 PointLight{.position = {3, 0, 4}, .intensity = Color(100)},
                 SunLight{.direction = {0, 0, -1}, .irradiance = Color(0.5f)}};
  const double expected = 4.0 / 4 + 100.0 / 25 * 0.8 + 0.5;
  EXPECT_NEAR(irradiance(scene.lights(), {0, 0, 0}, {0, 0, 1}), expected, 0.02);
}

TEST(LightSet, an_environment_of_one_colour_leaves_nothing_to_sample) {
  Scene scene;
  scene.environment.radiance = Color(1);
  const LightSet lights = scene.lights();
  EXPECT_TRUE(lights.is_empty());
  EXPECT_FALSE(lights.sample(Vec3f{0, 0, 0}, 0.5f, {0.5f, 0.5f}));
  EXPECT_EQ(lights.pdf_environment({0, 0, 1}), 0);
  EXPECT_EQ(lights.environment_radiance({0, 0, 1}, false), Color(1));
}

TEST(LightSet, pictures_around_the_scene_share_the_choice_with_lamps) {
  std::vector<float> greys(64 * 32);
  for (std::size_t i = 0; i < greys.size(); ++i) greys[i] = 1 + float(i % 7);
  Scene scene;
  scene.environment.layers = {{.image = {.width = 64, .height = 32, .channels = 1, .pixels = greys, .path = ""}}};
  scene.lamps = {PointLight{.position = {0, 0, 2}, .intensity = Color(4), .radius = 0.5f}};
  const LightSet lights = scene.lights();
  const auto sample = [&](Rng& rng) -> std::optional<Vec3f> {
    const float choice = next_unit_float(rng);
    const auto s = lights.sample(Vec3f{0, 0, 0}, choice, next_unit_vec2(rng));
    if (!s) return std::nullopt;
    return s->wi;
  };
  const auto density = [&](Vec3f wi) {
    double sum = lights.pdf_environment(wi);
    for_each_lamp_density(lights, Vec3f{0, 0, 0}, wi, [&](const LightHit& hit) { sum += hit.pdf; });
    return sum;
  };
  const auto result = chi_square_sphere(sample, density, {.samples = 50000, .pilot_samples = 20000});
  EXPECT_GT(result.p_value, 1e-3) << result.describe();
  EXPECT_NEAR(result.mass, 1, 0.01) << result.describe();
}

TEST(LightSet, surfaces_that_do_not_shine_have_no_density) {
  Scene scene;
  scene.add(triangle_mesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), {}, {Color(1)}, {Color(1)});
  const LightSet lights = scene.lights();
  for (const std::uint32_t instance : {0u, 2u, 1000u}) {
    SurfacePoint point;
    point.instance = instance;
    EXPECT_EQ(lights.pdf_surface(point, Vec3f{0, 0, 1}), 0) << instance;
  }
}

TEST(LightSet, a_million_triangles_shed_the_light_of_the_square_that_they_make) {
  // A grid of 707 x 707 squares, two triangles each, at unit height over the origin.
  constexpr std::uint32_t n = 707;
  Mesh grid;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) grid.positions.push_back({2 * float(x) / n - 1, 2 * float(y) / n - 1, 1});
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t corner = y * (n + 1) + x;
      grid.triangles.push_back({corner, corner + 1, corner + n + 1});
      grid.triangles.push_back({corner + 1, corner + n + 2, corner + n + 1});
    }
  Scene scene;
  scene.add(std::move(grid), {}, {Color(1)}, {Color(1)});
  const double expected = polygon_irradiance({{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, {0, 0, 1});
  EXPECT_NEAR(irradiance(scene.lights(), {0, 0, 0}, {0, 0, 1}) / expected, 1, 5e-3);
}

TEST(LightSet, samples_for_each_set_of_receivers_are_of_the_lights_that_light_it) {
  Rng rng(5);
  Scene scene;
  const auto lit = [](std::uint64_t bits) { return LinkSets{bits}; };
  scene.lamps.push_back(PointLight{.position = {1, 0, 3}, .radius = 0.3f, .lit_sets = lit(0b0110)});
  scene.lamps.push_back(SunLight{.direction = {0, 0.3f, -1}, .angle = 0.4f, .lit_sets = lit(0b0011)});
  scene.lamps.push_back(AreaLight{.to_world = {}, .lit_sets = lit(0b1010)});
  scene.lamps.push_back(PointLight{.position = {-4, 0, 0}, .radius = 0.5f, .lit_sets = lit(0b1000)});
  scene.add(random_mesh(7, rng), {}, {Color(1.0f), Color(2.0f), Color(0.5f)}, {Color(0.0f), Color(1.0f), Color(0.0f)});
  scene.emitters.back().lit_sets = lit(0b1100);
  const LightSet lights = scene.lights();
  for (const int set : {0, 1, 2, 3, 17, int{LinkSets::unlinked}}) {
    const LitPoint point({0.1f, 0.2f, -2}, Vec3f(0), set);
    int accepted = 0;
    double sum = 0;
    constexpr int n = 100000;
    for (int i = 0; i < n; ++i) {
      const float choice = next_unit_float(rng);
      if (const auto sample = lights.sample(point, choice, next_unit_vec2(rng))) {
        ++accepted;
        double least_difference = infinity;
        for_each_density(scene, lights, point, sample->wi, [&](std::uint32_t, float, float pdf) {
          least_difference = std::min(least_difference, std::abs(double(pdf) / sample->pdf - 1));
        });
        ASSERT_LT(least_difference, 2e-3) << "set " << set;
      }
      for_each_density(scene, lights, point, random_direction(rng),
                       [&](std::uint32_t, float, float pdf) { sum += 4 * double(pi) * pdf; });
    }
    EXPECT_EQ(accepted == 0, set == 17);
    EXPECT_NEAR(sum / n, double(accepted) / n, 0.1) << "set " << set;
  }
}

}  // namespace
}  // namespace basicrt
