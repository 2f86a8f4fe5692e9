// cmd_render.cpp: boxwood render, a picture of a scene.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood/io/image.h"
#include "boxwood/render/light.h"
#include "boxwood/render/shard.h"
#include "boxwood/scene/scene.h"
#include "checkpoint_file.h"
#include "cluster.h"
#include "commands.h"
#include "console.h"
#include "interrupt.h"
#include "output_file.h"
#include "progress_bar.h"
#include "render_arguments.h"
#include "render_watch.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

constexpr int kDefaultWidth = 1280, kDefaultHeight = 720;

/// Reads the scene and builds its trees. A size that was not asked for becomes the file's own, else ours; so
/// do bounces that are asked for as the file wants them.
Scene open_and_build(const RenderArguments& arguments, render::RenderOptions& options, ProgressBar& bar) {
  bar.update("reading", 0);
  SceneDesc desc = open_scene(arguments.scene, *options.executor);
  bar.clear();
  print_warnings(desc);
  // Formats of bare geometry have no lights; scenes are meant to have some.
  if (io::lower_extension(arguments.scene) == ".pbrt" && !render::has_light(desc))
    print_error("boxwood: warning: there is no light in {}; a plain sky stands in\n", arguments.scene);
  if (is_interrupted()) throw Cancelled();

  if (arguments.size.empty()) {
    const bool has_wish = desc.camera && desc.camera->width > 0 && desc.camera->height > 0;
    options.width = has_wish ? desc.camera->width : kDefaultWidth;
    options.height = has_wish ? desc.camera->height : kDefaultHeight;
    render::check(options);
  }

  if (arguments.bounces == kAsTheFile) {
    if (!desc.bounces)
      throw std::runtime_error("--bounces file: " + arguments.scene + " does not say how many it wants");
    options.bounces = std::min(*desc.bounces, render::kMaxBounces);
  }

  BuildOptions build = build_options(arguments.build);
  build.executor = options.executor;
  build.progress = [&bar](std::string_view, double done) {
    bar.update("building", done);
    return !is_interrupted();
  };
  Scene scene(std::move(desc), build);
  if (is_interrupted()) throw Cancelled();
  return scene;
}

/// Goes on from the checkpoint when that is wished for and there is one.
void resume(const RenderArguments& arguments, const CheckpointFile& checkpoint, render::RenderJob& job) {
  if (!checkpoint.exists()) {
    if (arguments.is_resumed && !arguments.is_quiet)
      print_error("there is no {}; starting with the first sample\n", checkpoint.path());
    return;
  }
  if (!arguments.is_resumed) {
    if (!arguments.is_quiet) print_error("starting anew; --resume would go on from {}\n", checkpoint.path());
    return;
  }
  checkpoint.read(job);
  if (!arguments.is_quiet)
    print_error(
        "going on from {} at {:.1f} samples\n", checkpoint.path(),
        static_cast<double>(job.effort().samples) / (double(job.options().width) * job.options().height));
}

/// Writes the picture to each of its files. What cannot be written where it was wanted ends up elsewhere.
void write_outputs(const RenderArguments& arguments, const render::RenderJob& job, const Image& image) {
  const bool is_shard = job.options().shard.count > 1;
  for (const std::string& output : arguments.outputs)
    write_here_or_in_temp(output, [&](const std::string& path) {
      if (!is_shard) return write_picture(path, image, job.options().mode, arguments.look);
      const render::FilmWords planes = render::words_of(job.film());
      io::write_image(path, image,
                      {.note = render::text_of(render::facts_of(job)),
                       .word_names = planes.names,
                       .words = planes.words});
    });
}

/// The same; when it fails, what was rendered is also kept in the checkpoint.
void write_outputs_or_checkpoint(const RenderArguments& arguments, const render::RenderJob& job,
                                 const Image& image, const CheckpointFile& checkpoint) {
  try {
    write_outputs(arguments, job, image);
  } catch (const std::runtime_error& error) {
    try {
      if (arguments.checkpoint_seconds > 0) checkpoint.write(job);
    } catch (const FileError&) {
      // The disk that has no room for the picture has none for this either; an older one may be there.
    }
    if (!checkpoint.exists()) throw;
    throw std::runtime_error(std::string(error.what()) + "; --resume goes on from " + checkpoint.path());
  }
}

