// SPDX-License-Identifier: GPL-3.0-or-later
// The peer: Embree 3 in its robust mode, one ray at a time and in packets of 16.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/hit.h"
#include "geometry/mesh.h"
#include "math/ray.h"
#include "math/transform.h"

namespace basicrt::benchmark {

class EmbreeDevice {
 public:
  explicit EmbreeDevice(int threads) : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    const auto count = [](void* bytes, ssize_t change, bool) {
      *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += change;
      return true;
    };
    rtcSetDeviceMemoryMonitorFunction(device_, count, &bytes_);
  }
  ~EmbreeDevice() { rtcReleaseDevice(device_); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  [[nodiscard]] RTCDevice get() const { return device_; }
  [[nodiscard]] std::ptrdiff_t bytes() const { return bytes_; }  // that it holds

 private:
  RTCDevice device_;
  std::atomic<std::ptrdiff_t> bytes_ = 0;
};

class EmbreeScene {
 public:
  explicit EmbreeScene(const EmbreeDevice& device) : device_(device.get()), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  }
  ~EmbreeScene() {
    if (scene_ != nullptr) rtcReleaseScene(scene_);
  }
  EmbreeScene(EmbreeScene&& other) noexcept : device_(other.device_), scene_(std::exchange(other.scene_, nullptr)) {}
  EmbreeScene& operator=(EmbreeScene&&) = delete;

  // The mesh must stay where it is, and have room for one more position: Embree reads past the last one.
  void add(const Mesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               sizeof(Vec3f), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0, 12,
                               mesh.triangles.size());
    attach(geometry);
  }
  void add_instance(const EmbreeScene& of, const TransformD& object_to_world) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, of.scene_);
    const Transform rounded(object_to_world);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, rounded.rows.data());
    attach(geometry);
  }
  void build() { rtcCommitScene(scene_); }
  [[nodiscard]] RTCScene get() const { return scene_; }

 private:
  void attach(RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene scene_;
};

// Whether rays ask for the nearest hit or for any, and whether Embree is told that neighbours go together.
struct EmbreeQuery {
  bool is_any = false, is_coherent = false;

  [[nodiscard]] RTCIntersectContext context() const {
    RTCIntersectContext result;
    rtcInitIntersectContext(&result);
    if (is_coherent) result.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return result;
  }
};

// In Embree's own format, made before the clock starts.
class EmbreeRays {
 public:
  void set(std::span<const Ray> rays) {
    rays_.assign(rays.size(), {});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto& [origin, t_min, direction, t_max, kinds, time, from_instance, from_primitive] = rays[i];
      rays_[i].ray = {.org_x = origin.x,
                      .org_y = origin.y,
                      .org_z = origin.z,
                      .tnear = t_min,
                      .dir_x = direction.x,
                      .dir_y = direction.y,
                      .dir_z = direction.z,
                      .tfar = t_max,
                      .mask = ~0u};
      rays_[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rays_[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  void trace(const EmbreeScene& scene, EmbreeQuery query, std::size_t begin, std::size_t end) {
    RTCIntersectContext context = query.context();
    for (std::size_t i = begin; i < end; ++i) {
      if (query.is_any)
        rtcOccluded1(scene.get(), &context, &rays_[i].ray);
      else
        rtcIntersect1(scene.get(), &context, &rays_[i]);
    }
  }
  // The distance, or infinity; after a query for any hit minus infinity where there is one.
  [[nodiscard]] float distance(std::size_t ray, EmbreeQuery query) const {
    const bool is_miss = !query.is_any && rays_[ray].hit.geomID == RTC_INVALID_GEOMETRY_ID;
    return is_miss ? infinity : rays_[ray].ray.tfar;
  }

 private:
  std::vector<RTCRayHit> rays_;
};

// The same in packets of 16. The last may be filled up with rays that are not traced.
class EmbreePackets {
 public:
  static constexpr std::size_t width = 16;

  void set(std::span<const Ray> rays) {
    count_ = rays.size();
    packets_.assign((count_ + width - 1) / width, {});
    for (std::size_t i = 0; i < count_; ++i) {
      RTCRay16& to = packets_[i / width].ray;
      const std::size_t lane = i % width;
      to.org_x[lane] = rays[i].origin.x;
      to.org_y[lane] = rays[i].origin.y;
      to.org_z[lane] = rays[i].origin.z;
      to.tnear[lane] = rays[i].t_min;
      to.dir_x[lane] = rays[i].direction.x;
      to.dir_y[lane] = rays[i].direction.y;
      to.dir_z[lane] = rays[i].direction.z;
      to.tfar[lane] = rays[i].t_max;
      to.mask[lane] = ~0u;
      packets_[i / width].hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packets_[i / width].hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  // `begin` is the first ray of a packet.
  void trace(const EmbreeScene& scene, EmbreeQuery query, std::size_t begin, std::size_t end) {
    RTCIntersectContext context = query.context();
    for (std::size_t i = begin; i < end; i += width) {
      alignas(64) std::array<int, width> is_valid;
      for (std::size_t lane = 0; lane < width; ++lane) is_valid[lane] = i + lane < count_ ? -1 : 0;
      if (query.is_any)
        rtcOccluded16(is_valid.data(), scene.get(), &context, &packets_[i / width].ray);
      else
        rtcIntersect16(is_valid.data(), scene.get(), &context, &packets_[i / width]);
    }
  }

 private:
  std::size_t count_ = 0;
  std::vector<RTCRayHit16> packets_;
};

}  // namespace basicrt::benchmark
