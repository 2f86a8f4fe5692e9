#include "boxwood/render/job.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "boxwood/render/aov.h"
#include "boxwood/render/draws.h"
#include "boxwood/render/noise.h"
#include "boxwood/render/path.h"
#include "boxwood/render/picture.h"

namespace boxwood::render {
namespace {

// Before so many samples the noise of a tile is not trusted: light that is rarely found may not have shown.
constexpr int kLeastToSettle = 2 * kLeastForNoise;
// Tasks that are handed out together; only very large pictures have more in a round.
constexpr std::size_t kMaxTasks = 1 << 20;
// So many samples keep batches of paths full but for a small part of the time, at the end.
constexpr std::size_t kSamplesAtOnce = 1 << 14;

const RenderOptions& checked(const RenderOptions& options) {
  check(options);
  return options;
}

/// Channels of the picture itself, of the brightness of half the samples, and of each layer that is a mean.
std::vector<int> group_sizes(const Integrator& integrator, const Features& features) {
  std::vector<int> sizes{integrator.channels(), 1};
  for (const Layer layer : features.layers()) sizes.push_back(static_cast<int>(layer_channels(layer).size()));
  return sizes;
}

int share_end(const RenderOptions& options, int index) {
  return static_cast<int>(std::int64_t(options.samples) * index / options.shard.count);
}

/// Threads of one machine, by an executor.
void work_here(RenderJob& job, std::span<const Task> tasks) {
  if (tasks.empty()) return;
  Executor& executor = job.options().executor ? *job.options().executor : default_executor();
  const auto threads = static_cast<std::size_t>(executor.concurrency());
  const std::size_t group = tasks_at_once(tasks[0], tasks.size(), threads);
  parallel_for(executor, 0, (tasks.size() + group - 1) / group, 1, [&](std::size_t i) {
    if (!job.is_stopped())
      job.render_and_add(tasks.subspan(i * group, std::min(group, tasks.size() - i * group)));
  });
}

bool all_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

std::size_t tasks_at_once(const Task& task, std::size_t left, std::size_t threads) {
  const std::size_t unit_samples = std::size_t(task.unit.count) * kTileSide * kTileSide;
  return std::clamp<std::size_t>(kSamplesAtOnce / unit_samples, 1,
                                 std::max<std::size_t>(1, left / (8 * threads)));
}

RenderJob::RenderJob(const Scene& scene, const RenderOptions& options)
    : scene_(scene),
      options_(checked(options)),
      camera_(choose_camera(scene.description(), options.width, options.height)),
      lens_(camera_, options.width, options.height),
      filter_(options.filter),
      integrator_(options.mode == Mode::path
                      ? make_path_tracer(scene, camera_, pixel_angle(camera_, options.width, options.height),
                                         options.bounces)
                      : make_aov(scene, options.mode)),
      features_(scene, options.layers),
      first_sample_(share_end(options, options.shard.index - 1)),
      end_sample_(share_end(options, options.shard.index)),
      film_(options.width, options.height, group_sizes(*integrator_, features_)),
      round_{first_sample_, first_sample_},
      is_settled_(film_.grid().size()) {}

/// Samples of units on their way.
struct RenderJob::Samples {
  std::vector<Ray> rays;
  std::vector<Sampler> samplers;  // have drawn what the camera needed
  std::vector<int> signs;         // from the filter
  // What they see,
  std::vector<float> values;
  std::unique_ptr<bool[]> is_counted;
  std::vector<RayCounts> traced;
  // and what they hit.
  std::vector<float> features;
  std::unique_ptr<bool[]> is_hit;
};

UnitResult RenderJob::render(const Unit& unit) const {
  const Task task{unit, 0};
  return std::move(render(std::span(&task, 1)).front());
}

std::vector<UnitResult> RenderJob::render(std::span<const Task> tasks) const {
  const auto size_of = [&](const Unit& unit) {
    return film_.grid().area(unit.tile).pixel_count() * static_cast<std::size_t>(unit.count);
  };
  std::size_t count = 0;
  for (const Task& task : tasks) count += size_of(task.unit);
  Samples samples;
  samples.rays.reserve(count);
  samples.samplers.reserve(count);
  samples.signs.reserve(count);
  for (const Task& task : tasks) start(task.unit, samples);

  // See what they see, and what they hit.
  samples.values.resize(count * static_cast<std::size_t>(integrator_->channels()));
  samples.is_counted.reset(new bool[count]);
  samples.traced.resize(count);
  integrator_->sample_many(samples.rays, samples.samplers, samples.values, {samples.is_counted.get(), count},
                           samples.traced);
  samples.features.resize(count * features_.channels());
  if (!features_.layers().empty()) {
    samples.is_hit.reset(new bool[count]);
    features_.look(samples.rays, samples.features, {samples.is_hit.get(), count});
    for (RayCounts& traced : samples.traced) ++traced.camera;
  }

  std::vector<UnitResult> results;
  std::size_t first = 0;
  for (const auto& [unit, index] : tasks) {
    results.push_back({film_.empty_tile(unit.tile)});
    add_up(unit, first, samples, results.back());
    first += size_of(unit);
  }
  return results;
}

/// Starts a ray for each sample of a unit. A picture of one sample takes the middle of each pixel.
void RenderJob::start(const Unit& unit, Samples& samples) const {
  const TileArea area = film_.grid().area(unit.tile);
  struct Start {
    int x, y, sample;
  };
  std::array<Start, kBlock> starts;
  Draws draws;
  int count = 0;
  const auto start_block = [&] {
    draws.draw(2);
    for (int i = 0; i < count; ++i) {
      const auto [x, y, sample] = starts[i];
      const FilterSample place = options_.samples > 1
                                     ? filter_.sample(draws.pair(i, 0), static_cast<std::uint32_t>(sample))
                                     : FilterSample{};
      const Vec2 point{static_cast<float>(x) + 0.5f + place.offset.x,
                       static_cast<float>(y) + 0.5f + place.offset.y};
      samples.rays.push_back(lens_.ray(point, draws.pair(i, 1)));
      samples.signs.push_back(place.sign);
      samples.samplers[samples.samplers.size() - static_cast<std::size_t>(count - i)].skip(2);
    }
    count = 0;
  };
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x)
      for (int s = unit.first; s < unit.first + unit.count; ++s) {
        const auto pixel = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(options_.width) +
                           static_cast<std::uint32_t>(x);
        samples.samplers.emplace_back(pixel, static_cast<std::uint32_t>(s));
        draws.set(count, samples.samplers.back());
        starts[count++] = {x, y, s};
        if (count == kBlock) start_block();
      }
  start_block();
}

/// Adds up the samples of a unit, of which `first` is the first one. A sample that is not finite is left out
/// whole, and counted.
void RenderJob::add_up(const Unit& unit, std::size_t first, const Samples& samples,
                       UnitResult& result) const {
  const auto channels = static_cast<std::size_t>(integrator_->channels());
  const auto per_pixel = static_cast<std::size_t>(unit.count);
  for (std::size_t k = 0; k < result.sums.pixel_count() * per_pixel; ++k) {
    const std::size_t i = first + k, pixel = k / per_pixel;
    result.effort.rays += samples.traced[i].total();
    ++result.effort.samples;
    const bool is_counted = samples.is_counted[i];
    const std::span values = std::span(samples.values).subspan(i * channels, channels);
    const std::span seen =
        std::span(samples.features).subspan(i * features_.channels(), features_.channels());
    if ((is_counted && !all_finite(values)) || !all_finite(seen)) {
      ++result.effort.dropped;
      continue;
    }
    const int sign = samples.signs[i];
    result.sums.count_sample(pixel);
    if (is_counted) {
      result.sums.add(pixel, 0, values, sign);
      float brightness = 0;
      for (const float value : values) brightness += value;
      brightness /= static_cast<float>(channels);
      if (is_in_half(unit.first + static_cast<int>(k % per_pixel)))
        result.sums.add(pixel, 1, {&brightness, 1}, sign);
    }
    std::size_t channel = 0;
    for (std::size_t layer = 0; layer < features_.layers().size(); ++layer) {
      const auto size = static_cast<std::size_t>(result.sums.channels(2 + layer));
      if (samples.is_hit[i] || Features::counts_misses(features_.layers()[layer]))
        result.sums.add(pixel, 2 + layer, seen.subspan(channel, size), sign);
      channel += size;
    }
  }
}

void RenderJob::add(const Task& task, const UnitResult& result) {
  if (!film_.add(task.unit.tile, task.index, result.sums, result.effort)) return;
  rays_ += result.effort.rays;
  dropped_ += result.effort.dropped;
  samples_ += result.effort.samples;
  report();
}

void RenderJob::render_and_add(std::span<const Task> tasks) {
  const std::vector<UnitResult> results = render(tasks);
  for (std::size_t i = 0; i < tasks.size(); ++i) add(tasks[i], results[i]);
}

RenderResult RenderJob::run() {
  return run(work_here);
}

RenderResult RenderJob::run(const Crew& crew) {
  while (!is_stopped_) {
    // The tasks of this round that are left, every tile's first before any tile's second.
    std::vector<Task> tasks;
    for (int index = 0; index < round_.unit_count() && !is_stopped_; ++index) {
      for (std::uint32_t tile = 0; tile < is_settled_.size(); ++tile)
        if (!is_settled_[tile] && !film_.has(tile, index)) tasks.push_back({round_.unit(tile, index), index});
      if (tasks.size() < kMaxTasks && index + 1 < round_.unit_count()) continue;
      crew(*this, tasks);
      tasks.clear();
    }
    if (is_stopped_ || !begin_next_round()) break;
  }

  RenderResult result;
  result.image = picture_with_layers();
  result.is_complete = !is_stopped_;
  result.rays = rays_;
  result.dropped_samples = dropped_;
  result.samples = static_cast<double>(samples_) / (double(options_.width) * options_.height);
  result.noise = noise_;
  return result;
}

/// Whether there is anything left to do.
bool RenderJob::begin_next_round() {
  settle_quiet_tiles();
  if (std::find(is_settled_.begin(), is_settled_.end(), 0) == is_settled_.end()) return false;
  round_ = next_round(round_, first_sample_, end_sample_);
  film_.begin_round();
  samples_expected_ = forecast();
  return round_.end > round_.begin;
}

/// Measures the noise, and lets tiles rest that have come down to the target. A whole tile decides on the
/// samples of all its pixels: a pixel that stopped by its own few samples would stop more often when these
/// happen to agree, and be biased (Kirk and Arvo, "Unbiased Sampling Techniques for Image Synthesis", 1991).
void RenderJob::settle_quiet_tiles() {
  const int samples = round_.end - first_sample_;
  if (samples < kLeastForNoise) return;
  const double floor = error_floor(film_), target = options_.noise * options_.noise;
  double sum = 0;
  for (std::size_t tile = 0; tile < is_settled_.size(); ++tile) {
    const auto [error, pixels] = film_.with_tile(tile, [&](const Film::Tile& held) {
      return std::pair(tile_error(held.sums, floor), static_cast<double>(held.sums.pixel_count()));
    });
    sum += error;
    if (samples >= kLeastToSettle && options_.noise > 0 && error <= target * pixels) is_settled_[tile] = 1;
  }
  noise_ = std::sqrt(sum / (double(options_.width) * options_.height));
}

/// How many samples all pixels will have taken in the end. The variance of a mean falls like 1 / samples, so
/// a tile's error says how many it will want.
double RenderJob::forecast() const {
  const int samples = round_.begin - first_sample_, limit = end_sample_ - first_sample_;
  const double all_pixels = double(options_.width) * options_.height;
  if (options_.noise == 0 || samples < kLeastForNoise) return all_pixels * limit;
  const double floor = error_floor(film_), target = options_.noise * options_.noise;
  double expected = static_cast<double>(samples_);
  for (std::size_t tile = 0; tile < is_settled_.size(); ++tile) {
    if (is_settled_[tile]) continue;
    const auto [error, pixels] = film_.with_tile(tile, [&](const Film::Tile& held) {
      return std::pair(tile_error(held.sums, floor), static_cast<double>(held.sums.pixel_count()));
    });
    const double wanted = std::max<double>(kLeastToSettle, samples * error / (target * pixels));
    expected += pixels * std::max(0.0, std::min<double>(wanted, limit) - samples);
  }
  return expected;
}

/// Tells `progress` when no other thread is telling it right now.
void RenderJob::report() {
  if (!options_.progress) return;
  const std::unique_lock lock(progress_mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  RenderStatus status;
  status.rays = rays_;
  status.samples = static_cast<double>(samples_) / (double(options_.width) * options_.height);
  // How long a noise takes cannot be known before there is a measure of it.
  if (options_.noise == 0 || noise_)
    status.done = std::min(1.0, static_cast<double>(samples_) / std::max(1.0, samples_expected_));
  status.noise = noise_;
  status.is_whole = round_.begin > first_sample_;
  if (!options_.progress(status)) is_stopped_ = true;
}

Image RenderJob::picture() const {
  return picture_of(film_, options_.mode, {});
}

Image RenderJob::picture_with_layers() const {
  Image image = picture_of(film_, options_.mode, options_.layers);
  write_names(image, scene_, lens_, options_);
  return image;
}

RenderJob::State RenderJob::state() const {
  return {round_, is_settled_, noise_};
}

void RenderJob::restore(const State& state) {
  round_ = state.round;
  is_settled_ = state.is_settled;
  Effort effort;
  for (std::size_t tile = 0; tile < is_settled_.size(); ++tile)
    film_.with_tile(tile, [&effort](const Film::Tile& held) { effort += held.effort; });
  rays_ = effort.rays;
  dropped_ = effort.dropped;
  samples_ = effort.samples;
  noise_ = state.noise;
  samples_expected_ = forecast();
}

}  // namespace boxwood::render