/// What the other ranks of a cluster do. What keeps one from it, the leader says.
void help_leader(const RenderArguments& arguments, render::RenderOptions& options, Cluster& cluster) {
  std::optional<Scene> scene;
  std::optional<render::RenderJob> job;
  try {
    ProgressBar bar(true);
    scene.emplace(open_and_build(arguments, options, bar));
    job.emplace(*scene, options);
  } catch (const std::exception& error) {
    return cluster.cannot_help(error.what());
  }
  cluster.help(*job);
}

std::string summary(const render::RenderResult& result, const render::RenderOptions& options) {
  std::string text = fmt::format("{}x{}, {}, {:.4g} samples", options.width, options.height,
                                 render::mode_name(options.mode), result.samples);
  if (result.noise) text += fmt::format(", noise {:.3g}", *result.noise);
  return text;
}

void render_command(const RenderArguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  check_together(arguments);
  render::RenderOptions options = options_from(arguments);

  render::check(options);
  catch_interrupts();
  const std::unique_ptr<Executor> executor = make_executor(arguments.threads);
  options.executor = executor.get();
  std::optional<Cluster> cluster;
  if (is_in_cluster()) cluster.emplace();
  if (cluster && !cluster->is_leader()) return help_leader(arguments, options, *cluster);

  // Find out what cannot work before any work is done.
  for (const std::string& output : arguments.outputs) check_writable(output);
  if (!arguments.preview.empty()) check_writable(arguments.preview);

  ProgressBar bar(arguments.is_quiet);
  const Scene scene = open_and_build(arguments, options, bar);

  std::optional<RenderWatch> watch;
  options.progress = [&watch](const render::RenderStatus& status) { return watch->update(status); };
  render::RenderJob job(scene, options);
  bar.clear();
  const CheckpointFile checkpoint(arguments.outputs.front());
  resume(arguments, checkpoint, job);
  const std::uint64_t rays_before = job.effort().rays;
  watch.emplace(
      job, bar, checkpoint,
      WatchOptions{arguments.seconds, arguments.checkpoint_seconds, arguments.preview, arguments.look});
  const render::RenderResult result =
      cluster ? job.run(cluster->crew(job,
                                      [&bar](const std::string& problem) {
                                        bar.clear();
                                        print_error("boxwood: warning: {}\n", problem);
                                      }))
              : job.run();
  const double seconds = watch->elapsed();
  bar.clear();

  const bool is_finished = result.is_complete || watch->is_out_of_time();
  if (!is_finished && arguments.checkpoint_seconds > 0) checkpoint.write(job);
  write_outputs_or_checkpoint(arguments, job, result.image, checkpoint);
  if (!arguments.preview.empty())
    write_picture(arguments.preview, job.picture(), options.mode, arguments.look, io::Lasting::no);
  if (result.dropped_samples > 0)
    print_error("boxwood: warning: {} samples were not finite and were left out\n", result.dropped_samples);
  if (!is_finished)
    throw std::runtime_error("stopped; " + arguments.outputs.front() + " shows what there was so far" +
                             (checkpoint.exists() ? ", and --resume goes on" : ""));
  checkpoint.remove();
  // What killed renders of this picture left of writing it.
  for (const std::string& output : arguments.outputs) io::remove_parts(output);
  if (arguments.is_quiet) return;
  for (const std::string& output : arguments.outputs)
    print_error("wrote {}: {}; {} rays at {:.2f} Mrays/s; {:.1f} s in all\n", output,
                summary(result, options), result.rays,
                static_cast<double>(result.rays - rays_before) * 1e-6 / std::max(seconds, 1e-9),
                std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace

void add_render(CLI::App& program) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = program.add_subcommand("render", "Make a picture of a scene");
  add_options(*command, *arguments);
  command->footer(gallery_help() +
                  "\nExamples:\n"
                  "  boxwood render -o picture.png\n"
                  "  boxwood render bunny.obj -o bunny.png --size 800x800 --samples 256\n"
                  "  boxwood render kitchen/scene.pbrt -o kitchen.exr --noise 0.02 --time 600\n"
                  "  boxwood render cornell -o all.exr --layers all --preview look.png\n"
                  "  boxwood render city:1000 -o depth.exr --mode depth --samples 1\n"
                  "  boxwood render cornell -o part3.exr --shard 3/16\n"
                  "\nCtrl-C writes the picture as far as it got (exit code 1); a second Ctrl-C ends\n"
                  "the program at once. Either way, and after a crash, --resume goes on.");
  command->callback([arguments] { render_command(*arguments); });
}

}  // namespace boxwood::app
