// Streams answer as the calls with one ray do, bit for bit, however they are cut and whoever works; they stop
// when asked to, and pass errors on.
#include "boxwood/scene/stream.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "boxwood/core/error.h"
#include "boxwood/core/random.h"
#include "boxwood/gallery/gallery.h"

namespace boxwood {
namespace {

std::vector<Ray> rays_into(const Box3& bounds, std::size_t count) {
  Random random(5);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) ray = {random.in_box(bounds.lower, bounds.upper), 0, random.direction()};
  if (count > 7) rays[7].direction = {0, 0, 0};  // not ordinary
  return rays;
}

FillRays from(const std::vector<Ray>& rays) {
  return [&rays](std::size_t begin, std::span<Ray> out) {
    std::copy_n(rays.begin() + static_cast<std::ptrdiff_t>(begin), out.size(), out.begin());
  };
}

class Streams : public ::testing::TestWithParam<int> {
 protected:
  Scene scene_{gallery::make("stilllife")};
  std::unique_ptr<Executor> executor_ = make_executor(GetParam());
};

TEST_P(Streams, AnswerAsSingleRaysDo) {
  for (const std::size_t count : {0, 1, 511, 513, 5000, 40000}) {
    const std::vector<Ray> rays = rays_into(scene_.bounds(), count);
    const Stream stream{count, executor_.get(), {}};
    std::vector<Hit> closest(count);
    std::vector<char> any(count);
    std::vector<std::size_t> counts(count);
    std::vector<std::vector<Hit>> all(count);
    stream_closest_hit(scene_, stream, from(rays), [&](std::size_t begin, auto asked, auto hits) {
      ASSERT_EQ(asked.size(), hits.size());
      for (std::size_t i = 0; i < hits.size(); ++i) closest[begin + i] = hits[i];
    });
    stream_any_hit(scene_, stream, from(rays), [&](std::size_t begin, auto, auto hits) {
      for (std::size_t i = 0; i < hits.size(); ++i) any[begin + i] = hits[i];
    });
    stream_count_hits(scene_, stream, from(rays), [&](std::size_t begin, auto, auto found) {
      std::copy(found.begin(), found.end(), &counts[begin]);
    });
    stream_all_hits(scene_, stream, from(rays), [&](std::size_t begin, auto asked, auto offsets, auto hits) {
      ASSERT_EQ(offsets.size(), asked.size() + 1);
      ASSERT_EQ(offsets.back(), hits.size());
      for (std::size_t i = 0; i < asked.size(); ++i)
        all[begin + i].assign(hits.begin() + static_cast<std::ptrdiff_t>(offsets[i]),
                              hits.begin() + static_cast<std::ptrdiff_t>(offsets[i + 1]));
    });
    std::vector<Hit> expected;
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(closest[i], scene_.closest_hit(rays[i]));
      ASSERT_EQ(any[i] != 0, scene_.any_hit(rays[i]));
      scene_.all_hits(rays[i], expected);
      ASSERT_EQ(all[i], expected);
      ASSERT_EQ(counts[i], expected.size());
    }
  }
}

TEST_P(Streams, FindNearestPointsAsSingleCallsDo) {
  // Triangles alone, and among spheres and placements; some points are unusual, and some limits.
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const char* name : {"soup:2000", "stilllife"}) {
    const Scene scene(gallery::make(name));
    std::vector<Ray> rays = rays_into(scene.bounds(), 9000);
    rays[11].origin.y = nan;
    rays[12].origin.x = 1e30f;
    const auto reach = [&](std::size_t i) { return i % 2 ? kInfinity : i % 100 == 0 ? nan : 0.05f; };
    std::vector<ScenePoint> found(rays.size());
    stream_closest_point(
        scene, {rays.size(), executor_.get(), {}},
        [&](std::size_t begin, std::span<SearchPoint> out) {
          for (std::size_t i = 0; i < out.size(); ++i) out[i] = {rays[begin + i].origin, reach(begin + i)};
        },
        [&](std::size_t begin, auto, auto points) {
          std::copy(points.begin(), points.end(), &found[begin]);
        });
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(found[i], scene.closest_point(rays[i].origin, reach(i))) << name << ", point " << i;
      count += found[i].instance_id.is_valid();
    }
    EXPECT_GT(count, rays.size() / 2);
    EXPECT_LT(count, rays.size());
  }
}

TEST_P(Streams, StopWhenAskedTo) {
  const std::vector<Ray> rays = rays_into(scene_.bounds(), 100'000);
  const std::thread::id caller = std::this_thread::get_id();
  int asked = 0;
  std::atomic<std::size_t> answered = 0;
  const Stream stream{rays.size(), executor_.get(), [&] {
                        EXPECT_EQ(std::this_thread::get_id(), caller);
                        return ++asked < 3;
                      }};
  EXPECT_THROW(stream_closest_hit(scene_, stream, from(rays),
                                  [&](std::size_t, auto, auto hits) { answered += hits.size(); }),
               Cancelled);
  EXPECT_EQ(asked, 3);
  EXPECT_LT(answered, rays.size());
}

TEST_P(Streams, PassErrorsOn) {
  const std::vector<Ray> rays = rays_into(scene_.bounds(), 10'000);
  const auto fail = [](std::size_t, auto, auto) { throw std::runtime_error("full"); };
  EXPECT_THROW(stream_any_hit(scene_, {rays.size(), executor_.get(), {}}, from(rays), fail),
               std::runtime_error);
}

TEST_P(Streams, MayAskOneAnother) {
  // A question inside of a question has memory of its own.
  const std::vector<Ray> rays = rays_into(scene_.bounds(), 2000);
  std::vector<Hit> hits(rays.size());
  stream_closest_hit(
      scene_, {rays.size(), executor_.get(), {}},
      [&](std::size_t begin, std::span<Ray> out) {
        from(rays)(begin, out);
        stream_closest_hit(scene_, {100, &serial_executor(), {}}, from(rays), [](std::size_t, auto, auto) {});
      },
      [&](std::size_t begin, auto, auto found) { std::copy(found.begin(), found.end(), &hits[begin]); });
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i], scene_.closest_hit(rays[i]));
}

INSTANTIATE_TEST_SUITE_P(Threads, Streams, ::testing::Values(1, 2, 4));

}  // namespace
}  // namespace boxwood
