// 01_first_hit: what does this ray hit? Shapes, a tree over their boxes, one question.
#include <cstdio>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

int main() {
  // Three balls in a row. Nothing about them is special: any array of shapes will do.
  const std::vector<Sphere> balls{{{0, 0, -5}, 1}, {{0, 0, -10}, 2}, {{4, 0, -5}, 1}};

  // A tree knows boxes and numbers only; the balls stay where they are.
  const Bvh bvh = build(boxes(balls));

  // The ray starts at the origin and looks along -z.
  const Ray ray{.origin = {0, 0, 0}, .direction = {0, 0, -1}};
  const ShapeHit hit = closest_hit(bvh, balls, ray);
  if (hit.is_hit()) std::printf("ball %u at t = %g\n", hit.prim_id.value, hit.t);

  // A miss has t = +inf.
  const Ray upwards{.origin = {0, 0, 0}, .direction = {0, 1, 0}};
  std::printf("upwards: t = %g\n", closest_hit(bvh, balls, upwards).t);
}
