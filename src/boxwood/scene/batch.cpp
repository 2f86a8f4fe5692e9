// batch.cpp: how are many rays answered?
//
// In chunks, one for each task: the kernel takes a chunk's rays in turns and says what each does to the
// world's triangles, plain C++ answers the few rays that it does not take, and then every answer is worked
// out. A chunk is long enough that the kernel is rarely short of rays, and its findings stay in the cache.
#include "boxwood/scene/batch.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "boxwood/scene/closest.h"

namespace boxwood {
namespace {

using detail::kMaxChunk;

void check_lengths(std::size_t rays, std::size_t hits) {
  if (rays != hits)
    throw std::invalid_argument("a batch of " + std::to_string(rays) + " rays came with room for " +
                                std::to_string(hits) + " hits, expected the same number");
}

/// A thread's memory between a kernel and the answers; taken while in use, because a user's own shape may ask
/// a scene from inside.
class Scratch {
 public:
  Scratch() : buffers_(std::exchange(spare(), {})) {
    buffers_.found.resize(kMaxChunk);
    buffers_.unusual.clear();
  }
  ~Scratch() { spare() = std::move(buffers_); }
  Scratch(const Scratch&) = delete;

  simd::TriangleHit* found() { return buffers_.found.data(); }
  std::vector<std::uint32_t>& unusual() { return buffers_.unusual; }

 private:
  struct Buffers {
    std::vector<simd::TriangleHit> found;
    std::vector<std::uint32_t> unusual;
  };
  static Buffers& spare() {
    static thread_local Buffers mine;
    return mine;
  }
  Buffers buffers_;
};

/// Works out the answers for a scene of triangles only.
void finish_triangles(const Scene::Parts& parts, std::span<const Ray> rays, const simd::TriangleHit* found,
                      Hit* hits) {
  // A few at a time, so that they are still in the nearest cache when they get their ids.
  constexpr std::size_t kStep = 128;
  for (std::size_t begin = 0; begin < rays.size(); begin += kStep) {
    const std::size_t end = std::min(begin + kStep, rays.size());
    parts.kernels->finish_hits(parts.world.triangles, rays.subspan(begin, end - begin), found + begin,
                               hits + begin);
    // Without a branch: who hits and who does not is hard to foresee.
    const auto name = [&](std::size_t i, const PartMesh& mesh) {
      const std::uint32_t none = 0u - static_cast<std::uint32_t>(!found[i].is_hit());
      hits[i].instance_id = InstanceId(mesh.instance_id.value | none);
      hits[i].geometry_id = GeometryId(mesh.geometry_id.value | none);
      hits[i].primitive_id = PrimId((found[i].key - mesh.first_key) | none);
    };
    const std::vector<PartMesh>& meshes = parts.world.meshes;
    if (meshes.size() == 1) {
      const PartMesh only = meshes[0];
      for (std::size_t i = begin; i < end; ++i) name(i, only);
    } else {
      for (std::size_t i = begin; i < end; ++i)
        name(i, parts.world.mesh_of(found[i].is_hit() ? found[i].key : 0));
    }
  }
}

}  // namespace

namespace detail {

void answer_closest(const Scene::Parts& parts, std::span<const Ray> rays, Hit* hits) {
  NoStatistics none;
  if (!parts.kernels) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk_closest(parts, rays[i], none);
    return;
  }
  Scratch scratch;
  simd::TriangleHit* const found = scratch.found();
  std::vector<std::uint32_t>& unusual = scratch.unusual();
  parts.kernels->closest_hits(parts.world.triangles, rays, parts.bounds, found, hits, unusual);
  for (const std::uint32_t i : unusual) found[i] = {};
  if (parts.is_only_triangles)
    finish_triangles(parts, rays, found, hits);
  else
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = add_others(parts, rays[i], found[i]);
  for (const std::uint32_t i : unusual) hits[i] = walk_closest(parts, rays[i], none);
}

void answer_any(const Scene::Parts& parts, std::span<const Ray> rays, bool* hits) {
  if (!parts.kernels) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk_any(parts, rays[i]);
    return;
  }
  Scratch scratch;
  std::vector<std::uint32_t>& unusual = scratch.unusual();
  parts.kernels->any_hits(parts.world.triangles, rays, parts.bounds, hits, unusual);
  for (const std::uint32_t i : unusual) hits[i] = walk_any(parts, rays[i]);
  if (parts.is_only_triangles) return;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!hits[i]) hits[i] = is_other_hit(parts, rays[i]);
}

}  // namespace detail

void Scene::closest_hit(std::span<const Ray> rays, std::span<Hit> hits, Executor* executor) const {
  check_lengths(rays.size(), hits.size());
  detail::for_chunks(executor, rays.size(), [&](std::size_t begin, std::size_t end) {
    detail::answer_closest(*parts_, rays.subspan(begin, end - begin), &hits[begin]);
  });
}

void Scene::any_hit(std::span<const Ray> rays, std::span<bool> hits, Executor* executor) const {
  check_lengths(rays.size(), hits.size());
  detail::for_chunks(executor, rays.size(), [&](std::size_t begin, std::size_t end) {
    detail::answer_any(*parts_, rays.subspan(begin, end - begin), &hits[begin]);
  });
}

}  // namespace boxwood
