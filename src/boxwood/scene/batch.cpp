// batch.cpp: how are many rays answered?
//
// In chunks, one for each task: kernels take a chunk's rays in turns and say what each does to the world's
// triangles, and then to those below placements, within the limit that the world left. Answers are worked
// out, plain C++ adds other shapes, and answers the few rays that kernels do not take. A chunk is long enough
// that a kernel is rarely short of rays, and its findings stay in the cache.
#include "boxwood/scene/batch.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "boxwood/core/prefetch.h"
#include "boxwood/core/raw_array.h"
#include "boxwood/scene/closest.h"
#include "boxwood/scene/ray_order.h"

namespace boxwood {
namespace {

using detail::kMaxChunk;

/// A thread's memory between kernels and the answers.
struct Buffers {
  std::vector<simd::TriangleHit> found;
  std::vector<simd::PlacedHit> placed;
  std::vector<std::uint32_t> order, unusual;
};

using Scratch = detail::Lent<Buffers>;

/// What two kernels refused, one after the other, in order and once.
std::span<const std::uint32_t> once_each(std::vector<std::uint32_t>& unusual) {
  std::sort(unusual.begin(), unusual.end());
  unusual.erase(std::unique(unusual.begin(), unusual.end()), unusual.end());
  return unusual;
}

/// Takes the rays below placements, where triangles may be hit sooner than scratch->found says of the
/// world's; forgets what is not the first. What is hit there is in scratch->placed.
void hit_placed(const Scene::Parts& parts, std::span<const Ray> rays, Scratch& scratch, const Hit* answers) {
  const bool has_world = !parts.world.triangles.is_empty();
  std::vector<simd::PlacedHit>& placed = scratch->placed;
  placed.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) placed[i] = {{rays[i].t_max + 0.0f}};
  if (has_world)
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const simd::TriangleHit& found = scratch->found[i];
      if (!found.is_hit()) continue;
      placed[i].t = found.t;
      placed[i].instance = parts.world.mesh_of(found.key).instance_id.value;
    }
  scratch->order.resize(rays.size());
  std::iota(scratch->order.begin(), scratch->order.end(), 0u);
  parts.kernels->closest_hits_below(parts.placed_trees, rays, parts.bounds, scratch->order, placed.data(),
                                    answers, scratch->unusual);
  if (has_world)
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (placed[i].is_placed()) scratch->found[i] = {};
}

/// Works out answers for the world's triangles.
void finish_world(const Scene::Parts& parts, std::span<const Ray> rays, const simd::TriangleHit* found,
                  Hit* hits) {
  parts.kernels->finish_hits(parts.world.triangles, rays, found, hits);
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
    for (std::size_t i = 0; i < rays.size(); ++i) name(i, only);
  } else {
    for (std::size_t i = 0; i < rays.size(); ++i)
      name(i, parts.world.mesh_of(found[i].is_hit() ? found[i].key : 0));
  }
}

/// Works out answers below placements; leaves others alone.
void finish_placed(const Scene::Parts& parts, std::span<const Ray> rays, const simd::PlacedHit* placed,
                   Hit* hits) {
  parts.kernels->finish_hits_below(parts.placed_trees, rays, placed, hits);
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (placed[i].is_placed()) detail::name_placed_hit(parts, placed[i], hits[i]);
}

/// Works out all answers for triangles.
void finish(const Scene::Parts& parts, std::span<const Ray> rays, Scratch& scratch, Hit* hits) {
  // A few at a time, so that they are still in the nearest cache when they get their ids.
  constexpr std::size_t kStep = 128;
  for (std::size_t begin = 0; begin < rays.size(); begin += kStep) {
    const std::span<const Ray> some = rays.subspan(begin, std::min(kStep, rays.size() - begin));
    if (!parts.world.triangles.is_empty())
      finish_world(parts, some, scratch->found.data() + begin, hits + begin);
    else
      std::fill_n(hits + begin, some.size(), Hit{});
    if (parts.placed_trees.has_triangles())
      finish_placed(parts, some, scratch->placed.data() + begin, hits + begin);
  }
}

}  // namespace

namespace detail {

void check_lengths(std::size_t rays, std::size_t answers, const char* what) {
  if (rays != answers)
    throw std::invalid_argument("a batch of " + std::to_string(rays) + " rays came with room for " +
                                std::to_string(answers) + " " + what + ", expected the same number");
}

void answer_closest(const Scene::Parts& parts, std::span<const Ray> rays, Hit* hits) {
  NoStatistics none;
  if (!parts.kernels) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk_closest(parts, rays[i], none);
    return;
  }

