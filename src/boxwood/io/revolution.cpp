#include "boxwood/io/revolution.h"

#include <algorithm>
#include <cmath>

namespace boxwood::io {

TriangleMesh revolve(const std::function<ProfilePoint(float v)>& profile, float phi_max, int steps) {
  const int turns = std::max(3, static_cast<int>(std::ceil(64 * phi_max / 6.2831853f)));
  TriangleMesh mesh;
  for (int i = 0; i <= steps; ++i) {
    const float v = static_cast<float>(i) / static_cast<float>(steps);
    const ProfilePoint p = profile(v);
    for (int j = 0; j <= turns; ++j) {
      const float u = static_cast<float>(j) / static_cast<float>(turns);
      const float c = std::cos(u * phi_max), s = std::sin(u * phi_max);
      mesh.positions.push_back({p.radius * c, p.radius * s, p.height});
      mesh.normals.push_back(normalize(Vec3{p.normal_radius * c, p.normal_radius * s, p.normal_height}));
      mesh.uvs.push_back({u, v});
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (turns + 1) + j); };
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < turns; ++j) {
      // Two triangles, wound so that the normal points outwards: along the turn, then up the profile.
      mesh.indices.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.indices.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return mesh;
}

}  // namespace boxwood::io
