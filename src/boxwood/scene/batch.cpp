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

/// A thread's memory between kernels and the answers.
struct Buffers {
  std::vector<simd::TriangleHit> found;
  std::vector<simd::PlacedHit> placed;
  std::vector<std::uint32_t> order, unusual;
};

/// The buffers of this thread; taken while in use, because a user's own shape may ask a scene from inside.
class Scratch {
 public:
  Scratch() : buffers_(std::exchange(spare(), {})) {
    buffers_.found.resize(kMaxChunk);
    buffers_.unusual.clear();
  }
  ~Scratch() { spare() = std::move(buffers_); }
  Scratch(const Scratch&) = delete;

  Buffers* operator->() { return &buffers_; }

 private:
  static Buffers& spare() {
    static thread_local Buffers mine;
    return mine;
  }
  Buffers buffers_;
};

/// Works out the answers for the world's triangles.
void finish_world(const Scene::Parts& parts, std::span<const Ray> rays, const simd::TriangleHit* found,
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

/// Takes the rays below the placements, where triangles may be hit sooner than `found` says of the world's;
/// forgets what has been.
void hit_placed(const Scene::Parts& parts, std::span<const Ray> rays, Scratch& scratch) {
  std::vector<simd::PlacedHit>& placed = scratch->placed;
  std::vector<std::uint32_t>& order = scratch->order;
  placed.resize(rays.size());
  order.clear();
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    const simd::TriangleHit& found = scratch->found[i];
    placed[i] = {{found.is_hit() ? found.t : rays[i].t_max + 0.0f}};
    if (found.is_hit()) placed[i].instance = parts.world.mesh_of(found.key).instance_id.value;
    order.push_back(i);
  }
  parts.kernels->closest_hits_below(parts.placed_trees, rays, parts.bounds, order, placed.data(),
                                    scratch->unusual);
  for (std::uint32_t i = 0; i < rays.size(); ++i)
    if (placed[i].is_placed()) scratch->found[i] = {};
}

/// Works out the answers below placements.
void finish_placed(const Scene::Parts& parts, std::span<const Ray> rays,
                   const std::vector<simd::PlacedHit>& placed, Hit* hits) {
  parts.kernels->finish_hits_below(parts.placed_trees, rays, placed.data(), hits);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (placed[i].is_placed()) detail::name_placed_hit(parts, placed[i], hits[i]);
}

}  // namespace

namespace detail {

void answer_closest(const Scene::Parts& parts, std::span<const Ray> rays, Hit* hits) {
  NoStatistics none;
  if (!parts.kernels) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk_closest(parts, rays[i], none);
    return;
  }

  // Find the triangles, in the world and below placements. Rays that are not ordinary are found again by plain
  // C++ in the end.
  Scratch scratch;
  simd::TriangleHit* const found = scratch->found.data();
  std::vector<std::uint32_t>& unusual = scratch->unusual;
  const bool has_world = !parts.world.triangles.is_empty(), has_placed = !parts.placed_trees.is_empty();
  if (has_world) {
    parts.kernels->closest_hits(parts.world.triangles, rays, parts.bounds, found, hits, unusual);
    for (const std::uint32_t i : unusual) found[i] = {};
  } else {
    std::fill_n(found, rays.size(), simd::TriangleHit{});
  }
  if (has_placed) hit_placed(parts, rays, scratch);

  // Work out the answers.
  if (has_world)
    finish_world(parts, rays, found, hits);
  else
    std::fill_n(hits, rays.size(), Hit{});
  if (has_placed) finish_placed(parts, rays, scratch->placed, hits);
  if (parts.has_shapes)
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = add_shapes(parts, rays[i], hits[i]);
  for (const std::uint32_t i : unusual) hits[i] = walk_closest(parts, rays[i], none);
}

void answer_any(const Scene::Parts& parts, std::span<const Ray> rays, bool* hits) {
  if (!parts.kernels) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk_any(parts, rays[i]);
    return;
  }
  Scratch scratch;
  std::vector<std::uint32_t>&order = scratch->order, &unusual = scratch->unusual;
  std::fill_n(hits, rays.size(), false);
  if (!parts.world.triangles.is_empty())
    parts.kernels->any_hits(parts.world.triangles, rays, parts.bounds, hits, unusual);
  if (!parts.placed_trees.is_empty()) {
    order.clear();
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      if (!hits[i]) order.push_back(i);
    parts.kernels->any_hits_below(parts.placed_trees, rays, parts.bounds, order, hits, unusual);
  }
  if (parts.has_shapes)
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!hits[i]) hits[i] = is_shape_hit(parts, rays[i]);
  for (const std::uint32_t i : unusual) hits[i] = walk_any(parts, rays[i]);
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
