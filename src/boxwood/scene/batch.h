// batch.h: how is one chunk of a batch answered, on one thread, and how long is a chunk?
//
// Batches in memory (scene.h) and streams (stream.h) are cut alike. Inside the scene room only.
#pragma once

#include <algorithm>
#include <utility>

#include "boxwood/scene/stream.h"

namespace boxwood::detail {

constexpr std::size_t kMaxChunk = 4096, kMinChunk = 512;

/// Chunks begin at multiples of this, so that none cuts a tile of a picture, whose rays go the same way.
constexpr std::size_t kWhole = 64;

/// A thread's own T, kept from one chunk to the next; taken while in use, because a shape or a caller may ask
/// a scene from inside.
template <class T>
class Lent {
 public:
  Lent() : mine_(std::move(spare())) {}
  ~Lent() { spare() = std::move(mine_); }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;
  T* operator->() { return &mine_; }
  T& operator*() { return mine_; }

 private:
  static T& spare() {
    static thread_local T spare;
    return spare;
  }
  T mine_;
};

/// Throws std::invalid_argument when there is not one answer for each ray.
void check_lengths(std::size_t rays, std::size_t answers, const char* what);

/// Calls body(begin, end) for chunks of `count` rays: some for each thread, so that all end together; one
/// thread alone takes the longest, in which the kernels are short of rays least.
template <class Body>
void for_chunks(Executor* given, std::size_t count, const Body& body) {
  if (count <= kMinChunk) {
    if (count > 0) body(std::size_t(0), count);
    return;
  }
  Executor& executor = given ? *given : default_executor();
  const auto threads = static_cast<std::size_t>(executor.concurrency());
  const std::size_t share = threads > 1 ? count / (8 * threads) : count;
  const std::size_t chunk = std::clamp(share, kMinChunk, kMaxChunk) / kWhole * kWhole;
  parallel_for(executor, 0, (count + chunk - 1) / chunk, 1,
               [&](std::size_t i) { body(i * chunk, std::min((i + 1) * chunk, count)); });
}

/// hits[i] answers rays[i]. Precondition: at most kMaxChunk rays.
void answer_closest(const Scene::Parts& parts, std::span<const Ray> rays, Hit* hits);
void answer_any(const Scene::Parts& parts, std::span<const Ray> rays, bool* hits);
/// hits[offsets[i]] to hits[offsets[i + 1]] are what rays[i] crosses; counts[i] says how much that is.
void answer_all(const Scene& scene, std::span<const Ray> rays, std::size_t* offsets, std::vector<Hit>& hits);
void answer_count(const Scene& scene, std::span<const Ray> rays, std::size_t* counts);
/// found[i] answers points[i]. Errors as in Scene::closest_point. Precondition: at most kMaxChunk points.
void answer_closest_points(const Scene::Parts& parts, std::span<const SearchPoint> points, ScenePoint* found);

}  // namespace boxwood::detail
