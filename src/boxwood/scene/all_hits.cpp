// all_hits.cpp: what does a ray cross, and what do many?
//
// Where a scene has triangles and nothing else, a kernel lists the crossings of a whole chunk of rays in no
// order. They are dealt to their rays, sorted, freed of what stands in several leaves, and worked out
// together. Everything else is answered ray by ray.
#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <utility>

#include "boxwood/scene/batch.h"
#include "boxwood/scene/closest.h"

namespace boxwood {
namespace {

using detail::make_hit;

/// Keeps everything.
struct AllSink {
  static constexpr detail::Question kQuestion = detail::Question::all;
  const Scene::Parts& parts;
  float t_max;
  std::vector<Hit>& hits;
  float limit() const { return t_max; }
  void report(const Crossing& c, InstanceId instance, PrimId primitive) {
    hits.push_back(make_hit(parts, c, instance, primitive));
  }
};

/// Has a kernel list what the ray crosses of the world's triangles; false when none takes the ray.
bool ask_world(const Scene::Parts& parts, const Ray& ray, std::vector<simd::TriangleHit>& found) {
  if (parts.world.triangles.is_empty()) return true;
  return parts.kernels && parts.kernels->all_hits(parts.world.triangles, ray, parts.bounds, found);
}

/// Leaves one of each crossing of a triangle, which may stand in several leaves. `hits` are sorted.
void drop_repeated(const Scene::Parts& parts, std::vector<Hit>& hits) {
  const auto is_repeated = [&parts](const Hit& a, const Hit& b) {
    return a.t == b.t && a.instance_id == b.instance_id && a.primitive_id == b.primitive_id &&
           std::holds_alternative<TriangleMesh>(parts.desc.geometries[a.geometry_id.value].shapes);
  };
  hits.erase(std::unique(hits.begin(), hits.end(), is_repeated), hits.end());
}

/// What each ray of a chunk crosses, sorted by t and key: those of ray i are hits[begins[i]] to
/// hits[begins[i + 1]], the end not included. Rays that the kernel does not take are in `unusual`.
struct Crossings {
  std::vector<simd::RayCrossing> found;
  std::vector<simd::TriangleHit> hits;
  std::vector<std::size_t> begins;
  std::vector<std::uint32_t> unusual;

  /// Fills `found` and `unusual` alone.
  void find(const Scene::Parts& parts, std::span<const Ray> rays) {
    found.clear();
    unusual.clear();
    parts.kernels->all_hits_of(parts.world.triangles, rays, parts.bounds, found, unusual);
  }

  void find_and_sort(const Scene::Parts& parts, std::span<const Ray> rays) {
    find(parts, rays);

    // Deal them to their rays.
    begins.assign(rays.size() + 1, 0);
    for (const simd::RayCrossing& crossing : found) ++begins[crossing.ray_index + 1];
    std::partial_sum(begins.begin(), begins.end(), begins.begin());
    hits.resize(found.size());
    for (const simd::RayCrossing& crossing : found) hits[begins[crossing.ray_index]++] = crossing.hit;

    // Sort what each ray has, and leave one of each. Now begins[i] is where those of ray i end.
    std::size_t kept = 0, begin = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto first = hits.begin() + static_cast<std::ptrdiff_t>(begin);
      const auto last = hits.begin() + static_cast<std::ptrdiff_t>(begins[i]);
      begin = begins[i];
      std::sort(first, last, [](const simd::TriangleHit& a, const simd::TriangleHit& b) {
        return a.t != b.t ? a.t < b.t : a.key < b.key;
      });
      begins[i] = kept;
      for (auto hit = first; hit != last; ++hit)
        if (hit == first || hit->key != hits[kept - 1].key || hit->t != hits[kept - 1].t) hits[kept++] = *hit;
    }
    begins[rays.size()] = kept;
    hits.resize(kept);
  }
};

bool has_only_triangles(const Scene::Parts& parts) {
  return parts.kernels && parts.is_only_triangles && !parts.world.triangles.is_empty();
}

/// Works out `count` crossings, of the rays with the numbers ray_of(0), ray_of(1), ...
template <class RayOf>
void finish(const Scene::Parts& parts, std::span<const Ray> rays, const simd::TriangleHit* found,
            std::size_t count, const RayOf& ray_of, Hit* hits) {
  constexpr std::size_t kStep = 128;
  Ray theirs[kStep];
  for (std::size_t begin = 0; begin < count; begin += kStep) {
    const std::size_t some = std::min(kStep, count - begin);
    for (std::size_t i = 0; i < some; ++i) theirs[i] = rays[ray_of(begin + i)];
    parts.kernels->finish_hits(parts.world.triangles, std::span(theirs, some), found + begin, hits + begin);
    for (std::size_t i = 0; i < some; ++i)
      detail::name_hit(parts.world, found[begin + i].key, hits[begin + i]);
  }
}

/// Answers ray after ray: answer(i, of_ray) fills of_ray.
template <class Answer>
void one_after_the_other(std::size_t count, std::size_t* offsets, std::vector<Hit>& hits,
                         const Answer& answer) {
  std::vector<Hit> of_ray;
  hits.clear();
  offsets[0] = 0;
  for (std::size_t i = 0; i < count; ++i) {
    answer(i, of_ray);
    hits.insert(hits.end(), of_ray.begin(), of_ray.end());
    offsets[i + 1] = hits.size();
  }
}

}  // namespace

