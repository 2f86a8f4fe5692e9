// sheen.h: how does cloth shine at grazing angles?
//
// Fibres stand up from the surface: their normals crowd around the horizon. Estevez and Kulla, "Production
// Friendly Microfacet Sheen BRDF", SIGGRAPH courses 2017, with the simple masking of Neubelt and Pettineo
// that glTF's extension allows.
#pragma once

#include "boxwood/render/warp.h"

namespace boxwood::render {

/// The BRDF times the cosine of `incoming`, both directions above the surface. `alpha` is above 0.
inline float sheen_lobe(float alpha, Vec3 outgoing, Vec3 incoming) {
  const Vec3 half = normalize(outgoing + incoming);
  const float sine = std::sqrt(max(0.0f, 1 - half.z * half.z)), inverse = 1 / alpha;
  const float density = (2 + inverse) * std::pow(sine, inverse) / (2 * kPi);
  return density / (4 * (incoming.z + outgoing.z - incoming.z * outgoing.z)) * incoming.z;
}

}  // namespace boxwood::render
