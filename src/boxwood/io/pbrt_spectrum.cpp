#include "boxwood/io/pbrt_spectrum.h"

#include <array>

#include "boxwood/io/color.h"
#include "boxwood/io/file_bytes.h"

namespace boxwood::io::pbrt {
namespace {

// Measured optical constants (as collected in Palik, "Handbook of Optical Constants of Solids", 1985),
// reduced to RGB.
constexpr std::array kConductors = {
    Conductor{"Cu", {0.2004f, 0.9240f, 1.1022f}, {3.9129f, 2.4528f, 2.1421f}},
    Conductor{"Au", {0.1431f, 0.3749f, 1.4424f}, {3.9831f, 2.3857f, 1.6032f}},
    Conductor{"Ag", {0.1552f, 0.1167f, 0.1383f}, {4.8283f, 3.1222f, 2.1470f}},
    Conductor{"Al", {1.6574f, 0.8803f, 0.5212f}, {9.2238f, 6.2695f, 4.8370f}},
    Conductor{"CuZn", {0.4440f, 0.5270f, 1.0940f}, {3.6950f, 2.7650f, 1.8290f}},
};

struct Glass {
  std::string_view name;
  float eta;
};
// Indices of refraction at the yellow d line, from the makers' catalogues.
constexpr std::array kGlasses = {
    Glass{"glass-BK7", 1.5168f},   Glass{"glass-BAF10", 1.6700f}, Glass{"glass-FK51A", 1.4866f},
    Glass{"glass-LASF9", 1.8503f}, Glass{"glass-SF5", 1.6727f},   Glass{"glass-SF10", 1.7283f},
    Glass{"glass-SF11", 1.7847f},  Glass{"glass-F10", 1.6234f},
};

/// The spectra that version 4 of the format knows by name.
std::optional<Vec3> named_spectrum(std::string_view name) {
  for (const Conductor& metal : kConductors) {
    const std::string prefix = "metal-" + std::string(metal.name);
    if (name == prefix + "-eta") return metal.eta;
    if (name == prefix + "-k") return metal.k;
  }
  for (const Glass& glass : kGlasses)
    if (name == glass.name) return splat(glass.eta);
  if (name == "stdillum-D65" || name == "illum-acesD60") return Vec3{1, 1, 1};
  if (name == "stdillum-A") return rgb_of_blackbody(2856);
  return std::nullopt;
}

Vec3 color_of_samples(const std::vector<double>& numbers, const Place& place) {
  std::vector<SpectrumSample> samples(numbers.size() / 2);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = {numbers[2 * i], numbers[2 * i + 1]};
    if (i > 0 && !(samples[i].wavelength > samples[i - 1].wavelength))
      fail(place, "the spectrum's sample " + std::to_string(i) + " is at " +
                      std::to_string(samples[i].wavelength) + " nm, expected wavelengths that rise");
  }
  return rgb_of_spectrum(samples);
}

/// A file of pairs of wavelength and value, with comments as in scenes.
Vec3 read_spectrum(const std::filesystem::path& path) {
  const std::string name = path.string();
  Tokenizer tokenizer(name, read_file(path));
  std::vector<double> numbers;
  Token token = tokenizer.next();
  for (; token.kind != Token::Kind::end; token = tokenizer.next())
    numbers.push_back(number_of(tokenizer, token));
  if (numbers.size() % 2 != 0)
    fail(tokenizer.place(token), "the file ends after a wavelength, expected its value");
  return color_of_samples(numbers, tokenizer.place(token));
}

}  // namespace

const Conductor& default_conductor() {
  return kConductors[0];
}

std::optional<Vec3> color_of(const Parameter& parameter, const Parser& parser, Warnings& warnings) {
  const std::vector<double>& n = parameter.numbers;
  const auto expect_count = [&](bool is_right, const char* expected) {
    if (!is_right)
      fail(parameter.place, in_quotes(parameter.name) + " has " +
                                std::to_string(n.size() + parameter.strings.size()) + " values, expected " +
                                expected);
  };
  if (parameter.type == "float") {
    expect_count(n.size() == 1, "1");
    return splat(float(n[0]));
  }
  if (parameter.type == "rgb" || parameter.type == "color" || parameter.type == "xyz") {
    expect_count(n.size() == 3, "3");
    const Vec3 color{float(n[0]), float(n[1]), float(n[2])};
    return parameter.type == "xyz" ? rgb_of_xyz(color) : color;
  }
  if (parameter.type == "blackbody") {
    expect_count(n.size() == 1 || n.size() == 2, "a temperature, or a temperature and a factor");
    if (!(n[0] > 0))
      fail(parameter.place, in_quotes(parameter.name) + " is a temperature of " + std::to_string(n[0]) +
                                " K, expected more than 0");
    return rgb_of_blackbody(n[0]) * (n.size() == 2 ? float(n[1]) : 1.0f);
  }
  if (parameter.type != "spectrum")
    fail(parameter.place,
         in_quotes(parameter.name) + " is of type " + in_quotes(parameter.type) + ", expected a color");

  // A spectrum: samples, a name, or a file.
  if (!n.empty()) return color_of_samples(n, parameter.place);
  expect_count(parameter.strings.size() == 1, "samples, a name or a file");
  if (const auto known = named_spectrum(parameter.strings[0])) return known;
  try {
    return read_spectrum(parser.resolve(parameter.strings[0]));
  } catch (const FileError& error) {
    warnings.once(parameter.place, "the spectrum " + in_quotes(parameter.strings[0]) +
                                       " is neither known by name nor readable as a file (" + error.what() +
                                       "); the default stands in");
    return std::nullopt;
  }
}

Vec3 color_of(const ParameterList& parameters, std::string_view name, Vec3 otherwise, const Parser& parser,
              Warnings& warnings) {
  const Parameter* parameter = parameters.find(name);
  if (parameter == nullptr) return otherwise;
  return color_of(*parameter, parser, warnings).value_or(otherwise);
}

}  // namespace boxwood::io::pbrt
