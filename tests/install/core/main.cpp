// A project that uses the installed core library alone.
#include <boxwood/boxwood.h>

int main() {
  const std::vector<boxwood::Sphere> balls{{{0, 0, 0}, 1}, {{0, 0, 5}, 1}};
  const boxwood::Bvh bvh = boxwood::build(boxwood::boxes(balls));
  return boxwood::closest_hit(bvh, balls, boxwood::Ray{{0, 0, 9}, 0, {0, 0, -1}}).t == 3 ? 0 : 1;
}
