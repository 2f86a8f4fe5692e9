// cmd_merge.cpp: boxwood merge, one picture from the shards of a farm.
#include <memory>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "boxwood/io/image.h"
#include "boxwood/render/shard.h"
#include "commands.h"
#include "console.h"
#include "output_file.h"
#include "picture_file.h"

namespace boxwood::app {
namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  std::vector<std::string> outputs{"picture.png"};
  PictureLook look;
  bool is_quiet = false;
};

void merge_command(const MergeArguments& arguments) {
  for (const std::string& output : arguments.outputs) check_writable(output);
  render::ShardMerger merger;
  for (const std::string& path : arguments.shards) {
    const io::ExrFile file = io::read_exr(path);
    if (file.note.empty() || file.word_names.empty())
      throw FileError(path, "", "is not a shard; boxwood render --shard makes them");
    try {
      if (file.word_names != render::word_names(file.word_names.size()))
        throw std::runtime_error("is not a shard of this version");
      merger.add(path, render::facts_from(file.note), file.image, file.words);
    } catch (const std::runtime_error& error) {
      throw FileError(path, "", error.what());
    }
  }
  const Image image = merger.merged();
  for (const std::string& output : arguments.outputs) {
    write_here_or_in_temp(
        output, [&](const std::string& path) { write_picture(path, image, merger.mode(), arguments.look); });
    if (!arguments.is_quiet)
      print_error("wrote {}: {}x{}, {} shards\n", output, image.width, image.height, arguments.shards.size());
  }
}

}  // namespace

void add_merge(CLI::App& program) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command = program.add_subcommand("merge", "Make one picture from shards");
  command
      ->add_option("SHARDS", arguments->shards,
                   "The .exr files that boxwood render --shard made,\nin any order")
      ->required();
  command
      ->add_option("-o,--output", arguments->outputs,
                   "The picture: .png; .exr or .hdr keep all light.\nMay be given more than once")
      ->default_str("picture.png")
      ->allow_extra_args(false)
      ->check(picture_ending_problem);
  add_look_options(*command, arguments->look);
  command->add_flag("--quiet", arguments->is_quiet, "Only errors");
  command->footer(
      "\nThe picture has the bits that one machine alone would have made.\n"
      "\nExample:\n"
      "  boxwood render cornell -o part1.exr --shard 1/2\n"
      "  boxwood render cornell -o part2.exr --shard 2/2\n"
      "  boxwood merge part1.exr part2.exr -o cornell.exr");
  command->callback([arguments] { merge_command(*arguments); });
}

}  // namespace boxwood::app
