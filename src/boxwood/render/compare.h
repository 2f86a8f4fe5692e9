// compare.h: how far apart are two pictures, in numbers?
//
// Light is compared as light (relative MSE, for noise against a reference), and as a screen shows it (PSNR,
// SSIM; flip.h for what an eye would notice).
#pragma once

#include <optional>

#include "boxwood/scene/image.h"

namespace boxwood::render {

// All of these throw std::invalid_argument when the pictures differ in size or in channels.

/// The mean of (a - b)^2 / (b^2 + 0.01) over pixels and channels, where b is the reference: errors count less
/// where there is much light. Rousselle, Knaus and Zwicker, "Adaptive Sampling and Reconstruction using
/// Greedy Error Minimization", 2011.
double relative_mse(const Image& picture, const Image& reference);

/// What a screen is sent: light in [0, 1], encoded as sRGB.
Image screen_codes(const Image& light);

/// 10 log10(1 / mean squared difference) of codes in [0, 1], in decibels; infinite for equal pictures.
double psnr_db(const Image& picture_codes, const Image& reference_codes);

/// The structural similarity of the luma of codes in [0, 1], 1 for equal pictures: a Gaussian window of 11 x
/// 11 pixels and standard deviation 1.5, averaged over all places where it fits. Nothing for pictures that
/// are smaller. Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error Visibility to
/// Structural Similarity", 2004.
std::optional<double> ssim(const Image& picture_codes, const Image& reference_codes);

/// Throws std::invalid_argument that says what differs.
void check_same_shape(const Image& picture, const Image& reference);

}  // namespace boxwood::render
