#include "embree_peer.h"

// The thread sanitizer cannot follow an Embree that is not built with it, and would report every task.
#if defined(BOXWOOD_HAS_EMBREE) && !defined(__SANITIZE_THREAD__)

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <type_traits>

#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include "boxwood/core/error.h"
#include "embree_settings.h"

namespace boxwood::app {
namespace {

constexpr std::size_t kPacket = 16;

/// A device, and how much memory it holds.
class Device {
 public:
  Device() : device_(rtcNewDevice(embree_config())) {
    if (!device_) throw std::runtime_error("Embree cannot start on this machine");
    rtcSetDeviceMemoryMonitorFunction(device_, count, &bytes_);
  }
  ~Device() { rtcReleaseDevice(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  operator RTCDevice() const { return device_; }
  std::int64_t bytes() const { return bytes_; }

 private:
  static bool count(void* bytes, ssize_t change, bool) {
    *static_cast<std::atomic<std::int64_t>*>(bytes) += change;
    return true;
  }
  std::atomic<std::int64_t> bytes_ = 0;
  RTCDevice device_;
};

void write(const Ray& in, RTCRay& out) {
  out = {in.origin.x,    in.origin.y,    in.origin.z, in.t_min, in.direction.x,
         in.direction.y, in.direction.z, 0,           in.t_max, ~0u};
}

void write(const Ray& in, RTCRay16& out, std::size_t lane) {
  out.org_x[lane] = in.origin.x, out.org_y[lane] = in.origin.y, out.org_z[lane] = in.origin.z;
  out.dir_x[lane] = in.direction.x, out.dir_y[lane] = in.direction.y, out.dir_z[lane] = in.direction.z;
  out.tnear[lane] = in.t_min, out.tfar[lane] = in.t_max;
  out.time[lane] = 0, out.mask[lane] = ~0u, out.id[lane] = out.flags[lane] = 0;
}

RTCIntersectContext context_for(bool is_coherent) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (is_coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

bool is_occluded(float t_far) {
  return t_far < 0;
}

/// One call for each ray. Query is RTCRayHit, or RTCRay for any hit.
template <class Query>
class Singles final : public Work {
 public:
  Singles(RTCScene scene, std::span<const Ray> rays) : scene_(scene), queries_(rays.size()) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if constexpr (kIsClosest) {
        write(rays[i], queries_[i].ray);
        queries_[i].hit.geomID = queries_[i].hit.primID = RTC_INVALID_GEOMETRY_ID;
      } else {
        write(rays[i], queries_[i]);
      }
    }
  }
  void run(Executor& executor) override {
    executor.for_range(0, queries_.size(), kRaysPerChunk, [this](std::size_t begin, std::size_t end) {
      const DenormalsAreZero mode;
      RTCIntersectContext context = context_for(false);
      for (std::size_t i = begin; i < end; ++i) {
        if constexpr (kIsClosest)
          rtcIntersect1(scene_, &context, &queries_[i]);
        else
          rtcOccluded1(scene_, &context, &queries_[i]);
      }
    });
  }
  Answers answers() const override {
    Answers answers;
    for (const Query& query : queries_) {
      if constexpr (kIsClosest) {
        if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) answers.add_hit(query.ray.tfar);
      } else {
        if (is_occluded(query.tfar)) answers.add_hit(1);
      }
    }
    return answers;
  }

 private:
  static constexpr bool kIsClosest = std::is_same_v<Query, RTCRayHit>;
  RTCScene scene_;
  std::vector<Query> queries_;
};

/// Sixteen neighbours of the set in each call. Query is RTCRayHit16, or RTCRay16 for any hit.
template <class Query>
class Packets final : public Work {
 public:
  Packets(RTCScene scene, std::span<const Ray> rays, bool is_coherent)
      : scene_(scene),
        count_(rays.size()),
        is_coherent_(is_coherent),
        queries_((rays.size() + kPacket - 1) / kPacket) {
    // The lanes beyond the last ray repeat it, and are switched off in run().
    for (std::size_t i = 0; i < queries_.size() * kPacket; ++i)
      write(rays[std::min(i, rays.size() - 1)], ray_of(queries_[i / kPacket]), i % kPacket);
    if constexpr (kIsClosest)
      for (RTCRayHit16& query : queries_)
        for (std::size_t lane = 0; lane < kPacket; ++lane)
          query.hit.geomID[lane] = query.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
  }
  void run(Executor& executor) override {
    executor.for_range(0, queries_.size(), kRaysPerChunk / kPacket,
                       [this](std::size_t begin, std::size_t end) {
                         const DenormalsAreZero mode;
                         RTCIntersectContext context = context_for(is_coherent_);
                         alignas(64) int valid[kPacket];
                         for (int& lane : valid) lane = -1;
                         for (std::size_t p = begin; p < end; ++p) {
                           if ((p + 1) * kPacket > count_)
                             for (std::size_t lane = 0; lane < kPacket; ++lane)
                               valid[lane] = p * kPacket + lane < count_ ? -1 : 0;
                           if constexpr (kIsClosest)
                             rtcIntersect16(valid, scene_, &context, &queries_[p]);
                           else
                             rtcOccluded16(valid, scene_, &context, &queries_[p]);
                         }
                       });
  }
  Answers answers() const override {
    Answers answers;
    for (std::size_t i = 0; i < count_; ++i) {
      const Query& query = queries_[i / kPacket];
      const std::size_t lane = i % kPacket;
      if constexpr (kIsClosest) {
        if (query.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) answers.add_hit(query.ray.tfar[lane]);
      } else {
        if (is_occluded(query.tfar[lane])) answers.add_hit(1);
      }
    }
    return answers;
  }

