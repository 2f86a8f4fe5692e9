// color.h: what color does a spectrum, a glow or a picture amount to?
//
// Scene files describe light in more ways than the renderer's linear RGB (Rec. 709 primaries). These
// functions reduce each of them to three numbers, by way of the CIE 1931 observer: Wyman, Sloan and Shirley,
// "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2013.
#pragma once

#include <span>

#include "boxwood/scene/description.h"

namespace boxwood::io {

/// A spectrum's value at a wavelength in nanometers.
struct SpectrumSample {
  double wavelength, value;
};

Vec3 rgb_of_xyz(Vec3 xyz);

/// The color of a reflectance (or of an index of refraction), linear between samples of rising wavelength,
/// constant beyond them. A constant spectrum of value s gives {s, s, s}.
Vec3 rgb_of_spectrum(std::span<const SpectrumSample> samples);

/// The color of a black body, scaled to luminance 1. Precondition: kelvin > 0.
Vec3 rgb_of_blackbody(double kelvin);

/// The share of light that a conductor with complex index
/// of refraction eta + ik reflects at normal incidence.
Vec3 conductor_reflectance(Vec3 eta, Vec3 k);

/// The mean of a texture's pixels, in linear light, alpha left out.
Vec3 average_color(const Texture& texture);

}  // namespace boxwood::io
