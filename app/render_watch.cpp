#include "render_watch.h"

#include <cmath>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "console.h"
#include "interrupt.h"

namespace boxwood::app {
namespace {

constexpr double kFirstPreview = 1, kPreviewInterval = 4;  // seconds

/// "7.5", "12": with a fraction only where it says something.
std::string samples_text(double samples) {
  const bool is_whole = samples >= 10 || samples == std::floor(samples);
  return fmt::format("{:.{}f}", samples, is_whole ? 0 : 1);
}

}  // namespace

RenderWatch::RenderWatch(const render::RenderJob& job, ProgressBar& bar, const CheckpointFile& checkpoint,
                         WatchOptions options)
    : job_(job),
      bar_(bar),
      checkpoint_(checkpoint),
      options_(std::move(options)),
      preview_(options_.preview.empty() ? 0 : kFirstPreview, kPreviewInterval),
      checkpoints_(checkpoint.is_possible() ? options_.checkpoint_seconds : 0, options_.checkpoint_seconds),
      rays_before_(job.effort().rays) {}

bool RenderWatch::update(const render::RenderStatus& status) {
  const double time = elapsed();
  const double mrays_per_s = static_cast<double>(status.rays - rays_before_) * 1e-6 / std::max(time, 1e-9);
  // What decides when it ends is shown beside its goal.
  const render::RenderOptions& asked = job_.options();
  std::string detail = samples_text(status.samples);
  if (asked.noise == 0 && options_.seconds == 0)
    detail += fmt::format("/{}", asked.samples / asked.shard.count);
  detail += " samples";
  if (status.noise) detail += fmt::format("  noise {:.3g}", *status.noise);
  if (status.noise && asked.noise > 0) detail += fmt::format("/{:.3g}", asked.noise);
  detail += fmt::format("  {:.2f} Mrays/s", mrays_per_s);
  // Whichever ends first: the samples or the time.
  const double time_done = options_.seconds > 0 ? std::min(1.0, time / options_.seconds) : 0;
  bar_.update("rendering", std::max(status.done, time_done), detail);

  if (status.is_whole)
    preview_.maybe([&] {
      try_to("there is no preview", [&] {
        write_picture(options_.preview, job_.picture(), job_.options().mode, options_.look, io::Lasting::no);
      });
    });
  checkpoints_.maybe(
      [&] { try_to("the render goes on without a new checkpoint", [&] { checkpoint_.write(job_); }); });

  // Every pixel gets a sample, however short the time is.
  is_out_of_time_ = options_.seconds > 0 && time >= options_.seconds && status.is_whole;
  return !is_out_of_time_ && !is_interrupted();
}

double RenderWatch::elapsed() const {
  return std::chrono::duration<double>(Repeat::Clock::now() - start_).count();
}

/// What goes wrong beside the render does not stop it, and is said once.
void RenderWatch::try_to(const char* consequence, const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    if (is_warned_) return;
    is_warned_ = true;
    bar_.clear();
    print_error("boxwood: warning: {}; {}\n", error.what(), consequence);
  }
}

}  // namespace boxwood::app