 private:
  static constexpr bool kIsClosest = std::is_same_v<Query, RTCRayHit16>;
  static RTCRay16& ray_of(Query& query) {
    if constexpr (kIsClosest)
      return query.ray;
    else
      return query;
  }

  RTCScene scene_;
  std::size_t count_;
  bool is_coherent_;
  std::vector<Query> queries_;
};

RTCBuildQuality quality_of(const std::string& preset) {
  if (preset == "low") return RTC_BUILD_QUALITY_LOW;
  if (preset == "high") return RTC_BUILD_QUALITY_HIGH;
  return RTC_BUILD_QUALITY_MEDIUM;
}

class EmbreeScene final : public BuiltScene {
 public:
  EmbreeScene(std::shared_ptr<const Device> device, const TriangleMesh& mesh, const std::string& preset,
              bool is_robust, const Progress& progress)
      : device_(std::move(device)) {
    const std::int64_t before = device_->bytes();
    const double start = seconds_now();
    scene_ = rtcNewScene(*device_);
    rtcSetSceneFlags(scene_, is_robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_, quality_of(preset));

    RTCGeometry geometry = rtcNewGeometry(*device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(),
                               0, sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices.data(), 0,
                               sizeof(mesh.indices[0]), mesh.indices.size());
    // The scene's quality low asks each geometry for its own.
    rtcSetGeometryBuildQuality(geometry, quality_of(preset));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);

    // Embree tells from several threads at once, Progress is told by one at a time.
    struct Listener {
      const Progress& progress;
      std::mutex one_at_a_time;
    } listener{progress, {}};
    const auto tell = [](void* told, double done) {
      Listener& to = *static_cast<Listener*>(told);
      const std::lock_guard lock(to.one_at_a_time);
      return !to.progress || to.progress("building", done);
    };
    rtcSetSceneProgressMonitorFunction(scene_, tell, &listener);
    rtcCommitScene(scene_);
    build_ms_ = 1e3 * (seconds_now() - start);
    rtcSetSceneProgressMonitorFunction(scene_, nullptr, nullptr);
    const RTCError error = rtcGetDeviceError(*device_);
    if (error != RTC_ERROR_NONE) {
      rtcReleaseScene(scene_);
      if (error == RTC_ERROR_CANCELLED) throw Cancelled();
      if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
      throw std::runtime_error("Embree cannot build the scene (error " + std::to_string(error) + ")");
    }
    size_bytes_ = static_cast<std::size_t>(device_->bytes() - before);
  }
  ~EmbreeScene() override { rtcReleaseScene(scene_); }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  double build_ms() const override { return build_ms_; }
  std::size_t size_bytes() const override { return size_bytes_; }
  std::unique_ptr<Work> prepare(std::span<const Ray> rays, const TraceOptions& options) const override {
    const bool is_closest = options.question == Question::closest_hit;
    if (options.mode == "single") {
      if (is_closest) return std::make_unique<Singles<RTCRayHit>>(scene_, rays);
      return std::make_unique<Singles<RTCRay>>(scene_, rays);
    }
    if (is_closest) return std::make_unique<Packets<RTCRayHit16>>(scene_, rays, options.is_coherent);
    return std::make_unique<Packets<RTCRay16>>(scene_, rays, options.is_coherent);
  }

 private:
  std::shared_ptr<const Device> device_;
  RTCScene scene_;
  double build_ms_ = 0;
  std::size_t size_bytes_ = 0;
};

class EmbreeEngine final : public Engine {
 public:
  explicit EmbreeEngine(bool is_robust) : device_(std::make_shared<Device>()), is_robust_(is_robust) {}
  std::string name() const override { return is_robust_ ? "embree-robust" : "embree"; }
  std::vector<std::string> modes() const override { return {"single", "packet16"}; }
  std::vector<std::string> presets() const override {
    if (is_robust_) return {"medium"};
    return {"low", "medium", "high"};
  }
  std::string traced_preset() const override { return "medium"; }
  std::unique_ptr<BuiltScene> build(const TriangleMesh& mesh, const std::string& preset, int threads,
                                    const Progress& progress) const override {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    return std::make_unique<EmbreeScene>(device_, mesh, preset, is_robust_, progress);
  }

 private:
  std::shared_ptr<const Device> device_;
  bool is_robust_;
};

}  // namespace

std::vector<std::unique_ptr<Engine>> embree_engines() {
  std::vector<std::unique_ptr<Engine>> engines;
  for (const bool is_robust : {false, true}) engines.push_back(std::make_unique<EmbreeEngine>(is_robust));
  return engines;
}

std::string embree_version() {
  return RTC_VERSION_STRING;
}

}  // namespace boxwood::app

#else

namespace boxwood::app {

std::vector<std::unique_ptr<Engine>> embree_engines() {
  return {};
}

std::string embree_version() {
  return "";
}

}  // namespace boxwood::app

#endif
