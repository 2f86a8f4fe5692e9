// 03_mixed_shapes: how does one array hold shapes of different kinds?
// As AnyShape; the textbook's vector of Shape*.
#include <cstdio>
#include <vector>

#include <boxwood/boxwood.h>

using namespace boxwood;

// A kind of one's own may derive from Shape: the floor y = 0, as far as the eye sees.
class Floor final : public Shape {
 public:
  Box3 box() const override { return {{-1000, 0, -1000}, {1000, 0, 1000}}; }
  void intersect(const PreparedRay& ray, ShapeSink& sink) const override {
    const float t = -ray.origin.y / ray.direction.y;
    const float x = ray.origin.x + ray.direction.x * t, z = ray.origin.z + ray.direction.z * t;
    // False for a ray along the floor, whose t is no number.
    if (std::fabs(x) <= 1000 && std::fabs(z) <= 1000) sink.report({.t = t});
  }
  Vec3 normal(const PreparedRay&, const Crossing&) const override { return {0, 1, 0}; }
};

int main() {
  // A value that meets the concept is wrapped as it is; a derived class comes as a shared pointer.
  const std::vector<AnyShape> shapes{
      Sphere{{0, 1, -5}, 1},
      Triangle{{2, 0, -5}, {4, 0, -5}, {3, 2, -5}},
      Cuboid{{-4, 0, -6}, {-2, 2, -4}},
      std::make_shared<Floor>(),
  };

  // The textbook's tree: halve the longest axis, stop at 32 levels or at 2 shapes.
  const Bvh bvh = build(boxes(shapes), {.method = Method::longest_axis, .max_depth = 32, .leaf_size = 2});

  const char* names[] = {"sphere", "triangle", "cuboid", "floor"};
  for (const float x : {-3.0f, 0.0f, 3.0f, 9.0f}) {
    const Ray ray{.origin = {x, 3, 0}, .direction = {0, -0.5f, -1}};
    const ShapeHit hit = closest_hit(bvh, shapes, ray);
    std::printf("x = %2g: %s at t = %g\n", x, names[hit.prim_id.value], hit.t);
  }
}
