// leak_hunt: how many rays slip through closed meshes?
//
//   leak_hunt [RAYS [EMBREE_RAYS [compact]]]     1e7 rays by default, of which 1e7 at most are asked of
//   Embree too;
//                                                in the compact layout where that word stands
//
// The rays of support/leak_rays.h on all threads: each by a batch for the closest hit, every tenth by all
// hits, whose crossings must add up. Embree, where it is installed, gets the first of the very same rays, one
// by one, in its default and in its robust mode. Prints tables in Markdown (docs/performance.md); exits with
// 1 when a ray of ours leaked or was miscounted.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "boxwood/build/build.h"
#include "boxwood/simd/kernels.h"
#include "boxwood/tree/collapse.h"
#include "support/leak_rays.h"
#ifdef BOXWOOD_HAS_EMBREE
#include <embree3/rtcore.h>
#endif

namespace boxwood {
namespace {

constexpr std::size_t kBlock = 10'000;  // rays
constexpr std::size_t kCountEvery = 10;

struct Count {
  std::size_t rays = 0, leaks = 0, counted = 0, miscounted = 0;
  std::size_t embree_rays = 0, embree_leaks = 0, robust_leaks = 0;

  Count& operator+=(const Count& o) {
    rays += o.rays, leaks += o.leaks, counted += o.counted, miscounted += o.miscounted;
    embree_rays += o.embree_rays, embree_leaks += o.embree_leaks, robust_leaks += o.robust_leaks;
    return *this;
  }
};

#ifdef BOXWOOD_HAS_EMBREE
/// A mesh in Embree, by shared vertices as in the mesh itself.
class Peer {
 public:
  Peer(const test::Mesh& mesh, bool is_robust)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    if (is_robust) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
    auto* faces = static_cast<std::array<std::uint32_t, 3>*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.indices.size()));
    std::copy(mesh.indices.begin(), mesh.indices.end(), faces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Peer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  bool hits(const Ray& ray) const {
    RTCRayHit query{};
    query.ray = {ray.origin.x,    ray.origin.y,
                 ray.origin.z,    ray.t_min,
                 ray.direction.x, ray.direction.y,
                 ray.direction.z, 0,
                 ray.t_max,       ~0u};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};
#endif

/// Shoots `rays` rays at the body there; the first `embree_rays` by Embree too.
Count hunt(const simd::Kernels& kernels, simd::Layout layout, const test::Body& body, Vec3 offset,
           std::size_t rays, std::size_t embree_rays) {
  const test::Mesh mesh = test::placed(body.mesh, 1, offset);
  const std::vector<Triangle> triangles = test::triangles(mesh);
  const Bvh bvh = build(boxes(triangles));
  const Box3 bounds = bvh.bounds();
  const simd::TriangleTree tree = with_width(kernels.width, [&](auto w) {
    return simd::TriangleTree(collapse<w()>(bvh, default_executor()), triangles, {}, default_executor(),
                              layout);
  });
#ifdef BOXWOOD_HAS_EMBREE
  const Peer fast(mesh, false), robust(mesh, true);
#endif

  const std::size_t blocks = (rays + kBlock - 1) / kBlock;
  [[maybe_unused]] const std::size_t embree_blocks = (embree_rays + kBlock - 1) / kBlock;
  std::vector<Count> counts(blocks);
  parallel_for(default_executor(), 0, blocks, 1, [&](std::size_t block) {
    Random random(3, block);
    Count count;
    std::vector<test::AimedRay> aimed(kBlock);
    std::vector<Ray> batch(kBlock);
    std::vector<simd::TriangleHit> hits(kBlock), all;
    for (std::size_t i = 0; i < kBlock; ++i) {
      aimed[i] = test::aim(mesh, body.inside + offset, body.clearance, 2, random);
      batch[i] = aimed[i].ray;
    }

    // A ray that is handed back counts as a leak: none of these is so unusual.
    std::vector<std::uint32_t> unusual;
    kernels.closest_hits(tree, batch, bounds, hits.data(), nullptr, unusual);
    count.rays = kBlock;
    count.leaks = unusual.size();
    for (std::size_t i = 0; i < kBlock; ++i) count.leaks += aimed[i].must_hit && !hits[i].is_hit();

    // Add up the crossings of some.
    for (std::size_t i = 0; i < kBlock; i += kCountEvery) {
      all.clear();
      kernels.all_hits(tree, batch[i], bounds, all);
      const PreparedRay prepared(batch[i], bounds);
      int sum = 0;
      for (const simd::TriangleHit& hit : all)
        sum += test::crossing_sign(prepared, tree.triangle(hit.block, hit.lane));
      ++count.counted;
      count.miscounted +=
          sum != int(aimed[i].starts_inside) || all.size() % 2 != std::size_t(aimed[i].starts_inside);
    }

#ifdef BOXWOOD_HAS_EMBREE
    if (block < embree_blocks) {
      count.embree_rays = kBlock;
      for (const auto& [ray, starts_inside, must_hit] : aimed) {
        count.embree_leaks += must_hit && !fast.hits(ray);
        count.robust_leaks += must_hit && !robust.hits(ray);
      }
    }
#endif
    counts[block] = count;
  });
  Count sum;
  for (const Count& count : counts) sum += count;
  return sum;
}

void print_head(const char* first) {
  std::printf(
      "\n| %s | rays | leaks | counted | miscounted | asked of Embree | its leaks | its leaks, robust |\n",
      first);
  std::printf("|---|---|---|---|---|---|---|---|\n");
}

void print_row(const std::string& name, const Count& c) {
  std::printf("| %s | %zu | %zu | %zu | %zu | %zu | %zu | %zu |\n", name.c_str(), c.rays, c.leaks, c.counted,
              c.miscounted, c.embree_rays, c.embree_leaks, c.robust_leaks);
}

int run(double rays, double embree_rays, simd::Layout layout) {
  const simd::Kernels* kernels = simd::kernels();
  if (kernels == nullptr || !(rays >= 1) || !(embree_rays >= 0)) {
    std::fprintf(stderr,
                 "leak_hunt: needs kernels for this machine, at least one ray, and no negative number\n");
    return 2;
  }
  const std::vector<test::Body>& bodies = test::bodies();
  constexpr std::size_t kOffsetCount = std::size(test::kOffsets);
  const double share = 1.0 / double(bodies.size() * kOffsetCount);

  std::vector<Count> by_body(bodies.size()), by_offset(kOffsetCount);
  Count total;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (std::size_t o = 0; o < kOffsetCount; ++o) {
      const Count count = hunt(*kernels, layout, bodies[b], test::kOffsets[o], std::size_t(rays * share),
                               std::size_t(embree_rays * share));
      by_body[b] += count;
      by_offset[o] += count;
      total += count;
      std::fprintf(stderr, "%s at %g: %zu rays so far\n", bodies[b].name.c_str(), test::kOffsets[o].x,
                   total.rays);
    }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  std::printf("Kernels: %s, %d threads, %.0f s.\n", std::string(kernels->name).c_str(),
              default_executor().concurrency(), seconds);
  print_head("body");
  for (std::size_t b = 0; b < bodies.size(); ++b) print_row(bodies[b].name, by_body[b]);
  print_row("all", total);
  print_head("distance from 0 along each axis");
  for (std::size_t o = 0; o < kOffsetCount; ++o)
    print_row(std::to_string(int(std::abs(test::kOffsets[o].x))), by_offset[o]);
  return total.leaks + total.miscounted == 0 ? 0 : 1;
}

}  // namespace
}  // namespace boxwood

int main(int argc, char** argv) {
  const double rays = argc > 1 ? std::atof(argv[1]) : 1e7;
  const bool is_compact = argc > 3 && std::string(argv[3]) == "compact";
  return boxwood::run(rays,
                      argc > 2     ? std::atof(argv[2])
                      : rays < 1e7 ? rays
                                   : 1e7,
                      is_compact ? boxwood::simd::Layout::compact : boxwood::simd::Layout::full);
}
