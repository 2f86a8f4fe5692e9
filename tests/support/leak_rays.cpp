#include "support/leak_rays.h"

namespace boxwood::test {

const std::vector<Body>& bodies() {
  static const std::vector<Body> all{
      {"icosphere, 320", icosphere(2), {0, 0, 0}, 0.5f},
      {"icosphere, 20480", icosphere(5), {0, 0, 0}, 0.5f},
      {"torus", torus(64, 32), {1, 0, 0}, 0.2f},
      {"cube", cube(1), {0, 0, 0}, 0.5f},
      {"cube of 12 * 64", cube(8), {0, 0, 0}, 0.5f},
      {"sponge", sponge(3), {-26.0f / 27, -26.0f / 27, -26.0f / 27}, 0.01f},
      {"rough sphere", rough_sphere(5), {0, 0, 0}, 0.2f},
  };
  return all;
}

namespace {

/// A vertex, the middle of an edge or a point on it; now and then a point of a face.
Vec3 target(const Mesh& mesh, Random& random) {
  const auto& face = mesh.indices[random.below(static_cast<std::uint32_t>(mesh.indices.size()))];
  const Vec3 a = mesh.positions[face[0]], b = mesh.positions[face[1]], c = mesh.positions[face[2]];
  switch (random.below(8)) {
    case 0:
    case 1:
    case 2:
      return a;
    case 3:
    case 4:
      return a * 0.5f + b * 0.5f;
    case 5:
    case 6:
      return a + (b - a) * random.uniform();
    default:
      return a + ((b - a) * random.uniform() + (c - a) * random.uniform()) * 0.5f;
  }
}

}  // namespace

AimedRay aim(const Mesh& mesh, Vec3 inside, float clearance, float size, Random& random) {
  const Vec3 to = target(mesh, random);
  const Vec3 near_inside = inside + random.in_box(splat(-1), splat(1)) * (clearance * 0.57f);
  switch (random.below(4)) {
    case 0:
    case 1:
      return {{near_inside, 0, to - near_inside, kInfinity}, true, true};
    case 2: {
      // From outside, through the target, to the ball inside.
      const Vec3 from = inside + normalize((to - inside) * (1 / size)) * (size * random.uniform(4, 20));
      return {{from, 0, to - from, kInfinity}, false, true};
    }
    default: {
      // From outside past the target, along an axis or not: the target may be on the silhouette.
      Vec3 way = random.direction();
      if (random.below(2)) {
        way = {0, 0, 0};
        way[static_cast<int>(random.below(3))] = random.below(2) ? 1.0f : -1.0f;
      }
      return {{to - way * (size * 4), 0, way, kInfinity}, false, false};
    }
  }
}

int crossing_sign(const RayShear& ray, const Triangle& triangle) {
  const auto project = [&](Vec3 p) {
    const Vec3 t = p - ray.origin;
    return detail::Point2{t[ray.axis_x] - ray.shear_x * t[ray.axis_z],
                          t[ray.axis_y] - ray.shear_y * t[ray.axis_z]};
  };
  const auto a = project(triangle.a), b = project(triangle.b), c = project(triangle.c);
  const auto edge = [](detail::Point2 p, detail::Point2 q) { return double(p.x) * q.y - double(p.y) * q.x; };
  const double area = edge(a, b) + edge(b, c) + edge(c, a);
  return (area > 0) == (ray.shear_z > 0) ? 1 : -1;
}

}  // namespace boxwood::test
