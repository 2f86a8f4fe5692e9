// 05_all_hits: how thick is it?
// Each crossing comes exactly once, so that crossings pair up into inside and outside.
#include <cstdio>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

int main() {
  // A hollow ball in a closed box of 12 triangles, all in one array.
  std::vector<AnyShape> shapes{Sphere{{0, 0, 0}, 2}, Sphere{{0, 0, 0}, 1.5f}};
  const Box3 box{{-3, -3, -3}, {3, 3, 3}};
  const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& face : faces) {
    shapes.push_back(Triangle{box.corner(face[0]), box.corner(face[1]), box.corner(face[2])});
    shapes.push_back(Triangle{box.corner(face[0]), box.corner(face[2]), box.corner(face[3])});
  }
  const Bvh bvh = build(boxes(shapes));

  // Straight through the diagonals that the triangles share:
  // still two crossings of the box, not three or four.
  const Ray ray{.origin = {0, 0, 10}, .direction = {0, 0, -1}};
  const std::vector<ShapeHit> hits = all_hits(bvh, shapes, ray);

  // The solid is inside the outer ball and outside the inner one: it lies between crossings 1, 2 and 3, 4.
  std::printf("%zu crossings:", hits.size());
  for (const ShapeHit& hit : hits) std::printf(" %g", hit.t);
  std::printf("\nthickness of the shell: %g + %g\n", hits[2].t - hits[1].t, hits[4].t - hits[3].t);
}
