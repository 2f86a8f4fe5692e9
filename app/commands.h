// commands.h: which commands does the program have? One cmd_<name>.cpp each.
#pragma once

#include <CLI/CLI.hpp>

namespace boxwood::app {

/// Each adds its subcommand to `program`; the callback throws on failure, and main turns that into one line
/// and exit code 1.
void add_render(CLI::App& program);
void add_merge(CLI::App& program);
void add_diff(CLI::App& program);
void add_info(CLI::App& program);
void add_ladder(CLI::App& program);
void add_bench(CLI::App& program);

}  // namespace boxwood::app
