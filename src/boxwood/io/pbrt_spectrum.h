// pbrt_spectrum.h: which color does a parameter give?
//
// A color stands in a pbrt file as RGB, XYZ, one number, a black body's temperature, samples by wavelength,
// the name of a spectrum that pbrt knows, or a file of samples. All become linear RGB here.
#pragma once

#include <filesystem>
#include <optional>

#include "boxwood/io/pbrt_parser.h"

namespace boxwood::io::pbrt {

/// The color of `parameter`; none, with a warning, when it is a spectrum that is not known. Throws FileError
/// for values that make no color. Precondition: it is not of type "texture".
std::optional<Vec3> color_of(const Parameter& parameter, const Parser& parser, Warnings& warnings);

/// The color of the parameter `name`, or `otherwise` when it is absent or not known.
Vec3 color_of(const ParameterList& parameters, std::string_view name, Vec3 otherwise, const Parser& parser,
              Warnings& warnings);

/// Complex indices of refraction of a metal, at the wavelengths of red, green and blue.
struct Conductor {
  std::string_view name;
  Vec3 eta, k;
};
/// Copper, which pbrt takes for every metal that does not say what it is.
const Conductor& default_conductor();

}  // namespace boxwood::io::pbrt
