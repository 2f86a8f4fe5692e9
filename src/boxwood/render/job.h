// job.h: how does a picture come about, step by step?
//
// A job is a render that can be looked at while it runs, kept on disk and gone on with (checkpoint.h), and
// shared among machines: its state is the film, the present round, and which tiles are settled. Between
// rounds one thread decides what comes next; inside a round any crew brings units in any order.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "boxwood/render/camera.h"
#include "boxwood/render/film.h"
#include "boxwood/render/integrator.h"
#include "boxwood/render/layer.h"
#include "boxwood/render/render.h"
#include "boxwood/render/rounds.h"

namespace boxwood::render {

/// What the samples of one unit brought.
struct UnitResult {
  TileSums sums;
  Effort effort = {};
};

/// A unit of the present round, and its number among those of its tile.
struct Task {
  Unit unit;
  int index;
};

/// How many tasks like this one each of `threads` best takes at once when so many are left: enough that many
/// paths go on together, but not so many that some threads run out of work long before the others.
std::size_t tasks_at_once(const Task& task, std::size_t left, std::size_t threads);

class RenderJob {
 public:
  /// Does all tasks, in any order, by render() and add(); may leave out some once is_stopped().
  using Crew = std::function<void(RenderJob& job, std::span<const Task> tasks)>;

  /// Throws std::invalid_argument as check() does, and when the scene's camera is not usable.
  /// Keeps a reference to `scene`.
  RenderJob(const Scene& scene, const RenderOptions& options);

  const Scene& scene() const { return scene_; }
  const RenderOptions& options() const { return options_; }

  /// Renders what is left to do, by default by the options' executor. Call once.
  RenderResult run();
  RenderResult run(const Crew& crew);

  /// What a crew does: renders a unit (a pure function; any thread, any machine), and hands the result in.
  /// A unit that was handed in before is ignored. Any thread.
  UnitResult render(const Unit& unit) const;
  /// Renders several at once, which is faster: their paths go on together (path.h). The results are those of
  /// each alone.
  std::vector<UnitResult> render(std::span<const Task> tasks) const;
  void add(const Task& task, const UnitResult& result);
  void render_and_add(std::span<const Task> tasks);
  bool is_stopped() const { return is_stopped_; }

  /// The picture as it stands: the mode's own channels alone, or all layers. Any thread, at any time.
  Image picture() const;
  Image picture_with_layers() const;

  /// What a job must keep to be gone on with, beside its film. Steady during a round.
  struct State {
    Round round;
    std::vector<std::uint8_t> is_settled;  ///< For each tile: it gets no more samples.
    std::optional<double> noise;
  };
  State state() const;
  /// All that was done so far. Any thread, at any time.
  Effort effort() const { return {rays_, samples_, dropped_}; }
  /// The present round. Steady during a round.
  const Round& round() const { return round_; }
  const Film& film() const { return film_; }
  /// Goes on from there, with the film filled as it was; before run().
  void restore(const State& state);
  Film& film() { return film_; }

 private:
  struct Samples;
  void start(const Unit& unit, Samples& samples) const;
  void add_up(const Unit& unit, std::size_t first, const Samples& samples, UnitResult& result) const;
  bool begin_next_round();
  void settle_quiet_tiles();
  double forecast() const;
  void report();

  const Scene& scene_;
  RenderOptions options_;
  Camera camera_;
  Lens lens_;
  FilterSampler filter_;
  std::unique_ptr<Integrator> integrator_;
  Features features_;
  int first_sample_, end_sample_;  // of the shard
  Film film_;

  Round round_;
  std::vector<std::uint8_t> is_settled_;
  std::optional<double> noise_;
  double samples_expected_ = 0;  // of all pixels together

  std::mutex progress_mutex_;
  std::atomic<bool> is_stopped_ = false;
  std::atomic<std::uint64_t> rays_ = 0, dropped_ = 0, samples_ = 0;
};

}  // namespace boxwood::render
