// svg.h: what do all charts of this program have in common? White paper, a title, and the styles of what is
// drawn on it.
#pragma once

#include <string>

namespace boxwood::app {

/// `text` as it may stand between tags.
std::string escaped(const std::string& text);

/// The head of an SVG file, in pixels, with the title and a line below it. End the file with "</svg>\n".
std::string svg_begin(double width, double height, const std::string& title, const std::string& subtitle);

}  // namespace boxwood::app
