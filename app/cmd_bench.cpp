// cmd_bench.cpp: boxwood bench, build and ray rates beside Embree, in one run.
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "bench.h"
#include "bench_report.h"
#include "boxwood/io/file_bytes.h"
#include "boxwood_engine.h"
#include "commands.h"
#include "embree_peer.h"
#include "interrupt.h"
#include "output_file.h"
#include "progress_bar.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

struct BenchArguments {
  std::vector<std::string> scenes{"soup:1000000", "terrain:2048"};
  std::vector<std::string> sets{BenchOptions{}.sets};
  std::vector<int> threads;
  std::size_t rays_per_set = BenchOptions{}.rays_per_set;
  int repetitions = BenchOptions{}.repetitions;
  std::string rays, json, plot;
  bool is_quiet = false;
};

/// As asked for, 0 meaning all, each once; by default one thread and all.
std::vector<int> thread_counts(std::vector<int> asked) {
  if (asked.empty()) asked = {1, 0};
  std::vector<int> counts;
  for (const int threads : asked) {
    const int count = threads > 0 ? threads : default_executor().concurrency();
    if (std::find(counts.begin(), counts.end(), count) == counts.end()) counts.push_back(count);
  }
  return counts;
}

/// Names whose entries would be mixed up in every table.
void refuse_repeated(const std::vector<std::string>& scenes) {
  for (auto scene = scenes.begin(); scene != scenes.end(); ++scene)
    if (std::find(scenes.begin(), scene, *scene) != scene)
      throw CLI::ValidationError("SCENE", "'" + *scene + "' is given twice");
}

void bench_command(const BenchArguments& arguments) {
  refuse_repeated(arguments.scenes);

  // Find out what cannot work before any work is done.
  for (const std::string& scene : arguments.scenes) check_scene_exists(scene);
  for (const std::string& path : {arguments.json, arguments.plot})
    if (!path.empty()) check_writable(path);
  BenchOptions options;
  options.sets = arguments.sets;
  options.threads = thread_counts(arguments.threads);
  options.repetitions = arguments.repetitions;
  options.rays_per_set = arguments.rays_per_set;
  if (!arguments.rays.empty()) options.own_sets.push_back(read_rays(arguments.rays));

  catch_interrupts();
  std::vector<std::unique_ptr<Engine>> engines;
  engines.push_back(boxwood_engine());
  for (auto& peer : embree_engines()) engines.push_back(std::move(peer));

  ProgressBar bar(arguments.is_quiet);
  const auto open = [&](const std::string& name) {
    SceneDesc scene = open_scene(name, default_executor());
    bar.clear();
    print_warnings(scene);
    return scene;
  };
  const BenchReport report =
      bench(arguments.scenes, engines, options, open, [&](std::string_view stage, double done) {
        bar.update("measuring", done, stage);  // one stage, so that the forecast is of the whole
        return !is_interrupted();
      });
  bar.clear();

  if (!arguments.json.empty()) io::write_file(arguments.json, bench_json(report));
  if (!arguments.plot.empty()) io::write_file(arguments.plot, bench_chart(report));
  fmt::print("{}", bench_table(report));
  if (!report.disagreements.empty())
    throw std::runtime_error(fmt::format(
        "the answers of the engines differ in {} of {} measurements, first {}", report.disagreements.size(),
        report.rates.size() + report.trees.size() + report.batch_sizes.size(), report.disagreements.front()));
}

}  // namespace

void add_bench(CLI::App& program) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = program.add_subcommand("bench", "Measure builds and rays, beside Embree, in one run");
  command
      ->add_option("SCENE", arguments->scenes,
                   "Files (.obj .ply .stl .gltf .glb .pbrt) or\n"
                   "scenes that the program makes itself, see below;\n"
                   "only their triangles, in world space")
      ->capture_default_str();
  command
      ->add_option(
          "--sets", arguments->sets,
          "Which rays, commas between: primary, occlusion,\nbounce1, bounce2, random; all if not given")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(BenchOptions{}.sets).description(""));
  command->add_option("--rays", arguments->rays,
                      "Also these rays: a file of little-endian floats,\n"
                      "origin x y z, t_min, direction x y z, t_max");
  command
      ->add_option("--threads", arguments->threads, "On how many threads, commas between; 0 means\nall [1,0]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0, 4096).description(""));
  command->add_option("--rays-per-set", arguments->rays_per_set, "About how many rays are in each set")
      ->capture_default_str()
      ->check(CLI::Range(64, 100'000'000).description(""));
  command->add_option("--repeat", arguments->repetitions, "Rounds; the median of them counts")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000).description(""));
  command->add_option("--json", arguments->json, "Write the numbers to this file");
  command->add_option("--plot", arguments->plot, "Draw the rates as SVG");
  command->add_flag("--quiet", arguments->is_quiet, "No progress; the tables, warnings and errors");
  command->footer(
      "Every engine builds each scene with each of its presets, and answers the same rays:\n"
      "  primary    from the camera, in tiles of 8 x 8 pixels\n"
      "  occlusion  any hit: from where those hit, a tenth of the scene's diagonal long\n"
      "  bounce1    from where those hit, diffuse; bounce2 from where bounce1 hits\n"
      "  random     from anywhere in the scene's box, in any direction\n"
      "Engines take turns in one process. Boxwood (the balanced tree) answers rays one by\n"
      "one (single) and as spans (batch); Embree (medium quality), where it was found when\n"
      "the program was built, one by one and in packets of 16 (packet16), in its fast and\n"
      "its robust mode. Each is handed its rays in its own memory layout.\n"
      "Answers are compared: Boxwood's to the last bit; Embree's hits and sums of t within\n"
      "1e-4 and two rays. Where they differ, the output says so and the exit code is 1.\n"
      "Shapes other than triangles are left out. Large scenes take minutes; on a machine\n"
      "with other work, ratios are worth more than rates.\n\n" +
      gallery_help() +
      "\nExamples:\n"
      "  boxwood bench\n"
      "  boxwood bench bunny.obj soup:100000 --json bench.json --plot bench.svg\n"
      "  boxwood bench kitchen/scene.pbrt --sets bounce1,bounce2 --threads 1 --repeat 9\n"
      "  boxwood bench bunny.obj --rays mine.f32");
  command->callback([arguments] { bench_command(*arguments); });
}

}  // namespace boxwood::app
