// path_batch.h: what do paths that go on together carry along?
//
// Each path stays in one place until it ends; then a new one takes the place. The rays of all paths stand in
// a row of their own, which is written anew at each step, in the order in which the paths were looked at.
#pragma once

#include <numeric>
#include <span>
#include <vector>

#include "boxwood/core/hit.h"
#include "boxwood/core/ray.h"
#include "boxwood/render/light_node.h"
#include "boxwood/render/sampler.h"

namespace boxwood::render {

/// A path, but for its ray: one line of the cache.
struct alignas(64) Path {
  Path(Sampler own_sampler, std::uint32_t own_sample, float pixel_angle)
      : sampler(own_sampler), sample(own_sample), cone_angle(pixel_angle) {}

  Sampler sampler;
  std::uint32_t sample;  ///< Whose light it looks for.
  Vec3 throughput{1, 1, 1};
  Vec3 absorption{0, 0, 0};  ///< Of what the ray is in.
  float cone_width = 0, cone_angle;
  float pdf = 0;                        ///< Of the direction that it took last.
  std::uint16_t bounce = 0, steps = 0;  ///< A step: what a ray of the path hit, or that it hit nothing.
  /// Next-event estimation could not have found what this direction finds; true at the camera.
  bool is_perfect = true;
};
static_assert(sizeof(Path) == 64);

/// Rays that are traced together, and the places of their paths.
class RayRow {
 public:
  explicit RayRow(std::size_t capacity) : rays_(capacity), places_(capacity) {}

  std::size_t size() const { return size_; }
  std::span<const Ray> rays() const { return std::span(rays_).first(size_); }
  std::uint32_t place(std::size_t i) const { return places_[i]; }
  void clear() { size_ = 0; }
  /// Precondition: there is room.
  void add(const Ray& ray, std::uint32_t place) {
    rays_[size_] = ray;
    places_[size_++] = place;
  }

 private:
  std::vector<Ray> rays_;
  std::vector<std::uint32_t> places_;
  std::size_t size_ = 0;
};

/// The paths.
class PathBatch {
 public:
  explicit PathBatch(std::size_t size)
      : front(size),
        next(size),
        hits(size),
        paths_(size, Path({0, 0}, 0, 0)),
        left_from_(size),
        vacant_(size) {
    std::iota(vacant_.rbegin(), vacant_.rend(), 0u);
  }

  bool is_full() const { return vacant_.empty(); }
  /// A new path sets out along `ray`. Precondition: there is a place for it.
  void start(const Path& path, const Ray& ray) {
    const std::uint32_t place = vacant_.back();
    vacant_.pop_back();
    paths_[place] = path;
    front.add(ray, place);
  }
  void end(std::uint32_t place) { vacant_.push_back(place); }

  Path& operator[](std::uint32_t place) { return paths_[place]; }
  /// The last point of a path, if it is not still the camera.
  Receiver& left_from(std::uint32_t place) { return left_from_[place]; }
  /// Has the processor fetch a path.
  void prefetch([[maybe_unused]] std::uint32_t place) const {
#if defined(__GNUC__)
    __builtin_prefetch(&paths_[place], 1);
#endif
  }

  RayRow front, next;     ///< The rays of this step, and of the one after it.
  std::vector<Hit> hits;  ///< What those of this step hit.

 private:
  std::vector<Path> paths_;
  std::vector<Receiver> left_from_;
  std::vector<std::uint32_t> vacant_;
};

}  // namespace boxwood::render
