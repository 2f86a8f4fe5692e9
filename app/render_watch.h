// render_watch.h: what happens while a picture is rendered?
//
// The bar moves, the preview and the checkpoint are written anew now and then, and the render is told to stop
// when its time is over or Ctrl-C was pressed. All of it in one thread at a time, while the others go on.
#pragma once

#include <chrono>
#include <string>

#include "boxwood/render/job.h"
#include "checkpoint_file.h"
#include "picture_file.h"
#include "progress_bar.h"

namespace boxwood::app {

/// Something to be done every so often, and not so often that it takes a notable part of the time.
class Repeat {
 public:
  using Clock = std::chrono::steady_clock;
  /// 0 seconds: never.
  Repeat(double first_seconds, double seconds) : wait_(first_seconds), seconds_(seconds) {}

  template <class Action>
  void maybe(const Action& action) {
    if (wait_ == 0 || since(last_) < wait_) return;
    const Clock::time_point start = Clock::now();
    action();
    constexpr double kMostTime = 0.05;  // the share that the action may take
    wait_ = std::max(seconds_, since(start) / kMostTime);
    last_ = Clock::now();
  }

 private:
  static double since(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  }
  double wait_, seconds_;
  Clock::time_point last_ = Clock::now();
};

struct WatchOptions {
  double seconds = 0;             ///< The time budget; 0: none.
  double checkpoint_seconds = 0;  ///< 0: no checkpoints.
  std::string preview;            ///< Empty: none.
  PictureLook look;               ///< Of the preview.
};

class RenderWatch {
 public:
  /// The clock starts now.
  RenderWatch(const render::RenderJob& job, ProgressBar& bar, const CheckpointFile& checkpoint,
              WatchOptions options);

  /// As RenderOptions::progress: false when the render is to stop.
  bool update(const render::RenderStatus& status);

  /// Whether the render was stopped because its time was over.
  bool is_out_of_time() const { return is_out_of_time_; }
  double elapsed() const;

 private:
  void try_to(const char* consequence, const std::function<void()>& action);

  const render::RenderJob& job_;
  ProgressBar& bar_;
  const CheckpointFile& checkpoint_;
  WatchOptions options_;
  Repeat::Clock::time_point start_ = Repeat::Clock::now();
  Repeat preview_, checkpoints_;
  std::uint64_t rays_before_;  // that a checkpoint brought along
  bool is_out_of_time_ = false, is_warned_ = false;
};

}  // namespace boxwood::app
