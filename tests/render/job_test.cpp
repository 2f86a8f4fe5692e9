// A render step by step: stopped and gone on with, measured, limited, and never larger for more samples.
#include "boxwood/render/job.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include <gtest/gtest.h>

#include "boxwood/gallery/gallery.h"
#include "boxwood/render/checkpoint.h"
#include "boxwood/render/compare.h"
#include "trace.h"

namespace boxwood::render {
namespace {

RenderOptions small_options() {
  RenderOptions options;
  options.width = 50;
  options.height = 35;
  options.samples = 40;
  options.filter = Filter::mitchell;
  options.layers.assign(all_layers().begin(), all_layers().end());
  options.executor = &serial_executor();
  return options;
}

bool same_bits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(float)) == 0;
}

std::string checkpoint_of(const RenderJob& job) {
  std::string bytes;
  write_checkpoint(job, [&bytes](std::string_view piece) { bytes += piece; });
  return bytes;
}

TEST(Job, GoesOnFromEveryMomentToTheSamePicture) {
  const Scene scene(gallery::make("stilllife"));
  RenderOptions options = small_options();
  options.noise = 0.3;
  const RenderResult whole = render_picture(scene, options);

  // Stop after each so many units, in another job each time, until nothing is left.
  std::string kept;
  int stops = 0;
  for (bool is_done = false; !is_done; ++stops) {
    int units = 0;
    options.progress = [&](const RenderStatus&) { return ++units <= 17; };
    RenderJob job(scene, options);
    if (!kept.empty()) read_checkpoint(job, kept);
    const RenderResult result = job.run();
    is_done = result.is_complete;
    kept = checkpoint_of(job);
    if (!is_done) continue;
    EXPECT_TRUE(same_bits(result.image, whole.image));
    EXPECT_EQ(result.rays, whole.rays);
    EXPECT_EQ(result.noise, whole.noise);
  }
  EXPECT_GT(stops, 3);
}

TEST(Job, ACheckpointIsWhatItWasInTheMiddleOfWork) {
  // Taken while other threads render.
  const Scene scene(gallery::make("cornell"));
  RenderOptions options = small_options();
  const RenderResult whole = render_picture(scene, options);
  const auto executor = make_executor(3);
  options.executor = executor.get();
  std::string kept;
  RenderJob* running = nullptr;
  int calls = 0;
  options.progress = [&](const RenderStatus&) {
    if (++calls == 20) kept = checkpoint_of(*running);
    return true;
  };
  RenderJob job(scene, options);
  running = &job;
  EXPECT_TRUE(same_bits(job.run().image, whole.image));
  ASSERT_FALSE(kept.empty());
  options.progress = nullptr;
  RenderJob again(scene, options);
  read_checkpoint(again, kept);
  EXPECT_TRUE(same_bits(again.run().image, whole.image));
}

TEST(Job, UnitsTogetherBringWhatEachBringsAlone) {
  const Scene scene(gallery::make("stilllife"));
  const RenderJob job(scene, small_options());
  const std::vector<Task> tasks{{{0, 0, 16}, 0}, {{5, 16, 16}, 0}, {{11, 32, 8}, 0}, {{2, 0, 1}, 0}};
  const std::vector<UnitResult> together = job.render(tasks);
  ASSERT_EQ(together.size(), tasks.size());
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const UnitResult alone = job.render(tasks[i].unit);
    EXPECT_EQ(together[i].sums, alone.sums) << i;
    EXPECT_EQ(together[i].effort, alone.effort) << i;
    EXPECT_GT(alone.effort.rays, 0u) << i;
  }
}

TEST(Job, WhatIsGoneOnWithCountsNothingTwice) {
  // A checkpoint after every unit, most of them in the middle of what is rendered together; and while several
  // threads hand in units.
  const Scene scene(gallery::make("cornell"));
  RenderOptions options = small_options();
  options.width = 100;  // 35 tiles, of which one thread takes four together
  options.height = 70;
  options.samples = 4;
  options.layers.clear();
  const RenderResult whole = render_picture(scene, options);
  const auto several = make_executor(3);
  for (Executor* executor : {&serial_executor(), several.get()}) {
    options.executor = executor;
    std::vector<std::string> kept;
    RenderJob* running = nullptr;
    options.progress = [&](const RenderStatus&) {
      kept.push_back(checkpoint_of(*running));
      return true;
    };
    RenderJob job(scene, options);
    running = &job;
    EXPECT_EQ(job.run().rays, whole.rays);
    ASSERT_GT(kept.size(), 10u);
    options.progress = nullptr;
    for (std::size_t i = 0; i < kept.size(); i += 11) {
      RenderJob again(scene, options);
      read_checkpoint(again, kept[i]);
      const RenderResult result = again.run();
      EXPECT_EQ(result.rays, whole.rays) << executor->concurrency() << " threads, checkpoint " << i;
      EXPECT_EQ(result.samples, whole.samples) << executor->concurrency() << " threads, checkpoint " << i;
    }
  }
}

