// cmd_ladder.cpp: boxwood ladder, from brute force to the fastest kernel, measured.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "boxwood/io/file_bytes.h"
#include "commands.h"
#include "interrupt.h"
#include "ladder.h"
#include "ladder_report.h"
#include "output_file.h"
#include "progress_bar.h"
#include "scene_source.h"

namespace boxwood::app {
namespace {

struct LadderArguments {
  std::string scene = "soup:100000";
  std::string json, plot;
  std::size_t rays = LadderOptions{}.rays;
  bool is_quiet = false;
};

void ladder_command(const LadderArguments& arguments) {
  // Find out what cannot be written before any work is done.
  for (const std::string& path : {arguments.json, arguments.plot})
    if (!path.empty()) check_writable(path);

  catch_interrupts();
  ProgressBar bar(arguments.is_quiet);
  bar.update("reading", 0);
  const SceneDesc scene = open_scene(arguments.scene, default_executor());
  bar.clear();
  print_warnings(scene);

  const LadderReport report =
      climb(arguments.scene, scene, {.rays = arguments.rays}, [&](std::string_view stage, double done) {
        bar.update(stage, done);
        return !is_interrupted();
      });
  bar.clear();

  if (!arguments.json.empty()) io::write_file(arguments.json, ladder_json(report));
  if (!arguments.plot.empty()) io::write_file(arguments.plot, ladder_chart(report));
  fmt::print("{}", ladder_table(report));
}

}  // namespace

void add_ladder(CLI::App& program) {
  const auto arguments = std::make_shared<LadderArguments>();
  CLI::App* command = program.add_subcommand("ladder", "From brute force to the fastest kernel, measured");
  command
      ->add_option("SCENE", arguments->scene,
                   "A file (.obj .ply .stl .gltf .glb .pbrt) or a\n"
                   "scene that the program makes itself, see below")
      ->capture_default_str();
  command->add_option("--json", arguments->json, "Write the numbers to this file");
  command->add_option("--plot", arguments->plot, "Draw the growth of work and time as SVG");
  command->add_option("--rays", arguments->rays, "How many rays the scene is asked with")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000'000).description(""));
  command->add_flag("--quiet", arguments->is_quiet, "No progress; the table, warnings and errors");
  command->footer(
      "Every rung answers the same rays, on one thread, and is compared with brute\n"
      "force to the bit. Then all are climbed again over 100 to 8,000,000 primitives,\n"
      "as far as a rung can, and over the worst case. Takes a minute or two.\n\n" +
      gallery_help() +
      "\nExamples:\n"
      "  boxwood ladder\n"
      "  boxwood ladder bunny.obj --json ladder.json --plot ladder.svg\n"
      "  boxwood ladder spheres:20000 --rays 10000");
  command->callback([arguments] { ladder_command(*arguments); });
}

}  // namespace boxwood::app
