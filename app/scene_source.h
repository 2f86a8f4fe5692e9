// scene_source.h: where does the scene that a user names come from, and how is it built?
#pragma once

#include <string>

#include "boxwood/build/options.h"
#include "boxwood/core/parallel.h"
#include "boxwood/scene/description.h"

namespace boxwood::app {

/// A scene that the program makes itself when the part before a colon is the name of one ("spheres:1000"),
/// else a file. Throws std::invalid_argument or FileError; for a file that is not there the message also
/// lists the names.
SceneDesc open_scene(const std::string& name_or_path, Executor& executor);

/// Throws FileError as open_scene does when there is neither such a file nor such a name. Costs nothing, so
/// that of many scenes a wrong one is found before the first is worked on.
void check_scene_exists(const std::string& name_or_path);

/// The preset by its name, "fast", "balanced" or "best"; anything else is balanced.
BuildOptions build_options(const std::string& preset);

/// Prints the warnings of the scene on stderr, a line each; of very many only the first.
void print_warnings(const SceneDesc& desc);

/// For help texts: a line for each scene that the program makes itself.
std::string gallery_help();

}  // namespace boxwood::app
