#include "boxwood/io/color.h"

#include <array>
#include <cmath>

#include "boxwood/scene/srgb.h"

namespace boxwood::io {
namespace {

constexpr double kFirstWavelength = 380, kLastWavelength = 780, kStep = 5;

/// A bell with different widths on its two sides.
double lobe(double wavelength, double center, double left, double right) {
  const double t = (wavelength - center) / (wavelength < center ? left : right);
  return std::exp(-0.5 * t * t);
}

struct Xyz {
  double x = 0, y = 0, z = 0;
};

/// The observer's response, the multi-lobe fit of Wyman et al., section 2.2.
Xyz observer(double w) {
  return {1.056 * lobe(w, 599.8, 37.9, 31.0) + 0.362 * lobe(w, 442.0, 16.0, 26.7) -
              0.065 * lobe(w, 501.1, 20.4, 26.2),
          0.821 * lobe(w, 568.8, 46.9, 40.5) + 0.286 * lobe(w, 530.9, 16.3, 31.1),
          1.217 * lobe(w, 437.0, 11.8, 36.0) + 0.681 * lobe(w, 459.0, 26.0, 13.8)};
}

/// What the observer sees of `spectrum`; a constant 1 has y = 1.
template <class Spectrum>
Xyz integrate(const Spectrum& spectrum) {
  Xyz sum;
  double whole = 0;
  for (double w = kFirstWavelength; w <= kLastWavelength; w += kStep) {
    const Xyz response = observer(w);
    const double value = spectrum(w);
    sum.x += response.x * value;
    sum.y += response.y * value;
    sum.z += response.z * value;
    whole += response.y;
  }
  return {sum.x / whole, sum.y / whole, sum.z / whole};
}

/// Colors outside of what RGB can show are moved to its border.
Vec3 clamp_negative(Vec3 rgb) {
  return max(rgb, Vec3{0, 0, 0});
}

}  // namespace

Vec3 rgb_of_xyz(Vec3 xyz) {  // IEC 61966-2-1, white point D65
  return {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
          -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
          0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
}

Vec3 rgb_of_spectrum(std::span<const SpectrumSample> samples) {
  if (samples.empty()) return {0, 0, 0};
  const auto value_at = [&](double wavelength) {
    if (wavelength <= samples.front().wavelength) return samples.front().value;
    for (std::size_t i = 1; i < samples.size(); ++i)
      if (wavelength < samples[i].wavelength) {
        const SpectrumSample a = samples[i - 1], b = samples[i];
        return a.value + (b.value - a.value) * (wavelength - a.wavelength) / (b.wavelength - a.wavelength);
      }
    return samples.back().value;
  };
  const auto rgb = [](const Xyz& xyz) { return rgb_of_xyz({float(xyz.x), float(xyz.y), float(xyz.z)}); };

  // An equal spectrum is not quite white for D65; divided by its color it is.
  return clamp_negative(rgb(integrate(value_at)) / rgb(integrate([](double) { return 1.0; })));
}

Vec3 rgb_of_blackbody(double kelvin) {
  // Planck's law up to a factor, relative to the middle of the spectrum so that no temperature overflows.
  constexpr double kSecondRadiation = 1.438776877e7, kMiddle = 560;  // nm K, nm
  const auto radiance = [&](double w) {
    const double exponent = std::fmin(kSecondRadiation / (w * kelvin), 600);
    return std::pow(kMiddle / w, 5) / std::expm1(exponent);
  };
  const Xyz xyz = integrate(radiance);
  return clamp_negative(rgb_of_xyz({float(xyz.x / xyz.y), 1, float(xyz.z / xyz.y)}));
}

Vec3 conductor_reflectance(Vec3 eta, Vec3 k) {
  Vec3 out;
  for (int c = 0; c < 3; ++c) {
    const double n = eta[c], k2 = double(k[c]) * k[c];
    const double above = (n - 1) * (n - 1) + k2, below = (n + 1) * (n + 1) + k2;
    out[c] = below > 0 ? static_cast<float>(above / below) : 1.0f;
  }
  return out;
}

Vec3 average_color(const Texture& texture) {
  if (texture.texels.empty()) return {0, 0, 0};
  std::array<double, 256> linear;
  for (int i = 0; i < 256; ++i) {
    const float code = static_cast<float>(i) / 255;
    linear[i] = texture.is_srgb ? linear_from_srgb(code) : code;
  }
  double sum[3] = {0, 0, 0};
  for (const auto& texel : texture.texels)
    for (int c = 0; c < 3; ++c) sum[c] += linear[texel[c]];
  const double count = static_cast<double>(texture.texels.size());
  return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

}  // namespace boxwood::io
