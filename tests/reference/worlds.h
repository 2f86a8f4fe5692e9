// worlds.h: over which shapes, and with which rays, are the rivals held to brute force?
#pragma once

#include <string>
#include <vector>

#include "boxwood/core/random.h"
#include "boxwood/core/ray.h"
#include "boxwood/shape/cuboid.h"
#include "boxwood/shape/sphere.h"
#include "boxwood/shape/triangle.h"
#include "support/meshes.h"

namespace boxwood::reference {

/// Rays that are hard for boxes and cells: along axes, in face planes, through corners of `boxes` and of the
/// bounds' halves, quarters and so on, from inside, from outside, from on a plane, with limits; and some that
/// must miss.
inline std::vector<Ray> hard_rays(const std::vector<Box3>& boxes, int count, std::uint64_t seed = 1) {
  Random random(seed);
  Box3 bounds;
  for (const Box3& box : boxes) bounds.extend(box);
  if (bounds.is_empty()) bounds = {{-1, -1, -1}, {1, 1, 1}};
  const Vec3 center = bounds.center(), half = bounds.upper * 0.5f - bounds.lower * 0.5f;
  const float reach = max(max_component(half), 1e-30f);

  const auto point_on_grid = [&] {  // where octrees and grids have their planes
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = bounds.lower[k] + (2 * half[k]) * (float(random.below(17)) / 16);
    return p;
  };
  const auto corner = [&] {
    const Box3& box = boxes.empty() ? bounds : boxes[random.below(std::uint32_t(boxes.size()))];
    return box.is_empty() ? center : box.corner(int(random.below(8)));
  };
  const auto target = [&]() -> Vec3 {
    switch (random.below(3)) {
      case 0:
        return corner();
      case 1:
        return point_on_grid();
      default:
        return random.in_box(bounds.lower, bounds.upper);
    }
  };

  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray;
    const Vec3 to = target();
    const int axis = int(random.below(3));
    switch (random.below(6)) {
      case 0:  // along an axis, from outside, through a corner or a plane
        ray.direction[axis] = random.below(2) ? 1.0f : -1.0f;
        ray.origin = to - ray.direction * (4 * reach);
        break;
      case 1:  // along an axis, from inside
        ray.direction[axis] = random.below(2) ? 1.0f : -1.0f;
        ray.origin = to;
        break;
      case 2:  // inside an axis plane
        ray.direction = random.direction();
        ray.direction[axis] = random.below(2) ? 0.0f : -0.0f;
        ray.origin = to - ray.direction * (random.below(2) ? 3 * reach : 0);
        break;
      case 3:  // diagonal: meets planes of two or three axes at once
        ray.direction = {random.below(2) ? 1.0f : -1.0f, random.below(2) ? 1.0f : -1.0f,
                         float(int(random.below(3)) - 1)};
        ray.origin = to - ray.direction * (random.below(2) ? 2 * reach : 0);
        break;
      case 4:  // from one corner to another
        ray.origin = corner();
        ray.direction = to - ray.origin;
        break;
      default:  // anything
        ray.origin = center + random.direction() * (random.uniform(0, 3) * reach);
        ray.direction = to - ray.origin;
        break;
    }
    if (random.below(4) == 0) ray.t_max = random.uniform(0, 4) * reach;
    if (random.below(4) == 0) ray.t_min = random.uniform(0, 2) * reach;
    rays.push_back(ray);
  }
  rays.push_back({{0, 0, 0}, 0, {0, 0, 0}});
  rays.push_back({center, 0, {std::nanf(""), 1, 0}});
  rays.push_back({center, 2, {1, 0, 0}, 1});
  return rays;
}

template <class Shape>
struct World {
  std::string name;
  std::vector<Shape> shapes;
};

inline std::vector<World<Triangle>> triangle_worlds() {
  std::vector<World<Triangle>> worlds;
  worlds.push_back({"nothing", {}});
  worlds.push_back({"one", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}});
  worlds.push_back({"icosphere", test::triangles(test::icosphere(3))});
  worlds.push_back({"cube of faces in cell planes", test::triangles(test::cube(8))});
  worlds.push_back({"sponge", test::triangles(test::sponge(2))});
  worlds.push_back({"soup", test::triangles(test::triangle_soup(3000))});
  worlds.push_back(
      {"far from the origin", test::triangles(test::placed(test::icosphere(2), 0.01f, {1000, 2000, -3000}))});
  worlds.push_back({"huge", test::triangles(test::placed(test::torus(16, 8), 1e30f, {0, 0, 0}))});
  worlds.push_back({"tiny", test::triangles(test::placed(test::torus(16, 8), 1e-25f, {0, 0, 0}))});
  worlds.push_back({"duplicates", std::vector<Triangle>(300, Triangle{{0, 0, 0}, {1, 0, 0.5f}, {0, 1, 1}})});

  World<Triangle> flat{"flat, in the plane z = 0", test::triangles(test::triangle_soup(800, 3))};
  for (Triangle& t : flat.shapes) t.a.z = t.b.z = t.c.z = 0;
  worlds.push_back(flat);

  World<Triangle> doubled{"each one twice", test::triangles(test::icosphere(2))};
  doubled.shapes.insert(doubled.shapes.end(), doubled.shapes.begin(), doubled.shapes.end());
  worlds.push_back(doubled);

  // A tiny body beside a huge one: all but one cell is empty.
  World<Triangle> stadium{"a teapot in a stadium",
                          test::triangles(test::placed(test::icosphere(3), 0.01f, {3, 1, 2}))};
  const std::vector<Triangle> walls = test::triangles(test::placed(test::cube(), 100, {0, 0, 0}));
  stadium.shapes.insert(stadium.shapes.end(), walls.begin(), walls.end());
  worlds.push_back(stadium);
  return worlds;
}

inline std::vector<World<Sphere>> sphere_worlds() {
  World<Sphere> grid{"spheres that touch on a grid", {}}, nested{"nested spheres", {}},
      some_empty{"some without radius", {}};
  for (int i = 0; i < 512; ++i)
    grid.shapes.push_back({{float(i % 8), float(i / 8 % 8), float(i / 64)}, 0.5f});
  for (int i = 1; i <= 200; ++i) nested.shapes.push_back({{0, 0, 0}, 0.01f * float(i)});
  Random random(7);
  for (int i = 0; i < 600; ++i)
    some_empty.shapes.push_back(
        {random.in_box({-1, -1, -1}, {1, 1, 1}), i % 3 ? 0.1f * random.uniform() : -1.0f});
  return {grid, nested, some_empty, {"all without radius", std::vector<Sphere>(9, Sphere{{1, 2, 3}, 0})}};
}

inline std::vector<World<Cuboid>> cuboid_worlds() {
  World<Cuboid> bricks{"bricks that share faces", {}}, plates{"flat plates", {}},
      sticks{"long thin sticks", {}};
  for (int i = 0; i < 512; ++i) {
    const Vec3 corner{float(i % 8), float(i / 8 % 8), float(i / 64)};
    bricks.shapes.push_back({corner, corner + Vec3{1, 1, 1}});
  }
  Random random(9);
  for (int i = 0; i < 500; ++i) {
    const Vec3 corner = random.in_box({-1, -1, -1}, {1, 1, 1});
    Vec3 size = splat(0.2f * random.uniform());
    size[int(random.below(3))] = 0;
    plates.shapes.push_back({corner, corner + size});
    Vec3 length = splat(0.01f);
    length[int(random.below(3))] = 2;
    sticks.shapes.push_back({corner, corner + length});
  }
  return {bricks, plates, sticks};
}

}  // namespace boxwood::reference
