// cmd_diff.cpp: boxwood diff, how far two pictures are apart.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "boxwood/core/error.h"
#include "boxwood/io/image.h"
#include "boxwood/render/compare.h"
#include "boxwood/render/false_color.h"
#include "boxwood/render/flip.h"
#include "boxwood/render/tone.h"
#include "commands.h"
#include "console.h"
#include "output_file.h"
#include "picture_file.h"

namespace boxwood::app {
namespace {

struct DiffArguments {
  std::string picture, reference, output;
  PictureLook look;
};

/// The channels that are compared: R, G, B where the file has them, else the only one.
Image read_colors(const std::string& path) {
  const Image image = io::read_image(path);
  const auto channel = [&image](const std::string& name) {
    const auto found = std::find(image.channel_names.begin(), image.channel_names.end(), name);
    return found - image.channel_names.begin();
  };
  std::vector<std::ptrdiff_t> channels{channel("R"), channel("G"), channel("B")};
  const bool has_colors = *std::max_element(channels.begin(), channels.end()) < image.channels;
  if (!has_colors && image.channels > 2) {
    std::string names;
    for (const std::string& name : image.channel_names) names += (names.empty() ? "" : ", ") + name;
    throw FileError(path, "", "has the channels " + names + ", expected R, G and B");
  }
  if (!has_colors) channels = {0};

  Image colors(image.width, image.height, static_cast<int>(channels.size()));
  std::size_t bad = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t c = 0; c < channels.size(); ++c) {
        const float value = image.at(x, y)[channels[c]];
        bad += std::isfinite(value) ? 0 : 1;
        colors.at(x, y)[c] = std::isfinite(value) ? value : 0;
      }
  if (bad > 0) print_error("boxwood: warning: {}: {} numbers are not finite and count as 0\n", path, bad);
  return colors;
}

/// Three channels for FLIP.
Image as_color(const Image& image) {
  if (image.channels == 3) return image;
  Image color(image.width, image.height, 3);
  for (std::size_t i = 0; i < color.pixels.size(); ++i) color.pixels[i] = image.pixels[i / 3];
  return color;
}

void diff_command(const DiffArguments& arguments) {
  if (!arguments.output.empty()) check_writable(arguments.output);
  const Image picture = read_colors(arguments.picture), reference = read_colors(arguments.reference);
  try {
    render::check_same_shape(picture, reference);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(arguments.picture + ", " + arguments.reference + ": " + error.what());
  }

  // Light as it is, then as a screen shows it.
  const auto shown = [&](const Image& light) {
    return render::toned(light, static_cast<float>(arguments.look.exposure_stops),
                         render::tone_from_name(arguments.look.tone));
  };
  const Image shown_picture = shown(picture), shown_reference = shown(reference);
  const Image codes = render::screen_codes(shown_picture),
              reference_codes = render::screen_codes(shown_reference);
  const Image flip = render::flip_map(as_color(shown_picture), as_color(shown_reference));
  const std::optional<double> ssim = render::ssim(codes, reference_codes);

  fmt::print("relative MSE  {:.6g}\n", render::relative_mse(picture, reference));
  fmt::print("PSNR          {:.2f} dB\n", render::psnr_db(codes, reference_codes));
  fmt::print("SSIM          {}\n", ssim ? fmt::format("{:.5f}", *ssim) : "(needs 11x11 pixels)");
  fmt::print("FLIP          {:.5f}\n", render::mean_of(flip));
  if (picture.pixels == reference.pixels) fmt::print("the same picture, number for number\n");

  if (arguments.output.empty()) return;
  Image map(flip.width, flip.height, 3);
  for (std::size_t i = 0; i < flip.pixels.size(); ++i) {
    const Vec3 color = render::false_color(flip.pixels[i]);
    for (int c = 0; c < 3; ++c) map.pixels[3 * i + static_cast<std::size_t>(c)] = color[c];
  }
  io::write_image(arguments.output, map);
}

}  // namespace

void add_diff(CLI::App& program) {
  auto arguments = std::make_shared<DiffArguments>();
  CLI::App* command = program.add_subcommand("diff", "Compare two pictures");
  command->add_option("PICTURE", arguments->picture, "Any picture: .png .exr .hdr .jpg ...")->required();
  command->add_option("REFERENCE", arguments->reference, "The one that it should be like")->required();
  command
      ->add_option(
          "-o,--output", arguments->output,
          "A picture of the differences that an eye would\nnotice: black none, red, yellow (FLIP, 0 to 1)")
      ->check(picture_ending_problem);
  add_exposure_options(*command, arguments->look);
  command->footer(
      "\nrelative MSE compares light: the mean of (a - b)^2 / (b^2 + 0.01). The others\n"
      "compare what a screen shows, after --exposure and --tone: PSNR (higher is\n"
      "better), SSIM (1 is the same), FLIP (0 is the same).\n"
      "\nExample:\n"
      "  boxwood diff kitchen.exr reference.exr -o difference.png");
  command->callback([arguments] { diff_command(*arguments); });
}

}  // namespace boxwood::app