void Scene::all_hits(const Ray& ray, std::vector<Hit>& hits) const {
  hits.clear();
  const Parts& parts = *parts_;
  static thread_local std::vector<simd::TriangleHit> found;
  found.clear();
  const bool is_answered = ask_world(parts, ray, found);
  for (const simd::TriangleHit& hit : found) hits.push_back(detail::finish_triangle(parts, ray, hit));

  // Add what the kernel does not know.
  if (!is_answered || !parts.is_only_triangles) {
    const PreparedRay prepared(ray, parts.bounds);
    if (!prepared.is_valid()) return;
    const std::size_t first = hits.size();
    AllSink sink{parts, prepared.t_max, hits};
    NoStatistics none;
    if (!is_answered) detail::walk_triangles(parts.world, prepared, detail::NoPlacement{}, sink, none);
    detail::walk_others(parts, prepared, detail::Show::all, sink, none);
    for (std::size_t i = first; i < hits.size(); ++i) detail::fill_normal(parts, prepared, hits[i]);
  }
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return comes_before(a, b); });
  drop_repeated(parts, hits);
}

std::size_t Scene::count_hits(const Ray& ray) const {
  // Where there are only triangles, their keys say which crossings are the same.
  const Parts& parts = *parts_;
  static thread_local std::vector<simd::TriangleHit> found;
  found.clear();
  if (parts.is_only_triangles && ask_world(parts, ray, found)) {
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    const auto last =
        std::unique(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.key == b.key; });
    return static_cast<std::size_t>(last - found.begin());
  }
  std::vector<Hit> hits;
  all_hits(ray, hits);
  return hits.size();
}

namespace detail {

void answer_all(const Scene& scene, std::span<const Ray> rays, std::size_t* offsets, std::vector<Hit>& hits) {
  const Scene::Parts& parts = scene.parts();
  if (!has_only_triangles(parts)) {
    one_after_the_other(rays.size(), offsets, hits,
                        [&](std::size_t i, std::vector<Hit>& of_ray) { scene.all_hits(rays[i], of_ray); });
    return;
  }
  detail::Lent<Crossings> crossings;
  crossings->find_and_sort(parts, rays);
  const std::vector<std::size_t>& begins = crossings->begins;
  std::vector<Hit> answered(crossings->unusual.empty() ? 0 : crossings->hits.size());
  std::vector<Hit>& out = crossings->unusual.empty() ? hits : answered;
  out.resize(crossings->hits.size());
  std::size_t ray = 0;  // of the last crossing that was asked about; they are in order
  finish(
      parts, rays, crossings->hits.data(), out.size(),
      [&](std::size_t i) {
        while (begins[ray + 1] <= i) ++ray;
        return ray;
      },
      out.data());
  if (crossings->unusual.empty()) {
    std::copy(begins.begin(), begins.end(), offsets);
    return;
  }

  // Put in what plain C++ says of the few that the kernel did not take.
  std::sort(crossings->unusual.begin(), crossings->unusual.end());
  auto next = crossings->unusual.begin();
  one_after_the_other(rays.size(), offsets, hits, [&](std::size_t i, std::vector<Hit>& of_ray) {
    if (next != crossings->unusual.end() && *next == i) {
      scene.all_hits(rays[i], of_ray);
      ++next;
    } else {
      of_ray.assign(answered.begin() + static_cast<std::ptrdiff_t>(begins[i]),
                    answered.begin() + static_cast<std::ptrdiff_t>(begins[i + 1]));
    }
  });
}

void answer_count(const Scene& scene, std::span<const Ray> rays, std::size_t* counts) {
  if (!has_only_triangles(scene.parts())) {
    for (std::size_t i = 0; i < rays.size(); ++i) counts[i] = scene.count_hits(rays[i]);
    return;
  }
  detail::Lent<Crossings> crossings;
  if (scene.parts().world.triangles.has_parts()) {
    crossings->find_and_sort(scene.parts(), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) counts[i] = crossings->begins[i + 1] - crossings->begins[i];
  } else {
    crossings->find(scene.parts(), rays);
    std::fill_n(counts, rays.size(), 0);
    for (const simd::RayCrossing& crossing : crossings->found) ++counts[crossing.ray_index];
  }
  for (const std::uint32_t i : crossings->unusual) counts[i] = scene.count_hits(rays[i]);
}

}  // namespace detail

void Scene::all_hits(std::span<const Ray> rays, std::vector<std::size_t>& offsets, std::vector<Hit>& hits,
                     Executor* executor) const {
  // Chunks are put one behind the other; one that comes too soon waits for those before it.
  struct Chunk {
    std::vector<std::size_t> offsets;
    std::vector<Hit> hits;
  };
  std::map<std::size_t, Chunk> waiting;  // by the first ray
  std::size_t next = 0;
  std::mutex mutex;
  offsets.assign(rays.size() + 1, 0);
  hits.clear();
  detail::for_chunks(executor, rays.size(), [&](std::size_t begin, std::size_t end) {
    Chunk mine{std::vector<std::size_t>(end - begin + 1), {}};
    detail::answer_all(*this, rays.subspan(begin, end - begin), mine.offsets.data(), mine.hits);
    const std::lock_guard lock(mutex);
    waiting[begin] = std::move(mine);
    for (auto first = waiting.begin(); first != waiting.end() && first->first == next;
         first = waiting.begin()) {
      const Chunk& chunk = first->second;
      for (std::size_t i = 1; i < chunk.offsets.size(); ++i)
        offsets[next + i] = hits.size() + chunk.offsets[i];
      hits.insert(hits.end(), chunk.hits.begin(), chunk.hits.end());
      next += chunk.offsets.size() - 1;
      waiting.erase(first);
    }
  });
}

void Scene::count_hits(std::span<const Ray> rays, std::span<std::size_t> counts, Executor* executor) const {
  detail::check_lengths(rays.size(), counts.size(), "counts");
  detail::for_chunks(executor, rays.size(), [&](std::size_t begin, std::size_t end) {
    detail::answer_count(*this, rays.subspan(begin, end - begin), &counts[begin]);
  });
}

}  // namespace boxwood
