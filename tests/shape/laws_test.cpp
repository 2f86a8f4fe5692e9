// laws_test.cpp: does every shape obey the laws of concept.h?
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "boxwood/query/group.h"
#include "boxwood/shape/instance.h"
#include "boxwood/shape/shape.h"
#include "support/shapes.h"

namespace boxwood {
namespace {

// Every shape of the library keeps its promises at compile time.
template <class S>
concept Everything = ShapeType<S> && HasClosestPoint<S> && HasOverlap<S>;
static_assert(Everything<Triangle> && Everything<Quad> && Everything<Sphere> && Everything<Cuboid> &&
              Everything<Disk>);
static_assert(Everything<AnyShape> && Everything<Group<Triangle>> && Everything<Group<AnyShape>>);
static_assert(ShapeType<InstanceOf<Triangle>> && HasClosestPoint<InstanceOf<Triangle>>);
static_assert(ShapeType<InstanceOf<Group<InstanceOf<Group<Quad>>>>>);
static_assert(!ShapeType<Box3> && !ShapeType<Vec3> && !HasClosestPoint<Box3>);

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Keeps whatever is reported.
struct Recorder {
  std::vector<Crossing> crossings;
  float limit() const { return kInfinity; }
  void report(const Crossing& crossing) { crossings.push_back(crossing); }
};

template <class Shape>
std::vector<Crossing> line_crossings(const Shape& shape, const PreparedRay& ray) {
  Recorder recorder;
  if (ray.is_valid()) shape.intersect(ray, recorder);
  return recorder.crossings;
}

PreparedRay line(Vec3 origin, Vec3 direction, const Box3& bounds) {
  return {origin, direction, -kInfinity, kInfinity, bounds};
}

template <class Shape>
constexpr bool kIsClosed = std::same_as<Shape, Sphere> || std::same_as<Shape, Cuboid>;

template <class Shape>
class Laws : public testing::Test {};
using Kinds = testing::Types<Triangle, Quad, Sphere, Cuboid, Disk>;
TYPED_TEST_SUITE(Laws, Kinds);

TYPED_TEST(Laws, TheBoxHoldsTheShapeAndTheLineMeetsItOnTheSurface) {
  for (float scale : {1e-30f, 1e-10f, 1.0f, 1e10f, 1e30f})
    for (const TypeParam& shape : test::random_shapes<TypeParam>(200, 1, scale)) {
      const Box3 box = shape.box();
      ASSERT_FALSE(box.is_empty());
      ASSERT_EQ(box, shape.box());
      Random random(2);
      for (int i = 0; i < 20; ++i) {
        // Shoot at the box from a few sizes away, and look where the crossings are, in double.
        const Vec3 to = box.lower + box.extent() * Vec3{random.uniform(), random.uniform(), random.uniform()};
        const Vec3 from = to + random.direction() * (max_component(box.extent()) * random.uniform(0, 3));
        const PreparedRay ray = line(from, to - from, box);
        const float reach = max(max_component(abs(box.lower - from)), max_component(abs(box.upper - from)));
        for (const Crossing& crossing : line_crossings(shape, ray)) {
          ASSERT_TRUE(std::fabs(crossing.t) < kInfinity);
          // The crossing lies in the box up to the rounding of t,
          // and the point of the shape nearest to it is itself.
          const Interval inside = ray.interval(box);
          const float slack = 1e-4f * (std::fabs(inside.exit) + std::fabs(inside.entry) + 1);
          if (!std::same_as<TypeParam, Triangle> && !std::same_as<TypeParam, Quad>) {
            EXPECT_GE(crossing.t, inside.entry - slack);
            EXPECT_LE(crossing.t, inside.exit + slack);
            const Vec3 at = from + (to - from) * crossing.t;
            EXPECT_LE(distance(shape.closest_point(at), at),
                      1e-4f * (1 + std::fabs(crossing.t)) * reach + 1e-6f * max_component(abs(from)));
          }
        }
        // The nearest point lies in the box, and so no point is nearer to the shape than to the box.
        const Vec3 nearest = shape.closest_point(from);
        EXPECT_LE(distance(box, nearest),
                  1e-6f * (max_component(abs(box.lower)) + max_component(abs(box.upper))));
      }
    }
}

TYPED_TEST(Laws, SameBitsEachTimeAndNothingTwice) {
  for (const TypeParam& shape : test::lattice_shapes<TypeParam>(300, 3)) {
    Random random(4);
    for (int i = 0; i < 50; ++i) {
      const Vec3 from = test::lattice_point(random), to = test::lattice_point(random);
      const PreparedRay ray = line(from, to - from, shape.box());
      const std::vector<Crossing> crossings = line_crossings(shape, ray);
      EXPECT_EQ(crossings, line_crossings(shape, ray));
      for (std::size_t j = 0; j < crossings.size(); ++j)
        for (std::size_t k = 0; k < j; ++k) EXPECT_NE(crossings[j], crossings[k]);
      EXPECT_TRUE(!kIsClosed<TypeParam> || crossings.size() % 2 == 0);
    }
  }
}

TYPED_TEST(Laws, NormalsAreOfUnitLengthAndClosedShapesPointThemOutward) {
  int tested = 0;
  for (float scale : {1e-30f, 1.0f, 1e30f})
    for (const TypeParam& shape : test::random_shapes<TypeParam>(200, 5, scale)) {
      const Box3 box = shape.box();
      Random random(6);
      for (int i = 0; i < 20; ++i) {
        const Vec3 from =
            box.center() + random.direction() * (max_component(box.extent()) * random.uniform(0, 100));
        const Vec3 direction =
            box.lower + box.extent() * Vec3{random.uniform(), random.uniform(), random.uniform()} - from;
        const PreparedRay ray = line(from, direction, box);
        std::vector<Crossing> crossings = line_crossings(shape, ray);
        std::sort(crossings.begin(), crossings.end(),
                  [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
        for (std::size_t j = 0; j < crossings.size(); ++j) {
          const Vec3 n = shape.normal(ray, crossings[j]);
          EXPECT_NEAR(length(n), 1, 1e-5f);
          ++tested;
          if (!kIsClosed<TypeParam> || crossings.front().t == crossings.back().t) continue;
          const float along = dot(n, direction * (1 / max_component(abs(direction))));
          if (j == 0)
            EXPECT_LE(along, 0);
          else
            EXPECT_GE(along, 0);
        }
      }
    }
  EXPECT_GT(tested, 1000);
}

TYPED_TEST(Laws, InstancesTurnNormalsOutwardUnderEveryTransform) {
  Affine3 shear;
  shear.y.x = 1.5f;
  for (const Affine3& transform :
       {Affine3::rotation({1, 1, 0}, 50), Affine3::scale({1, -1, 1}), Affine3::scale({0.1f, 3, 1}), shear,
        Affine3::scale(1e-24f), Affine3::scale(1e24f)})
    for (const TypeParam& shape : test::random_shapes<TypeParam>(50, 7)) {
      const InstanceOf<TypeParam> instance(shape, transform);
      const Box3 box = instance.box();
      Random random(8);
      for (int i = 0; i < 20; ++i) {
        const Vec3 from = box.center() + random.direction() * (max_component(box.extent()) * 2);
        const Vec3 direction =
            box.center() + random.direction() * (max_component(box.extent()) * 0.2f) - from;
        const PreparedRay ray = line(from, direction, box);
        std::vector<Crossing> crossings = line_crossings(instance, ray);
        std::sort(crossings.begin(), crossings.end(),
                  [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
        for (std::size_t j = 0; j < crossings.size(); ++j) {
          const Vec3 n = instance.normal(ray, crossings[j]);
          EXPECT_NEAR(length(n), 1, 1e-5f);
          if (!kIsClosed<TypeParam> || crossings.front().t == crossings.back().t) continue;
          const float along = dot(n, direction * (1 / max_component(abs(direction))));
          if (j == 0)
            EXPECT_LE(along, 1e-5f);
          else
            EXPECT_GE(along, -1e-5f);
        }
      }
    }
}

/// A number that somebody might write by mistake.
float odd_number(Random& random) {
  constexpr float kOdd[] = {0,      -0.0f,  1,     -1,    0.5f,   1e-45f,    -1e-45f,    1e-38f,
                            1e-30f, -1e30f, 1e30f, 3e38f, -3e38f, kInfinity, -kInfinity, kNaN};
  return kOdd[random.below(std::size(kOdd))];
}

/// Overwrites some of the floats that the shape is made of.
template <class Shape>
Shape spoiled(Shape shape, Random& random) {
  constexpr std::size_t kCount = sizeof(Shape) / sizeof(float);
  float values[kCount];
  std::memcpy(values, &shape, sizeof(shape));
  const std::uint32_t many = 1 + random.below(kCount);
  for (std::uint32_t i = 0; i < many; ++i) values[random.below(kCount)] = odd_number(random);
  std::memcpy(&shape, values, sizeof(shape));
  return shape;
}

TYPED_TEST(Laws, OddNumbersNeverMakeANaNOrACrash) {
  Random random(9);
  for (int i = 0; i < 20000; ++i) {
    const TypeParam shape = spoiled(test::Make<TypeParam>::lattice(random), random);
    Ray ray{test::lattice_point(random), 0, test::lattice_point(random), kInfinity};
    if (random.below(2)) ray.origin[static_cast<int>(random.below(3))] = odd_number(random);
    if (random.below(2)) ray.direction[static_cast<int>(random.below(3))] = odd_number(random);
    const PreparedRay prepared(ray, shape.box());
    for (const Crossing& crossing : line_crossings(shape, prepared)) {
      EXPECT_TRUE(std::isfinite(crossing.t));
      EXPECT_FALSE(std::isnan(crossing.u) || std::isnan(crossing.v));
      EXPECT_NE(shape.box(), Box3{});
      (void)shape.normal(prepared, crossing);
    }
    (void)shape.closest_point(ray.origin);
    (void)shape.overlaps(Box3{ray.origin, ray.origin + ray.direction});
  }
}

TYPED_TEST(Laws, DegenerateShapesHaveANearestPointInTheirBox) {
  for (const TypeParam& shape : test::degenerate_shapes<TypeParam>(300, 10)) {
    const Box3 box = shape.box();
    if (box.is_empty()) continue;
    Random random(11);
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = random.in_box(splat(-6), splat(6)), nearest = shape.closest_point(p);
      EXPECT_LE(distance(box, nearest), 1e-5f);
      EXPECT_GE(distance(nearest, p), distance(box, p) - 1e-5f);
    }
  }
}

// Whoever touches a box has a point in it, and the other way round: compare with the nearest point of the
// box's middle, and with cutting the box in eight again and again.
TYPED_TEST(Laws, OverlapAgreesWithTheNearestPoint) {
  Random random(12);
  int touching = 0, apart = 0, points_found = 0;
  for (int i = 0; i < 20000; ++i) {
    const TypeParam shape =
        i % 2 ? test::Make<TypeParam>::random(random, {0, 0, 0}, 2) : test::Make<TypeParam>::lattice(random);
    const Vec3 corner = random.in_box(splat(-2.5f), splat(2)),
               size = random.in_box(splat(0.05f), splat(1.5f));
    const Box3 box{corner, corner + size};

    // Search the box for a point of the shape: a part may hold one only if the shape comes near its middle.
    bool found = false;
    int budget = 20000;
    const auto search = [&](const auto& self, const Box3& part, int depth) -> void {
      if (found || --budget < 0) return;
      const Vec3 middle = part.center(), nearest = shape.closest_point(middle);
      if (part.contains(nearest)) found = true;
      if (found || depth == 0 || distance(nearest, middle) > length(part.extent()) * 0.5f * 1.0001f) return;
      for (int k = 0; k < 8; ++k) {
        Box3 child{middle, middle};
        child.extend(part.corner(k));
        self(self, child, depth - 1);
      }
    };
    search(search, box, 7);
    const bool answer = shape.overlaps(box);
    (answer ? touching : apart) += 1;
    points_found += found;
    EXPECT_TRUE(answer || !found);
    // Not found at that depth: a true overlap can only be a graze,
    // which the box made a little smaller no longer has.
    if (!found && answer && budget >= 0) {
      const Vec3 in = size * 0.03f;
      EXPECT_FALSE(shape.overlaps(Box3{box.lower + in, box.upper - in}));
    }
  }
  EXPECT_GT(touching, 400);
  EXPECT_GT(points_found, touching / 2);
  EXPECT_GT(apart, 400);
}

}  // namespace
}  // namespace boxwood
