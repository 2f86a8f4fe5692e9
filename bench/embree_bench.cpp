// embree_bench: how fast is Embree, one ray at a time, on the same triangles and rays?
//
// A peer to measure against; its answers may differ from ours in the last bits, which the checksum shows.
#include <array>

#include <embree3/rtcore.h>

#include "boxwood/build/build.h"
#include "workload.h"

namespace boxwood::bench {
namespace {

class EmbreeScene {
 public:
  explicit EmbreeScene(const std::vector<Triangle>& input)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), 3 * input.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), input.size()));
    for (std::size_t i = 0; i < input.size(); ++i) {
      vertices[3 * i] = input[i].a;
      vertices[3 * i + 1] = input[i].b;
      vertices[3 * i + 2] = input[i].c;
      for (std::size_t k = 0; k < 3; ++k) indices[3 * i + k] = static_cast<unsigned>(3 * i + k);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  float closest(const Ray& ray) const {
    RTCRayHit query{};
    query.ray = to_embree(ray);
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kInfinity : query.ray.tfar;
  }
  float any(const Ray& ray) const {
    RTCRay query = to_embree(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0 ? 1.0f : kInfinity;
  }

 private:
  static RTCRay to_embree(const Ray& ray) {
    RTCRay out{};
    out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
    out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
    out.tnear = ray.t_min, out.tfar = ray.t_max, out.mask = ~0u;
    return out;
  }

  RTCDevice device_;
  RTCScene scene_;
};

Box3 bounds_of(const std::vector<Triangle>& input) {
  Box3 bounds;
  for (const Triangle& triangle : input) bounds.extend(triangle.box());
  return bounds;
}

void embree_closest(benchmark::State& state, const char* scene_name) {
  const auto& input = triangles(scene_name);
  const EmbreeScene scene(input);
  measure_rays(state, mixed_rays(bounds_of(input), kRays),
               [&](const Ray& ray) { return scene.closest(ray); });
}

void embree_any(benchmark::State& state, const char* scene_name) {
  const auto& input = triangles(scene_name);
  const EmbreeScene scene(input);
  measure_rays(state, shadow_rays(bounds_of(input), kRays), [&](const Ray& ray) { return scene.any(ray); });
}

BENCHMARK_CAPTURE(embree_closest, terrain, "terrain:512")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(embree_closest, soup, "soup:100000")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(embree_any, terrain, "terrain:512")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(embree_any, soup, "soup:100000")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace boxwood::bench
