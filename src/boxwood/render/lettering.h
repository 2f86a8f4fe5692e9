// lettering.h: how do a few words get into a picture? By a font of 5 x 7 dots.
#pragma once

#include <string_view>

#include "boxwood/core/vec.h"
#include "boxwood/scene/image.h"

namespace boxwood::render {

inline constexpr int kGlyphWidth = 6;  ///< In dots, with the gap behind it.
inline constexpr int kGlyphHeight = 7;

/// Draws `text` with its upper left corner at (x, y), each dot `scale` pixels wide. The font has digits,
/// capitals, space and . , : + - / ( ); small letters appear as capitals, anything else as a blank. What
/// falls outside is cut off.
void draw_text(Image& image, int x, int y, int scale, std::string_view text, Vec3 color);

/// Fills the rectangle [x0, x1) x [y0, y1), mixed with what is there by `opacity`.
/// What falls outside is cut off.
void fill_rectangle(Image& image, int x0, int y0, int x1, int y1, Vec3 color, float opacity = 1);

}  // namespace boxwood::render
