// tone.h: how does light without limits fit into an 8-bit picture?
//
// Files that hold light (.exr, .hdr) never go through here.
#pragma once

#include <string_view>

#include "boxwood/scene/image.h"

namespace boxwood::render {

enum class Tone {
  linear,    ///< As it is: what is brighter than 1 is white.
  reinhard,  ///< Brightness L becomes L (1 + L / 16) / (1 + L): colors keep their hue, 4 becomes white.
  filmic,    ///< Each channel by a curve like film's: deeper shadows, highlights that fade to white.
};

/// The picture (one or three channels of light) times 2^`exposure_stops`, then by the curve.
Image toned(const Image& light, float exposure_stops, Tone tone);

/// "linear", "reinhard", "filmic"; and back. Throws std::invalid_argument for a name that is not one of them.
std::string_view tone_name(Tone tone);
Tone tone_from_name(std::string_view name);

}  // namespace boxwood::render
