// stream.h: how are rays answered that lie in memory in another form than ours, or not all at once?
//
// A batch (scene.h) takes rays and hits as they are in here. Whoever keeps them as columns of an array, in a
// file, or in another language hands them over chunk by chunk: each thread has room for one chunk, which
// stays in its cache, asks the caller to fill it, answers it, and hands the answers over. Nothing is
// allocated per ray, and the answers are those of the calls with one ray, bit for bit.
#pragma once

#include <functional>

#include "boxwood/scene/scene.h"

namespace boxwood {

/// How many there are, who works, and whether to go on.
struct Stream {
  std::size_t count = 0;  ///< Of rays, or of points.
  Executor* executor =
      nullptr;  ///< nullptr means default_executor(); a few hundred are answered by the caller.
  /// Asked on the calling thread alone, before each chunk that it answers itself; false makes the stream
  /// throw Cancelled, and what has been handed over by then stands. May be empty.
  std::function<bool()> keep_going;
};

/// Writes the rays that begin with number `begin`. Called once for each chunk, in any order, on any thread.
using FillRays = std::function<void(std::size_t begin, std::span<Ray> rays)>;

/// A place to search from; as the arguments of Scene::closest_point.
struct SearchPoint {
  Vec3 point;
  float max_distance = kInfinity;
};
using FillPoints = std::function<void(std::size_t begin, std::span<SearchPoint> points)>;

/// Takes the answers to rays, or points, from number `begin` on, which `fill` has just written. Called as
/// FillRays is.
template <class Question, class Answer>
using Take =
    std::function<void(std::size_t begin, std::span<const Question> asked, std::span<const Answer> answers)>;

/// Takes the crossings of rays from number `begin` on: hits[offsets[i]] to hits[offsets[i + 1]], the end not
/// included, are those of rays[i].
using TakeAllHits = std::function<void(std::size_t begin, std::span<const Ray> rays,
                                       std::span<const std::size_t> offsets, std::span<const Hit> hits)>;

/// As Scene::closest_hit, any_hit, count_hits, all_hits and closest_point. Exceptions from `fill`, `take` and
/// `keep_going` are thrown again; Cancelled as above.
void stream_closest_hit(const Scene& scene, const Stream& stream, const FillRays& fill,
                        const Take<Ray, Hit>& take);
void stream_any_hit(const Scene& scene, const Stream& stream, const FillRays& fill,
                    const Take<Ray, bool>& take);
void stream_count_hits(const Scene& scene, const Stream& stream, const FillRays& fill,
                       const Take<Ray, std::size_t>& take);
void stream_all_hits(const Scene& scene, const Stream& stream, const FillRays& fill, const TakeAllHits& take);
void stream_closest_point(const Scene& scene, const Stream& stream, const FillPoints& fill,
                          const Take<SearchPoint, ScenePoint>& take);

}  // namespace boxwood
