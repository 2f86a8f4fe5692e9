// vertex_colors.h: how do files of bare geometry say which color a vertex has, and what is to be seen of it?
#pragma once

#include "boxwood/scene/description.h"
#include "boxwood/scene/srgb.h"

namespace boxwood::io {

/// Linear light of codes in [0, 1] as sRGB has them; what is no such number counts as the nearest one.
inline std::array<float, 4> vertex_color_of_srgb(float red, float green, float blue) {
  const auto light = [](float code) { return code > 0 ? linear_from_srgb(code < 1 ? code : 1) : 0.0f; };
  return {light(red), light(green), light(blue), 1};
}

/// Multiplies what each material shows by the colors of vertices, and gives geometries of no material a white
/// one.
void show_vertex_colors(SceneDesc& desc);

}  // namespace boxwood::io
