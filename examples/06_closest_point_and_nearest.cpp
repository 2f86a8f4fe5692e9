// 06_closest_point_and_nearest: which shapes are near?
// The same tree answers questions that have no ray in them.
#include <cstdio>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

int main() {
  // A thousand lamps on a grid of 10 x 10 x 10.
  std::vector<Sphere> lamps;
  for (int i = 0; i < 1000; ++i)
    lamps.push_back(
        {{static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100)}, 0.25f});
  const Bvh bvh = build(boxes(lamps));
  const Vec3 moth{3.25f, 4.5f, 5};

  // The nearest point of any surface.
  const ShapePoint point = closest_point(bvh, lamps, moth);
  std::printf("nearest: lamp %u at (%g, %g, %g)\n", point.prim_id.value, point.position.x, point.position.y,
              point.position.z);

  // The three nearest lamps; equal distances go to the smaller number.
  for (const ShapePoint& lamp : nearest(bvh, lamps, moth, 3))
    std::printf("lamp %u is %.4f away\n", lamp.prim_id.value, lamp.distance);

  // Every lamp within a distance, and every lamp that touches a box.
  std::printf("%zu lamps within 1\n", overlap(bvh, lamps, moth, 1.0f).size());
  std::printf("%zu lamps touch the box\n", overlap(bvh, lamps, Box3{{0, 0, 0}, {1, 1, 1}}).size());
}
