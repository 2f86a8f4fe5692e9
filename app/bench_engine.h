// bench_engine.h: what must a ray tracer offer to stand on the bench?
//
// An Engine builds a mesh; a BuiltScene takes rays into its own memory layout, before the clock starts; the
// resulting Work is what is timed, and holds the answers afterwards. So no engine is charged for converting
// rays, and each writes its hits where and how it likes.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "boxwood/core/parallel.h"
#include "boxwood/core/progress.h"
#include "boxwood/core/ray.h"
#include "boxwood/scene/description.h"

namespace boxwood::app {

/// Rays that are handed out to a thread at a time; a multiple of 16, the packet's size.
inline constexpr std::size_t kRaysPerChunk = 1024;

enum class Question { closest_hit, any_hit };

/// What a set of rays found. Two engines that agree have (nearly) the same.
struct Answers {
  std::uint64_t hits = 0;
  double checksum = 0;   ///< The sum of t over the hits, in the order of rays; any hit: the hits.
  double largest_t = 0;  ///< Of a hit; any hit: 1.

  void add_hit(float t) {
    ++hits;
    checksum += double(t);
    largest_t = largest_t < double(t) ? double(t) : largest_t;
  }
  friend bool operator==(const Answers&, const Answers&) = default;
};

/// Seconds on the wall, from some time on.
inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Rays on their way through one scene.
class Work {
 public:
  virtual ~Work() = default;
  /// Answers every ray. Timed; call once.
  virtual void run(Executor& executor) = 0;
  virtual Answers answers() const = 0;
};

/// How rays are handed over.
struct TraceOptions {
  std::string mode;  ///< One of the engine's modes.
  Question question = Question::closest_hit;
  bool is_coherent = false;    ///< Neighbours in the set start and go alike. Boxwood finds out by itself.
  std::size_t batch_size = 0;  ///< Mode "batch": rays in a call; 0 means all.
};

class BuiltScene {
 public:
  virtual ~BuiltScene() = default;
  /// From a mesh in memory, which the engine may keep or share, to a scene that answers.
  virtual double build_ms() const = 0;
  /// The tree and its triangles, without the mesh.
  virtual std::size_t size_bytes() const = 0;
  /// `rays` must outlive the Work.
  virtual std::unique_ptr<Work> prepare(std::span<const Ray> rays, const TraceOptions& options) const = 0;
};

class Engine {
 public:
  virtual ~Engine() = default;
  virtual std::string name() const = 0;
  virtual std::vector<std::string> modes() const = 0;
  virtual std::vector<std::string> presets() const = 0;
  /// The preset that the rates are measured with.
  virtual std::string traced_preset() const = 0;
  /// `mesh` outlives the scene. Throws Cancelled when `progress` returns false.
  virtual std::unique_ptr<BuiltScene> build(const TriangleMesh& mesh, const std::string& preset, int threads,
                                            const Progress& progress) const = 0;
};

}  // namespace boxwood::app
