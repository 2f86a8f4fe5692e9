// picture_file.h: how does a picture look as a file, and what if there is no room for it?
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "boxwood/io/file_bytes.h"
#include "boxwood/render/render.h"
#include "boxwood/render/tone.h"

namespace boxwood::app {

/// How files show a picture: the first two for 8 bits only, the last for .exr only.
struct PictureLook {
  double exposure_stops = 0;
  std::string tone = "linear";
  bool is_half = false;
};

/// Adds --exposure and --tone to `command`; or these and --half.
void add_exposure_options(CLI::App& command, PictureLook& look);
void add_look_options(CLI::App& command, PictureLook& look);

/// A check of CLI11: the name must end in .png, .exr or .hdr.
std::string picture_ending_problem(const std::string& path);

/// Writes what the file can hold: EXR keeps all numbers as they are, HDR the light, PNG what an eye can see.
/// Throws FileError.
void write_picture(const std::string& path, const Image& image, render::Mode mode, const PictureLook& look,
                   io::Lasting lasting = io::Lasting::yes);

/// As `write`, which is to make the file `path`, but when that fails, puts the file into the folder for
/// temporary files, and throws a FileError that says where it is.
void write_here_or_in_temp(const std::string& path,
                           const std::function<void(const std::string& path)>& write);

}  // namespace boxwood::app