  // Find the triangles, in the world and below placements. Rays that are not ordinary are answered by plain
  // C++ in the end.
  Scratch scratch;
  std::vector<std::uint32_t>& unusual = scratch->unusual;
  unusual.clear();
  scratch->found.resize(kMaxChunk);
  if (!parts.world.triangles.is_empty()) {
    simd::TriangleHit* const found = scratch->found.data();
    parts.kernels->closest_hits(parts.world.triangles, rays, parts.bounds, found, hits, unusual);
    for (const std::uint32_t i : unusual) found[i] = {};
  }
  if (parts.placed_trees.has_triangles()) hit_placed(parts, rays, scratch, hits);

  finish(parts, rays, scratch, hits);
  if (parts.has_shapes)
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = add_shapes(parts, rays[i], hits[i]);
  for (const std::uint32_t i : once_each(unusual)) hits[i] = walk_closest(parts, rays[i], none);
}

void answer_any(const Scene::Parts& parts, std::span<const Ray> rays, bool* hits) {
  if (!parts.kernels) {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = walk_any(parts, rays[i]);
    return;
  }
  Scratch scratch;
  std::vector<std::uint32_t>&order = scratch->order, &unusual = scratch->unusual;
  unusual.clear();
  std::fill_n(hits, rays.size(), false);
  if (!parts.world.triangles.is_empty())
    parts.kernels->any_hits(parts.world.triangles, rays, parts.bounds, hits, unusual);
  if (parts.placed_trees.has_triangles()) {
    order.clear();
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      if (!hits[i]) order.push_back(i);
    parts.kernels->any_hits_below(parts.placed_trees, rays, parts.bounds, order, hits, unusual);
  }
  if (parts.has_shapes)
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (!hits[i]) hits[i] = is_shape_hit(parts, rays[i]);
  for (const std::uint32_t i : once_each(unusual)) hits[i] = walk_any(parts, rays[i]);
}

}  // namespace detail

namespace {

/// Answers by answer_chunk(parts, some rays, their answers), or by answer_stream(scene, stream, fill, take)
/// where rays are sorted first.
template <class Answer, class AnswerChunk, class AnswerStream>
void answer_batch(const Scene& scene, std::span<const Ray> rays, std::span<Answer> answers,
                  Executor* executor, const AnswerChunk& answer_chunk, const AnswerStream& answer_stream) {
  const Scene::Parts& parts = scene.parts();
  detail::check_lengths(rays.size(), answers.size(), "hits");
  const bool may_sort = parts.kernels && parts.world.may_sort_rays && rays.size() >= detail::kLeastSorted;
  const std::size_t most = may_sort ? detail::kMostSorted : rays.size();
  RawArray<std::uint64_t> order;
  for (std::size_t begin = 0; begin < rays.size(); begin += most) {
    const std::size_t count = std::min(rays.size() - begin, most);
    const std::span<const Ray> some = rays.subspan(begin, count);
    const std::span<Answer> theirs = answers.subspan(begin, count);
    if (!may_sort || count < detail::kLeastSorted || !detail::are_scattered(some, parts.bounds)) {
      detail::for_chunks(executor, count, [&](std::size_t first, std::size_t end) {
        answer_chunk(parts, some.subspan(first, end - first), &theirs[first]);
      });
      continue;
    }
    if (order.size() < count) order = RawArray<std::uint64_t>(count);
    detail::find_ray_order(some, parts.bounds, std::span(order.data(), count),
                           executor ? *executor : default_executor());
    const auto number = [&](std::size_t i) { return static_cast<std::uint32_t>(order[i]); };
    answer_stream(
        scene, Stream{count, executor, {}},
        [&](std::size_t first, std::span<Ray> chunk) {
          constexpr std::size_t kAhead = 16;
          for (std::size_t i = 0; i < chunk.size(); ++i) {
            prefetch(&some[number(std::min(first + i + kAhead, count - 1))]);
            chunk[i] = some[number(first + i)];
          }
        },
        [&](std::size_t first, std::span<const Ray>, std::span<const Answer> found) {
          for (std::size_t i = 0; i < found.size(); ++i) theirs[number(first + i)] = found[i];
        });
  }
}

}  // namespace

void Scene::closest_hit(std::span<const Ray> rays, std::span<Hit> hits, Executor* executor) const {
  answer_batch(*this, rays, hits, executor, detail::answer_closest, stream_closest_hit);
}

void Scene::any_hit(std::span<const Ray> rays, std::span<bool> hits, Executor* executor) const {
  answer_batch(*this, rays, hits, executor, detail::answer_any, stream_any_hit);
}

}  // namespace boxwood
