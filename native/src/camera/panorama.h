// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras that bend straight lines: from a place in the window to a direction in the camera's space, and back.
#pragma once

#include <concepts>
#include <optional>
#include <string_view>

#include "camera/camera_base.h"

namespace basicrt {

// Not of unit length where that comes easier.
struct Bearing {
  Vec3f direction;
  Vec3f dx, dy;  // its derivatives by the place in the window
};

// Each has:
//   bool sees(Vec2f place)                            whether there is a picture
//   Bearing bearing(Vec2f place)                      the direction that is seen there
//   std::optional<Vec2f> place_of(Vec3f direction)    where in the window one of unit length would be seen, beyond its
//                                                     edges too; nothing where no place shows it

// Longitude and latitude: (0, 0) is straight ahead, longitude grows to the right.
struct EquirectangularCamera : CameraBase {
  EquirectangularCamera() {
    window_min = {-pi, -pi / 2};
    window_max = {pi, pi / 2};
  }
  [[nodiscard]] bool sees(Vec2f) const { return true; }
  [[nodiscard]] Bearing bearing(Vec2f place) const;
  [[nodiscard]] std::optional<Vec2f> place_of(Vec3f direction) const;
  static constexpr std::string_view kind = "equirectangular";
  static constexpr auto fields() {
    return camera_fields<EquirectangularCamera>("lowest longitude and latitude, radians",
                                                "highest longitude and latitude, radians");
  }
};

// The distance from the window's origin is the angle from the axis.
struct FisheyeEquidistantCamera : CameraBase {
  FisheyeEquidistantCamera() {
    window_min = {-pi / 2, -pi / 2};
    window_max = {pi / 2, pi / 2};
  }
  float fov = pi;
  [[nodiscard]] bool sees(Vec2f place) const;
  [[nodiscard]] Bearing bearing(Vec2f place) const;
  [[nodiscard]] std::optional<Vec2f> place_of(Vec3f direction) const;
  static constexpr std::string_view kind = "fisheye_equidistant";
  static constexpr auto fields() {
    using C = FisheyeEquidistantCamera;
    return camera_fields<C>("lower left corner, radians from the axis", "upper right corner, radians from the axis",
                            field("fov", &C::fov, "full angle of the circle that is seen, radians", above(0)));
  }
};

// Equal areas of the window see equal solid angles: the distance from its origin is 2 focal_length sin(angle / 2). A
// mirror ball seen from afar is one of focal length 0.5, the ball having the radius 1, and a fov of 2 pi.
struct FisheyeEquisolidCamera : CameraBase {
  float fov = pi;
  float focal_length = 0.7071068f;
  [[nodiscard]] bool sees(Vec2f place) const;
  [[nodiscard]] Bearing bearing(Vec2f place) const;
  [[nodiscard]] std::optional<Vec2f> place_of(Vec3f direction) const;
  static constexpr std::string_view kind = "fisheye_equisolid";
  static constexpr auto fields() {
    using C = FisheyeEquisolidCamera;
    return camera_fields<C>("lower left corner, in the focal length's unit",
                            "upper right corner, in the focal length's unit",
                            field("fov", &C::fov, "full angle of the circle that is seen, radians", above(0)),
                            field("focal_length", &C::focal_length, "in the window's unit", above(0)));
  }
};

// With r the distance from the window's origin, the angle from the axis is k0 + k1 r + k2 r^2 + k3 r^3 + k4 r^4.
struct FisheyePolynomialCamera : CameraBase {
  float fov = pi;
  float k0 = 0, k1 = 1, k2 = 0, k3 = 0, k4 = 0;
  [[nodiscard]] float angle(float r) const { return k0 + r * (k1 + r * (k2 + r * (k3 + r * k4))); }
  [[nodiscard]] float slope(float r) const { return k1 + r * (2 * k2 + r * (3 * k3 + r * 4 * k4)); }
  [[nodiscard]] bool sees(Vec2f place) const;
  [[nodiscard]] Bearing bearing(Vec2f place) const;
  [[nodiscard]] std::optional<Vec2f> place_of(Vec3f direction) const;
  static constexpr std::string_view kind = "fisheye_polynomial";
  static constexpr auto fields() {
    using C = FisheyePolynomialCamera;
    return camera_fields<C>(
        "lower left corner, in the polynomial's unit", "upper right corner, in the polynomial's unit",
        field("fov", &C::fov, "full angle of what is seen, radians", above(0)),
        field("k0", &C::k0, "of the angle's polynomial in the distance, radians"),
        field("k1", &C::k1, "the factor of the distance"), field("k2", &C::k2, "the factor of its square"),
        field("k3", &C::k3, "the factor of its third power"), field("k4", &C::k4, "the factor of its fourth power"));
  }
};

// One face of a cube whose pixels are spaced evenly in angle.
struct CubemapFaceCamera : CameraBase {
  CubemapFaceCamera() {
    window_min = {-pi / 4, -pi / 4};
    window_max = {pi / 4, pi / 4};
  }
  [[nodiscard]] bool sees(Vec2f place) const;
  [[nodiscard]] Bearing bearing(Vec2f place) const;
  [[nodiscard]] std::optional<Vec2f> place_of(Vec3f direction) const;
  static constexpr std::string_view kind = "cubemap_face";
  static constexpr auto fields() {
    return camera_fields<CubemapFaceCamera>("lower left corner, angles from the axis, radians",
                                            "upper right corner, angles from the axis, radians");
  }
};

// Seen from the axis of an upright cylinder of radius 1.
struct CylindricalCamera : CameraBase {
  CylindricalCamera() {
    window_min = {-pi, -1};
    window_max = {pi, 1};
  }
  [[nodiscard]] bool sees(Vec2f) const { return true; }
  [[nodiscard]] Bearing bearing(Vec2f place) const;
  [[nodiscard]] std::optional<Vec2f> place_of(Vec3f direction) const;
  static constexpr std::string_view kind = "cylindrical";
  static constexpr auto fields() {
    return camera_fields<CylindricalCamera>("lowest longitude, radians, and height, in radii",
                                            "highest longitude, radians, and height, in radii");
  }
};

template <class Kind>
concept Panorama = requires(const Kind& kind) {
  { kind.bearing(Vec2f{}) } -> std::same_as<Bearing>;
  { kind.place_of(Vec3f{}) } -> std::same_as<std::optional<Vec2f>>;
};

}  // namespace basicrt
