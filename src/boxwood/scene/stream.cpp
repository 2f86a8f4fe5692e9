#include "boxwood/scene/stream.h"

#include <memory>
#include <thread>
#include <utility>

#include "boxwood/core/error.h"
#include "boxwood/scene/batch.h"

namespace boxwood {
namespace {

/// A thread's room for one chunk of T; taken while in use, because filling may ask another stream.
template <class T>
class Room {
 public:
  explicit Room(std::size_t size) : mine_(std::exchange(spare(), {})) {
    if (mine_.size < size) mine_ = {std::make_unique<T[]>(size), size};
    span_ = {mine_.items.get(), size};
  }
  ~Room() { spare() = std::move(mine_); }
  Room(const Room&) = delete;

  std::span<T> span() { return span_; }

 private:
  struct Buffer {
    std::unique_ptr<T[]> items;
    std::size_t size = 0;
  };
  static Buffer& spare() {
    static thread_local Buffer buffer;
    return buffer;
  }
  Buffer mine_;
  std::span<T> span_;
};

/// Calls answer(begin, asked) for each chunk, filled.
template <class Question, class Fill, class Answer>
void for_filled_chunks(const Stream& stream, const Fill& fill, const Answer& answer) {
  const std::thread::id caller = std::this_thread::get_id();
  detail::for_chunks(stream.executor, stream.count, [&](std::size_t begin, std::size_t end) {
    if (stream.keep_going && std::this_thread::get_id() == caller && !stream.keep_going()) throw Cancelled();
    Room<Question> room(end - begin);
    fill(begin, room.span());
    answer(begin, room.span());
  });
}

/// One answer for each question: answer_all(asked, answers).
template <class Question, class Answer, class Fill, class AnswerAll>
void one_for_each(const Stream& stream, const Fill& fill, const Take<Question, Answer>& take,
                  const AnswerAll& answer_all) {
  for_filled_chunks<Question>(stream, fill, [&](std::size_t begin, std::span<const Question> asked) {
    Room<Answer> answers(asked.size());
    answer_all(asked, answers.span());
    take(begin, asked, answers.span());
  });
}

}  // namespace

void stream_closest_hit(const Scene& scene, const Stream& stream, const FillRays& fill,
                        const Take<Ray, Hit>& take) {
  one_for_each<Ray, Hit>(stream, fill, take, [&](std::span<const Ray> rays, std::span<Hit> hits) {
    detail::answer_closest(scene.parts(), rays, hits.data());
  });
}

void stream_any_hit(const Scene& scene, const Stream& stream, const FillRays& fill,
                    const Take<Ray, bool>& take) {
  one_for_each<Ray, bool>(stream, fill, take, [&](std::span<const Ray> rays, std::span<bool> hits) {
    detail::answer_any(scene.parts(), rays, hits.data());
  });
}

void stream_count_hits(const Scene& scene, const Stream& stream, const FillRays& fill,
                       const Take<Ray, std::size_t>& take) {
  one_for_each<Ray, std::size_t>(stream, fill, take,
                                 [&](std::span<const Ray> rays, std::span<std::size_t> counts) {
                                   detail::answer_count(scene, rays, counts.data());
                                 });
}

void stream_all_hits(const Scene& scene, const Stream& stream, const FillRays& fill,
                     const TakeAllHits& take) {
  for_filled_chunks<Ray>(stream, fill, [&](std::size_t begin, std::span<const Ray> rays) {
    // It grows to what the fullest chunk of the thread needs, once.
    detail::Lent<std::vector<Hit>> hits;
    Room<std::size_t> offsets(rays.size() + 1);
    detail::answer_all(scene, rays, offsets.span().data(), *hits);
    take(begin, rays, offsets.span(), *hits);
  });
}

void stream_closest_point(const Scene& scene, const Stream& stream, const FillPoints& fill,
                          const Take<SearchPoint, ScenePoint>& take) {
  one_for_each<SearchPoint, ScenePoint>(
      stream, fill, take, [&](std::span<const SearchPoint> points, std::span<ScenePoint> found) {
        detail::answer_closest_points(scene.parts(), points, found.data());
      });
}

}  // namespace boxwood
