// main.cpp: where does the program start, and how does it end?
//
// Exit codes: 0 done, 1 failed, 2 wrong usage.
// Whatever goes wrong is one line on stderr that starts with "boxwood: ".
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>

#include "boxwood/core/error.h"
#include "commands.h"
#include "console.h"
#include "output_file.h"

namespace {

constexpr int kFailed = 1, kWrongUsage = 2;

/// Messages of libraries may have line breaks; ours are one line. Who is not heard did not fail either: else
/// mpirun might end rank 0 before it has said what is wrong.
int complain(std::string message, int exit_code) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  for (char& c : message)
    if (c == '\n' || c == '\r') c = ' ';
  boxwood::app::print_error("boxwood: {}\n", message);
  return boxwood::app::is_heard() ? exit_code : 0;
}

/// The first argument when it names no command, for a message that says so; else empty.
std::string unknown_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return "";
  const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* command : commands)
    if (command->get_name() == argv[1]) return "";
  return argv[1];
}

/// Does what was asked. --help and --version come as exceptions, and what they print is output too.
void run(CLI::App& program, int argc, char** argv) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    std::ostringstream text;
    program.exit(asked, text);
    std::fputs(text.str().c_str(), stdout);
  }
  boxwood::app::check_output_arrived();
}

}  // namespace

int main(int argc, char** argv) {
  boxwood::app::open_closed_streams();
  boxwood::app::survive_size_limits();
  CLI::App program{
      "Boxwood ray traces scenes through bounding volume hierarchies,\n"
      "and shows what that saves."};
  program.name("boxwood");
  program.set_version_flag("--version", "boxwood " BOXWOOD_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Examples:\n"
      "  boxwood render -o picture.png           a picture of the program's own scene\n"
      "  boxwood render bunny.obj -o bunny.png   a picture of a file\n"
      "  boxwood merge part*.exr -o all.exr      one picture from the shards of a farm\n"
      "  boxwood diff a.exr b.exr                how far two pictures are apart\n"
      "  boxwood info bunny.obj                  what is in it, what its tree is like\n"
      "  boxwood ladder                          from brute force to the best tree\n"
      "  boxwood bench bunny.obj                 how fast it is, beside Embree\n"
      "'boxwood COMMAND --help' tells more.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage.");
  boxwood::app::add_render(program);
  boxwood::app::add_merge(program);
  boxwood::app::add_diff(program);
  boxwood::app::add_info(program);
  boxwood::app::add_ladder(program);
  boxwood::app::add_bench(program);

  if (const std::string name = unknown_command(program, argc, argv); !name.empty())
    return complain("there is no command '" + name + "' (see boxwood --help)", kWrongUsage);

  try {
    run(program, argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return complain(std::string(error.what()) + " (see boxwood --help)", kWrongUsage);
  } catch (const boxwood::Cancelled&) {
    return complain("stopped; nothing was written", kFailed);
  } catch (const std::bad_alloc&) {
    return complain("there is not enough memory for this", kFailed);
  } catch (const std::exception& error) {
    return complain(error.what(), kFailed);
  }
}
