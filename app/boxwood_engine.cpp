#include "boxwood_engine.h"

#include <algorithm>

#include "boxwood/scene/scene.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

class BoxwoodWork final : public Work {
 public:
  BoxwoodWork(const Scene& scene, std::span<const Ray> rays, const TraceOptions& options)
      : scene_(scene), rays_(rays), options_(options) {
    if (options.question == Question::closest_hit)
      hits_.resize(rays.size());
    else
      is_hit_ = std::make_unique<bool[]>(rays.size());
  }

  void run(Executor& executor) override {
    if (options_.mode == "single") {
      executor.for_range(0, rays_.size(), kRaysPerChunk,
                         [this](std::size_t begin, std::size_t end) { one_by_one(begin, end); });
      return;
    }
    const std::size_t size = options_.batch_size > 0 ? options_.batch_size : rays_.size();
    for (std::size_t begin = 0; begin < rays_.size(); begin += size) {
      const std::size_t count = std::min(size, rays_.size() - begin);
      const auto rays = rays_.subspan(begin, count);
      if (options_.question == Question::closest_hit)
        scene_.closest_hit(rays, std::span(hits_).subspan(begin, count), &executor);
      else
        scene_.any_hit(rays, std::span<bool>(is_hit_.get() + begin, count), &executor);
    }
  }

  Answers answers() const override {
    Answers answers;
    for (const Hit& hit : hits_)
      if (hit.is_hit()) answers.add_hit(hit.t);
    if (is_hit_)
      for (std::size_t i = 0; i < rays_.size(); ++i)
        if (is_hit_[i]) answers.add_hit(1);
    return answers;
  }

 private:
  void one_by_one(std::size_t begin, std::size_t end) {
    if (options_.question == Question::closest_hit)
      for (std::size_t i = begin; i < end; ++i) hits_[i] = scene_.closest_hit(rays_[i]);
    else
      for (std::size_t i = begin; i < end; ++i) is_hit_[i] = scene_.any_hit(rays_[i]);
  }

  const Scene& scene_;
  std::span<const Ray> rays_;
  TraceOptions options_;
  std::vector<Hit> hits_;
  std::unique_ptr<bool[]> is_hit_;  // std::vector<bool> has no span
};

class BoxwoodScene final : public BuiltScene {
 public:
  BoxwoodScene(Scene scene, double build_ms) : scene_(std::move(scene)), build_ms_(build_ms) {}
  double build_ms() const override { return build_ms_; }
  std::size_t size_bytes() const override {
    const SceneStatistics statistics = scene_.statistics();
    return statistics.tree_bytes + statistics.geometry_bytes;
  }
  std::unique_ptr<Work> prepare(std::span<const Ray> rays, const TraceOptions& options) const override {
    return std::make_unique<BoxwoodWork>(scene_, rays, options);
  }

 private:
  Scene scene_;
  double build_ms_;
};

class BoxwoodEngine final : public Engine {
 public:
  std::string name() const override { return "boxwood"; }
  std::vector<std::string> modes() const override { return {"single", "batch"}; }
  std::vector<std::string> presets() const override { return {"fast", "balanced", "best", "compact"}; }
  std::string traced_preset() const override { return "balanced"; }
  std::unique_ptr<BuiltScene> build(const TriangleMesh& mesh, const std::string& preset, int threads,
                                    const Progress& progress) const override {
    const std::unique_ptr<Executor> executor = make_executor(threads);
    BuildOptions options = build_options(preset == "compact" ? "balanced" : preset);
    options.is_compact = preset == "compact";
    options.executor = executor.get();
    options.progress = progress;
    SceneDesc desc;
    desc.add(mesh);
    const double start = seconds_now();
    Scene scene(std::move(desc), options);
    return std::make_unique<BoxwoodScene>(std::move(scene), 1e3 * (seconds_now() - start));
  }
};

}  // namespace

std::unique_ptr<Engine> boxwood_engine() {
  return std::make_unique<BoxwoodEngine>();
}

}  // namespace boxwood::app
