// 02_your_own_shape: how does a shape of my own join?
// By having three members; nothing to derive from or to register.
#include <cstdio>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

// A can without lids: the points at `radius` from the y axis, between y = 0 and y = height.
struct Can {
  Vec3 foot;
  float radius, height;

  Box3 box() const { return {foot - Vec3{radius, 0, radius}, foot + Vec3{radius, height, radius}}; }

  // Report where the line of the ray crosses the surface; the query keeps what it needs.
  template <CrossingSink Sink>
  void intersect(const PreparedRay& ray, Sink&& sink) const {
    const Vec3 o = ray.origin - foot, d = ray.direction;
    const double a = double(d.x) * d.x + double(d.z) * d.z;
    const double b = double(o.x) * d.x + double(o.z) * d.z;
    const double c = double(o.x) * o.x + double(o.z) * o.z - double(radius) * radius;
    const double discriminant = b * b - a * c;
    if (!(a > 0) || discriminant < 0) return;
    for (const double side : {-1.0, 1.0}) {
      const double t = (-b + side * std::sqrt(discriminant)) / a, y = o.y + t * d.y;
      if (y >= 0 && y <= height) sink.report({.t = static_cast<float>(t)});
    }
  }

  Vec3 normal(const PreparedRay& ray, const Crossing& crossing) const {
    const Vec3 p = ray.origin + ray.direction * crossing.t - foot;
    return normalize({p.x, 0, p.z});
  }
};
static_assert(ShapeType<Can>);

int main() {
  const std::vector<Can> cans{{{0, 0, -4}, 1, 2}, {{0, 0, -8}, 1, 5}};
  const Bvh bvh = build(boxes(cans));

  // Over the first can, into the second.
  const Ray ray{.origin = {0, 4, 0}, .direction = {0, 0, -1}};
  const ShapeHit hit = closest_hit(bvh, cans, ray);
  std::printf("can %u at t = %g\n", hit.prim_id.value, hit.t);
}