TEST(Job, IgnoresAUnitThatComesTwice) {
  const Scene scene(gallery::make("cornell"));
  const RenderOptions options = small_options();
  const RenderResult expected = render_picture(scene, options);
  RenderJob job(scene, options);
  const RenderResult result = job.run([](RenderJob& led, std::span<const Task> tasks) {
    for (std::size_t i = tasks.size(); i-- > 0;) {
      const UnitResult unit = led.render(tasks[i].unit);
      led.add(tasks[i], unit);
      led.add(tasks[i], unit);
    }
  });
  EXPECT_TRUE(same_bits(result.image, expected.image));
  EXPECT_EQ(result.rays, expected.rays);
}

TEST(Job, DamagedCheckpointsAreErrors) {
  const Scene scene(gallery::make("cornell"));
  const RenderOptions options = small_options();
  RenderJob job(scene, options);
  const std::string good = checkpoint_of(job);
  for (std::size_t at = 0; at < good.size(); at += at < 600 ? 1 : good.size() / 50) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x41);
    RenderJob fresh(scene, options);
    EXPECT_THROW(read_checkpoint(fresh, bad), std::runtime_error) << "byte " << at;
    EXPECT_THROW(read_checkpoint(fresh, std::string_view(good).substr(0, at)), std::runtime_error) << at;
  }
}

TEST(Job, TheNoiseIsTheErrorThatIsLeft) {
  const Scene scene(gallery::make("cornell"));
  RenderOptions options;
  options.width = options.height = 32;
  options.samples = 2048;
  const Image reference = render_picture(scene, options).image;
  double sum = 0;
  for (const float x : reference.pixels) sum += x;
  const double mean = sum / static_cast<double>(reference.pixels.size());

  for (const double target : {0.2, 0.1}) {
    options.noise = target;
    const RenderResult result = render_picture(scene, options);
    ASSERT_TRUE(result.noise.has_value());
    EXPECT_LE(*result.noise, target);
    EXPECT_LT(result.samples, 2048);

    // The error of each pixel's brightness, measured as the noise is.
    double error = 0, light = 0;
    for (std::size_t i = 0; i < reference.pixels.size(); i += 3) {
      const double a = (result.image.pixels[i] + result.image.pixels[i + 1] + result.image.pixels[i + 2]) / 3;
      const double b = (reference.pixels[i] + reference.pixels[i + 1] + reference.pixels[i + 2]) / 3;
      error += (a - b) * (a - b) / (b * b + 0.01 * mean * mean);
      light += a;
    }
    const double found = std::sqrt(error / (32 * 32));
    EXPECT_LT(found, 1.3 * *result.noise) << target;
    EXPECT_GT(found, 0.5 * *result.noise) << target;
    // Stopping early where it looks quiet takes no light away: the whole picture is as bright.
    EXPECT_NEAR(light / (32 * 32), mean, 4 * mean * target / 32) << target;
  }
}

TEST(Job, SamplesGoWhereTheNoiseIs) {
  const Scene scene(gallery::make("cornell"));
  RenderOptions options;
  options.width = options.height = 64;
  options.samples = 4096;
  options.noise = 0.1;
  options.layers = {Layer::samples};
  const Image image = render_picture(scene, options).image;
  float least = kInfinity, most = 0;
  for (int i = 0; i < 64 * 64; ++i) {
    least = min(least, image.pixels[static_cast<std::size_t>(4 * i + 3)]);
    most = max(most, image.pixels[static_cast<std::size_t>(4 * i + 3)]);
  }
  EXPECT_GE(least, 32);
  EXPECT_GT(most, 2 * least);
}

TEST(Job, ShardsTakeEachSampleOnce) {
  const Scene scene(gallery::make("cornell"));
  RenderOptions options = small_options();
  options.samples = 23;
  options.layers = {Layer::samples};
  for (const int count : {1, 2, 5, 23}) {
    std::vector<double> samples(std::size_t(options.width) * std::size_t(options.height));
    for (int index = 1; index <= count; ++index) {
      options.shard = {index, count};
      const Image image = render_picture(scene, options).image;
      for (std::size_t i = 0; i < samples.size(); ++i) samples[i] += image.pixels[4 * i + 3];
    }
    for (const double n : samples) ASSERT_EQ(n, 23) << count;
  }
}

