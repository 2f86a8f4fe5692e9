#include "picture_file.h"

#include <filesystem>

#include <unistd.h>

#include "boxwood/core/error.h"
#include "boxwood/io/image.h"

namespace boxwood::app {

void add_exposure_options(CLI::App& command, PictureLook& look) {
  command
      .add_option("--exposure", look.exposure_stops,
                  "Stops by which 8-bit pictures are lighter (1\ndoubles light) or darker (-1 halves it)")
      ->capture_default_str()
      ->check(CLI::Range(-100.0, 100.0).description(""));
  command
      .add_option("--tone", look.tone,
                  "How they show what is too bright for them: linear\n(white), reinhard, filmic")
      ->capture_default_str()
      ->check(CLI::IsMember({"linear", "reinhard", "filmic"}).description(""));
}

void add_look_options(CLI::App& command, PictureLook& look) {
  add_exposure_options(command, look);
  command.add_flag("--half", look.is_half, "Light and colors of an .exr in 16 bits, not 32");
}

std::string picture_ending_problem(const std::string& path) {
  const std::string ending = io::lower_extension(path);
  const bool is_known = ending == ".png" || ending == ".exr" || ending == ".hdr";
  return is_known ? std::string() : path + " does not end in .png, .exr or .hdr";
}

void write_picture(const std::string& path, const Image& image, render::Mode mode, const PictureLook& look,
                   io::Lasting lasting) {
  const std::string ending = io::lower_extension(path);
  if (ending == ".exr") return io::write_image(path, image, {.is_half = look.is_half}, lasting);
  Image picture = render::displayable(image, mode);
  if (ending == ".png") {
    if (mode == render::Mode::path)
      picture =
          render::toned(picture, static_cast<float>(look.exposure_stops), render::tone_from_name(look.tone));
    return io::write_image(path, picture, {}, lasting);
  }
  // Radiance .hdr files have three channels.
  if (picture.channels == 3) return io::write_image(path, picture, {}, lasting);
  Image grey(picture.width, picture.height, 3);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) grey.pixels[3 * i + c] = picture.pixels[i];
  io::write_image(path, grey, {}, lasting);
}

void write_here_or_in_temp(const std::string& path,
                           const std::function<void(const std::string& path)>& write) {
  std::string problem;
  try {
    return write(path);
  } catch (const FileError& error) {
    problem = error.what();
  }
  const std::filesystem::path name = std::filesystem::path(path).filename();
  std::string other;
  try {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("boxwood-" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    other = (folder / name).string();
    write(other);
  } catch (const std::exception& error) {
    std::error_code ignored;
    if (!other.empty()) std::filesystem::remove(std::filesystem::path(other).parent_path(), ignored);
    throw std::runtime_error(problem + "; nor can " + error.what());
  }
  throw std::runtime_error(problem + "; the picture is in " + other + " instead");
}

}  // namespace boxwood::app