TEST(Job, LayersTellWhatIsSeen) {
  // A ball of radius 1 in the middle of the view, 5 away, and nothing behind it.
  SceneDesc desc;
  desc.add(std::vector<Sphere>{{{0, 0, -5}, 1}},
           desc.add(material_of_kind(Material::Kind::matte, {0.2f, 0.4f, 0.6f})));
  desc.camera.emplace();
  desc.sky = constant_sky(1);
  const Scene scene(desc);
  RenderOptions options;
  options.width = options.height = 33;
  options.samples = 64;
  options.layers.assign(all_layers().begin(), all_layers().end());
  const Image image = render_picture(scene, options).image;
  const auto value = [&](int x, int y, const std::string& name) {
    const auto found = std::find(image.channel_names.begin(), image.channel_names.end(), name);
    EXPECT_NE(found, image.channel_names.end()) << name;
    return image.at(x, y)[found - image.channel_names.begin()];
  };
  EXPECT_NEAR(value(16, 16, "albedo.G"), 0.4f, 1e-6f);
  EXPECT_NEAR(value(16, 16, "normal.Z"), 1, 0.01f);
  EXPECT_NEAR(value(16, 16, "depth.Z"), 4, 0.01f);
  EXPECT_NEAR(value(16, 16, "position.Z"), -4, 0.01f);
  EXPECT_EQ(value(16, 16, "object.id"), 1);
  EXPECT_EQ(value(16, 16, "material.id"), 1);
  EXPECT_EQ(value(16, 16, "samples.count"), 64);
  EXPECT_GT(value(16, 16, "variance.Y"), 0);
  for (const std::string& name : image.channel_names) {
    if (name.size() > 1 && name != "samples.count") {
      EXPECT_EQ(value(0, 0, name), 0) << name;
    }
  }
  EXPECT_EQ(value(0, 0, "R"), 1);
  EXPECT_EQ(value(0, 0, "variance.Y"), 0);
}

TEST(Job, LayersSeeThroughCutOuts) {
  // A veil of which hardly anything is there, before a wall.
  SceneDesc desc;
  Material veil = material_of_kind(Material::Kind::matte, {1, 0, 0}),
           wall = material_of_kind(Material::Kind::matte, {0, 1, 0});
  veil.opacity = 0.1f;
  const auto square = [](float z) {
    return std::vector<Quad>{{{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}}};
  };
  desc.add(square(-2), desc.add(veil));
  desc.add(square(-5), desc.add(wall));
  desc.camera.emplace();
  RenderOptions options;
  options.width = options.height = 5;
  options.samples = 1;
  options.layers = {Layer::albedo, Layer::depth, Layer::object};
  const Image image = render_picture(Scene(desc), options).image;
  const float* middle = image.at(2, 2);
  EXPECT_EQ((std::vector<float>{middle[3], middle[4]}), (std::vector<float>{0, 1}));
  EXPECT_NEAR(middle[6], 5, 1e-4f);
  EXPECT_EQ(middle[7], 2);
}

TEST(Job, SamplesThatAreNotFiniteAreLeftOutAndCounted) {
  // Two lamps of the largest light that a float holds: the sum of them, in a mirror or not, may be too much.
  SceneDesc desc;
  Material lamp_material = lamp(3e38f, true);
  lamp_material.color = {1, 1, 1};
  lamp_material.kind = Material::Kind::mirror;
  desc.add(std::vector<Sphere>{{{0, 0, -5}, 1}}, desc.add(lamp_material));
  desc.sky = constant_sky(3e38f);
  desc.camera.emplace();
  RenderOptions options;
  options.width = options.height = 9;
  options.samples = 4;
  const RenderResult result = render_picture(Scene(desc), options);
  EXPECT_GT(result.dropped_samples, 0u);
  for (const float x : result.image.pixels) EXPECT_TRUE(std::isfinite(x));
}

TEST(Job, RefusesWhatDoesNotGoTogether) {
  const Scene scene{SceneDesc{}};
  const auto refused = [&](auto change) {
    RenderOptions options = small_options();
    change(options);
    EXPECT_THROW(RenderJob(scene, options), std::invalid_argument);
  };
  refused([](RenderOptions& o) { o.noise = -1; });
  refused([](RenderOptions& o) { o.noise = std::nan(""); });
  refused([](RenderOptions& o) { o.shard = {0, 2}; });
  refused([](RenderOptions& o) { o.shard = {3, 2}; });
  refused([](RenderOptions& o) { o.shard = {1, 41}; });
  refused([](RenderOptions& o) { o.shard = {1, 2}, o.noise = 0.1; });
  refused([](RenderOptions& o) { o.layers = {Layer::depth, Layer::depth}; });
}

TEST(Rounds, CoverTheSamplesInOrder) {
  for (const auto& [first, end] :
       {std::pair(0, 1), std::pair(0, 64), std::pair(7, 100), std::pair(0, 1 << 20)}) {
    Round round{first, first};
    int rounds = 0;
    for (Round next = next_round(round, first, end); next.end > next.begin;
         next = next_round(round, first, end)) {
      ASSERT_EQ(next.begin, round.end);
      ASSERT_LE(next.unit_count(), 64);
      int samples = 0;
      for (int i = 0; i < next.unit_count(); ++i) samples += next.unit(0, i).count;
      ASSERT_EQ(samples, next.end - next.begin);
      round = next;
      ++rounds;
    }
    EXPECT_EQ(round.end, end);
    EXPECT_LT(rounds, 1200);
  }
}

}  // namespace
}  // namespace boxwood::render
